/* rotation_vector.h - rotations by rotation vectors, and cross products. Angles stay below 1e5
 * radians. Depends on math/elementary.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ROTATION_VECTOR_H
#define TED4_ROTATION_VECTOR_H

#include <math.h>

#include "math/elementary.h"

static inline void ted4_cross_product(const double a[3], const double b[3], double to[3])
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

/* Functions of the angle x = |w|: sine is sin(x) / x, cosine is (1 - cos(x)) / x^2, and rest is
 * (1 - sin(x) / x) / x^2. */
typedef struct {
    double sine, cosine, rest;
} ted4_angle_terms;

static inline ted4_angle_terms ted4_angle_terms_of(const double w[3])
{
    const double xx = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], x = sqrt(xx);

    /* The series leave out terms below 1e-15. */
    if (xx < 1e-4)
        return (ted4_angle_terms) { 1 - xx / 6 * (1 - xx / 20 * (1 - xx / 42)),
                                    0.5 - xx / 24 * (1 - xx / 30 * (1 - xx / 56)),
                                    1.0 / 6 - xx / 120 * (1 - xx / 42 * (1 - xx / 72)) };

    const double sine = ted4_math_sin(x) / x, half = ted4_math_sin(0.5 * x) / x;

    return (ted4_angle_terms) { sine, 2 * half * half, (1 - sine) / xx };
}

/* Computes the rotation matrix exp(w), by rows (Rodrigues). */
static inline void ted4_rotation_matrix(const double w[3], double to[9])
{
    const ted4_angle_terms f = ted4_angle_terms_of(w);
    const double xx = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            to[3 * i + j] = f.cosine * (w[i] * w[j] - (i == j ? xx : 0)) + (i == j ? 1 : 0);
    to[1] -= f.sine * w[2];
    to[2] += f.sine * w[1];
    to[3] += f.sine * w[2];
    to[5] -= f.sine * w[0];
    to[6] -= f.sine * w[1];
    to[7] += f.sine * w[0];
}

/* Turns g, the gradient with respect to a further small rotation after exp(w), into the gradient
 * with respect to w: exp(w + dw) = exp(J dw) exp(w) with J = I + cosine [w] + rest [w]^2, where [w]
 * is the matrix of the cross product, so the result is J^T g. */
static inline void ted4_rotation_backward(const double w[3], double g[3])
{
    const ted4_angle_terms f = ted4_angle_terms_of(w);
    double once[3], twice[3];

    ted4_cross_product(w, g, once);
    ted4_cross_product(w, once, twice);
    for (int i = 0; i < 3; i++)
        g[i] += f.rest * twice[i] - f.cosine * once[i];
}

#endif
