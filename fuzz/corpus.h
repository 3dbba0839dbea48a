/* corpus.h - the parts of make_corpus.c: seeds of the harnesses, written below a folder, one folder
 * a harness or group of them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_CORPUS_H
#define TED4_FUZZ_CORPUS_H

#include <stddef.h>
#include <stdint.h>

/* FOLDER of make_corpus. */
extern const char *corpus_folder;
/* FOLDER/GROUP/NAME. What cannot be written ends the process with 3. */
void corpus_write(const char *group, const char *name, const void *data, size_t size);

void corpus_units(void);  /* of the harnesses of single modules */
void corpus_scenes(void); /* of scene input */

#endif
