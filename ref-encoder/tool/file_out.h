/* file_out.h - writes whole files: under a temporary name that is then renamed, so that a file is
 * never left half-written.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FILE_OUT_H
#define TED4_FILE_OUT_H

#include <stddef.h>

/* Tests whether path can be written: a file can be created in the same folder, and path does not
 * exist, or force is set. Leaves no file behind. instead: what else may be done with a file that
 * exists, as in "--resume goes on, ", or "". Returns 0, or -1 with why filled. */
int ted4_file_writable(const char *path, int force, const char *instead, char *why,
                       size_t why_size);
/* Writes the file. Returns 0, or -1 with why filled. */
int ted4_file_write(const char *path, const void *data, size_t size, char *why, size_t why_size);

#endif
