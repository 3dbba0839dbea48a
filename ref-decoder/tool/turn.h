/* turn.h - the direction of a scene that is up, and the rotation that makes it the up direction of
 * other programs.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TURN_H
#define TED4_TURN_H

#include <stddef.h>

/* Returns 1 if v is not 0 0 0, which stands for a direction that nobody has told. */
int ted4_has_direction(const float v[3]);

/* Reads the name of an axis: x, y, z, -x, -y or -z. Returns 0, or -1 if text is none. */
int ted4_axis_parse(const char *text, float up[3]);

/* A rotation of the world, twice: a point x goes to matrix x. */
typedef struct {
    double matrix[9]; /* row by row */
    double rot[4];    /* unit quaternion w x y z */
} ted4_turn;

/* Makes the smallest rotation that takes up, a vector of about length 1, to (0, -1, 0): up in axes
 * that point right, down and forward. If up is one of the axes, all entries of matrix are exactly
 * 0, 1 or -1. */
void ted4_turn_up(const float up[3], ted4_turn *t);

/* Turns n means and rotations in place. mean[3] and rot[4] (w x y z): columns of n numbers. */
void ted4_turn_shapes(const ted4_turn *t, size_t n, float *const mean[3], float *const rot[4]);

#endif
