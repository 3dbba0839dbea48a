/* output.h - output files of the programs: numbered names, and files that appear only when they are
 * complete. A signal that ends the program leaves none where it watches for that (leftovers.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_OUTPUT_H
#define TED4_OUTPUT_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { TED4_PATH_SIZE = 4096 };

typedef struct {
    FILE *file; /* open for binary writing */
    char path[TED4_PATH_SIZE], temporary[TED4_PATH_SIZE];
    int is_new; /* 1: it replaces nothing */
} ted4_output;

/* Returns 1 if there is something at path, be it a link that leads nowhere. */
int ted4_output_exists(const char *path);

/* Returns how many bytes of path a name beside it can begin with and stay as long as file systems
 * allow: the folder, and up to 200 bytes of the name, which is not cut inside a letter of UTF-8. */
int ted4_output_kept(const char *path);

/* Opens a temporary file next to path; where path is a link to a file, next to that file. It has
 * the mode of the file that it will replace. Returns 0, or -1 with errno set: EISDIR or EOPNOTSUPP
 * where path is a folder, or a device or a pipe, which a file would replace. */
int ted4_output_open(ted4_output *o, const char *path);
/* As ted4_output_open, for a file that replaces nothing: errno is EEXIST if something is at path,
 * also when the file is closed and something has appeared there meanwhile. */
int ted4_output_open_new(ted4_output *o, const char *path);
/* Flushes and closes the temporary file and gives it its name. Unless the file is a new one, it
 * replaces an existing file, but not a link to it. Returns 0, or -1 with errno set and the
 * temporary file removed. */
int ted4_output_close(ted4_output *o);
/* As ted4_output_close, but the bytes lie on the medium before the file has its name: after a
 * failure of power the file is the one that was there or the new one. For what takes long to make;
 * a series of pictures would wait for each. */
int ted4_output_keep(ted4_output *o);
/* Closes and removes the temporary file. errno is preserved. */
void ted4_output_cancel(ted4_output *o);

/* Returns 1 if path is "-", which stands for standard output. */
int ted4_output_is_stdout(const char *path);

/* Returns 1 if path ends in suffix, in letters of either case, with something before it. */
int ted4_has_suffix(const char *path, const char *suffix);

/* A pattern is a file name with at most one %d, %Nd or %0Nd (N up to 9) and no other percent sign.
 * Returns the number of conversions (0 or 1), or -1 if the text is not a pattern. */
int ted4_pattern_count(const char *pattern);
/* Replaces the conversion by number. The pattern must be valid. Returns 0, or -1 with errno
 * set if the name is too long. */
int ted4_pattern_make(char out[TED4_PATH_SIZE], const char *pattern, uint32_t number);

#endif
