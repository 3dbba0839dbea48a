/* export.h - writes the Gaussians at one time to files that viewers read: the input of a format,
 * and the list of formats.
 * Depends on nothing of the codec. Each format has its own file: out_ply.c, out_splat.c, out_glb.c,
 * out_raw.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EXPORT_H
#define TED4_EXPORT_H

#include <stddef.h>
#include <stdio.h>

/* The Gaussians to write, in the axes of the scene or turned (turn.h); scales are linear;
 * rotations are w x y z; opacity is in [0, 1]. The arrays are borrowed. */
typedef struct {
    size_t n;
    const float *mean[3], *scale[3], *rot[4], *opacity;
    const float *colour[3]; /* display-referred sRGB, as decoded at the stated camera */
    int sh_degree;          /* 0 .. 3 */
    const float *sh;        /* [n][3][(sh_degree + 1)^2]: colour in direction d =
                             * 0.5 + sum sh basis(d); sh.h */
    int in_order;           /* 1: a file of a sequence; Gaussian i must be its record i */
    const char *comment;    /* lines, each ended by LF, for formats with text; or "" */
} ted4_frame;

/* A format. A new one needs a file out_*.c and a line in export.c. */
typedef struct {
    const char *suffix; /* for example ".ply"; the end of the file name chooses the format */
    const char *text;   /* one line of the help text */
    int max_sh_degree;  /* -1: writes the decoded colour instead of spherical harmonics */
    /* Returns 0, or -1 with errno set. Errors that ferror(f) shows need not be reported. */
    int (*write)(FILE *f, const ted4_frame *x);
} ted4_format;

extern const ted4_format ted4_format_ply, ted4_format_splat, ted4_format_glb, ted4_format_raw;

/* All formats, followed by NULL. */
extern const ted4_format *const ted4_formats[];

/* Returns the format whose suffix path ends in, or NULL if there is none. */
const ted4_format *ted4_format_find(const char *path);

/* Writes path through a temporary file (output.h), or standard output if it is "-". Returns 0, or
 * -1 with errno set. */
int ted4_export(const ted4_format *w, const ted4_frame *x, const char *path);

#endif
