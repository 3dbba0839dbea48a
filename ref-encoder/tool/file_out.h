/* file_out.h - whole files, written to a temporary name and renamed, so that nothing is ever
 * half-written.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FILE_OUT_H
#define TED4_FILE_OUT_H

#include <stddef.h>

/* Can path be written: a file can be made beside it, and nothing is there unless force. Leaves
 * nothing behind. 0, or -1 with why filled. */
int ted4_file_writable(const char *path, int force, char *why, size_t why_size);
/* 0, or -1 with why filled. */
int ted4_file_write(const char *path, const void *data, size_t size, char *why, size_t why_size);

#endif
