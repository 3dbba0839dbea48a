/* export.h - Gaussians of one time as files that viewers read: what a format gets, and the list of
 * formats.
 * Depends on nothing of the codec. One format a file: out_ply.c, out_splat.c, out_glb.c, out_raw.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EXPORT_H
#define TED4_EXPORT_H

#include <stddef.h>
#include <stdio.h>

/* World axes right, down, forward (COLMAP); scales linear; rotations w x y z; opacity in [0, 1].
 * Borrowed. */
typedef struct {
    size_t n;
    const float *mean[3], *scale[3], *rot[4], *opacity;
    const float *colour[3]; /* display-referred sRGB, as decoded at the stated camera */
    int sh_degree;          /* 0 .. 3 */
    const float *sh;        /* [n][3][(sh_degree + 1)^2]: colour in direction d =
                             * 0.5 + sum sh basis(d); sh.h */
    const char *comment;    /* lines, each ended by LF, for formats with text; or "" */
} ted4_frame;

/* How a format is written. Adding one is a file out_*.c and a line in export.c. */
typedef struct {
    const char *suffix; /* ".ply": chosen by the end of the file name */
    const char *text;   /* one line for the help */
    int max_sh_degree;  /* -1: takes the decoded colour, no spherical harmonics */
    /* 0, or -1 with errno set; an error the stream remembers (ferror) need not be reported. */
    int (*write)(FILE *f, const ted4_frame *x);
} ted4_format;

extern const ted4_format ted4_format_ply, ted4_format_splat, ted4_format_glb, ted4_format_raw;

/* All formats, ended by NULL. */
extern const ted4_format *const ted4_formats[];

/* By suffix of path; NULL: none fits. */
const ted4_format *ted4_format_find(const char *path);

/* Writes path through a temporary file (output.h). 0, or -1 with errno set. */
int ted4_export(const ted4_format *w, const ted4_frame *x, const char *path);

#endif
