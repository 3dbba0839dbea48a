/* rotation.h - is a matrix from a file a rotation?
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TOOL_ROTATION_H
#define TED4_TOOL_ROTATION_H

#include <math.h>

/* How far R R^T may be from the identity, per entry: numbers in files are rounded (spec R-EXT-008
 * has the same bound). */
#define TED4_ROTATION_TOLERANCE 1e-3

/* Returns 1 if R R^T is the identity within the tolerance, and all entries are finite. R: row by
 * row. */
static inline int ted4_is_rotation(const float R[9])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double dot = 0.0;

            for (int k = 0; k < 3; k++)
                dot += (double)R[3 * i + k] * (double)R[3 * j + k];
            if (!(fabs(dot - (i == j)) <= TED4_ROTATION_TOLERANCE))
                return 0;
        }
    }
    return 1;
}

/* Returns 1 if R, for which ted4_is_rotation returns 1, is a mirror image of a rotation: the chunk
 * CAMS may hold one, but a camera that somebody describes is none. */
static inline int ted4_is_mirrored(const float R[9])
{
    double determinant = 0.0;

    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        determinant += (double)R[i] *
                       ((double)R[3 + j] * (double)R[6 + k] - (double)R[3 + k] * (double)R[6 + j]);
    }
    return determinant < 0.0;
}

#endif
