/* corpus.h - the parts of make_corpus.c. They write the seeds of the harnesses below a folder, one
 * subfolder per harness or group of harnesses.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_CORPUS_H
#define TED4_FUZZ_CORPUS_H

#include <stddef.h>
#include <stdint.h>

/* The argument FOLDER of make_corpus. */
extern const char *corpus_folder;
/* Writes FOLDER/GROUP/NAME. A file that cannot be written ends the process with status 3. */
void corpus_write(const char *group, const char *name, const void *data, size_t size);

void corpus_units(void);  /* seeds of the harnesses of single modules */
void corpus_scenes(void); /* seeds of the harnesses that read scenes */

#endif
