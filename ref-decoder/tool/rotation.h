/* rotation.h - is a matrix from a file a rotation?
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TOOL_ROTATION_H
#define TED4_TOOL_ROTATION_H

#include <math.h>

/* How far R R^T may be from the identity, per entry: numbers in files are rounded (spec R-EXT-008
 * has the same bound). */
#define TED4_ROTATION_TOLERANCE 1e-3

/* Returns 1 if R R^T is the identity within the tolerance, and all entries are finite: R is a
 * rotation or the mirror image of one. R: row by row. */
static inline int ted4_is_orthogonal(const float R[9])
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

/* Returns 1 if R is orthogonal within the tolerance, and its determinant is above 0. */
static inline int ted4_is_rotation(const float R[9])
{
    double determinant = 0.0;

    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        determinant += (double)R[i] *
                       ((double)R[3 + j] * (double)R[6 + k] - (double)R[3 + k] * (double)R[6 + j]);
    }
    return ted4_is_orthogonal(R) && determinant > 0.0;
}

#endif
