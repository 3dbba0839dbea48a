/* inputs.h - the harnesses by name, and inputs from files. Every harness is compiled a second time
 * with its entry named fuzz_NAME, so that one program can contain all of them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_INPUTS_H
#define TED4_FUZZ_INPUTS_H

#include <stddef.h>
#include <stdint.h>

typedef int fuzz_entry(const uint8_t *data, size_t size);

typedef struct {
    const char *name, *seeds; /* seeds: the folder below fuzz/corpus */
    fuzz_entry *run;
} fuzz_harness;

extern const fuzz_harness fuzz_list[]; /* the last entry has the name NULL */

fuzz_entry *fuzz_find(const char *name); /* NULL: there is no such harness */
/* Runs a file, or the files of a folder in the order of their names, and adds their number to *n.
 * Each is copied to memory of exactly its size, so that a sanitizer detects reads beyond it.
 * Returns 0, or -1 if something cannot be read. */
int fuzz_replay(fuzz_entry *run, const char *path, size_t *n);

#endif
