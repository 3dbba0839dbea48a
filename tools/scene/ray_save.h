/* ray_save.h - writes a file of a scene: its bytes are collected in memory, and the file gets its
 * name when it is complete. One file is unfinished at a time, however many threads write, so that a
 * signal that ends the program leaves none (tool/leftovers.h). Depends on ray_set.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_SAVE_H
#define RAY_SAVE_H

#include <stdio.h>

#include "ray_set.h"

/* Writes n bytes as the file path. Returns 0, or -1 with *m filled. */
int ted4_ray_save(const char *path, const void *bytes, size_t n, ted4_ray_message *m);

/* Bytes that are collected. */
typedef struct {
    FILE *file;  /* to write into; NULL: out of memory */
    char *bytes; /* owned, as is the file */
    size_t n;
} ted4_ray_collected;

/* *c must stay where it is until ted4_ray_collect_end. */
void ted4_ray_collect(ted4_ray_collected *c);
/* Writes what was collected as the file path, unless it is not all: bad, or out of memory. Returns
 * 0, or -1 with *m filled. */
int ted4_ray_collect_end(ted4_ray_collected *c, int bad, const char *path, ted4_ray_message *m);

#endif
