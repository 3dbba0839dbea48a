/* inputs.h - the harnesses by name, and inputs from files. Every harness is compiled once more with
 * its entry named fuzz_NAME, so that one program can hold them all.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_INPUTS_H
#define TED4_FUZZ_INPUTS_H

#include <stddef.h>
#include <stdint.h>

typedef int fuzz_entry(const uint8_t *data, size_t size);

typedef struct {
    const char *name, *seeds; /* seeds: folder below fuzz/corpus */
    fuzz_entry *run;
} fuzz_harness;

extern const fuzz_harness fuzz_list[]; /* ends with a name NULL */

fuzz_entry *fuzz_find(const char *name); /* NULL: no such harness */
/* Runs a file, or the files of a folder in the order of their names, and adds their number to *n.
 * Each lies in storage of its own size, so that a sanitizer sees what reads past it. 0, or -1:
 * something cannot be read. */
int fuzz_replay(fuzz_entry *run, const char *path, size_t *n);

#endif
