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
/* Writes the file; unless force is set, it replaces nothing. Returns 0, or -1 with why filled. */
int ted4_file_write(const char *path, int force, const void *data, size_t size, char *why,
                    size_t why_size);
/* As ted4_file_write, for what has taken long to make: if something is in the way that was not
 * there at the beginning, the file is written under a name beside path, which why begins with. */
int ted4_file_keep(const char *path, int force, const void *data, size_t size, char *why,
                   size_t why_size);

#endif
