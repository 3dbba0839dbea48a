/* turn.c - see turn.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "turn.h"

#include <math.h>

/* Up directions closer than this to (0, 1, 0) have no axis of their own to be turned about. */
#define OPPOSITE 1e-6

int ted4_has_direction(const float v[3])
{
    return v[0] != 0 || v[1] != 0 || v[2] != 0;
}

int ted4_axis_parse(const char *text, float up[3])
{
    const int negative = text[0] == '-';
    const char *const axis = text + negative;

    if (axis[0] < 'x' || axis[0] > 'z' || axis[1] != '\0')
        return -1;
    for (int k = 0; k < 3; k++)
        up[k] = k != axis[0] - 'x' ? 0.0f : negative ? -1.0f : 1.0f;
    return 0;
}

void ted4_turn_up(const float up[3], ted4_turn *t)
{
    const double x = (double)up[0], y = (double)up[1], z = (double)up[2];
    const double length = sqrt(x * x + y * y + z * z);
    /* 1 + u . v and u x v for v = (0, -1, 0): the quaternion but for its length. */
    double q[4] = { length - y, z, 0.0, -x };
    double square = 0.0;

    if (q[0] < OPPOSITE * length) {
        q[0] = q[3] = 0.0;
        q[1] = 1.0;
    }
    for (int i = 0; i < 4; i++)
        square += q[i] * q[i];
    for (int i = 0; i < 4; i++)
        t->rot[i] = q[i] / sqrt(square);

    const double w = q[0], a = q[1], b = q[2], c = q[3], two = 2.0 / square;
    const double matrix[9] = {
        1 - two * (b * b + c * c), two * (a * b - w * c),     two * (a * c + w * b),
        two * (a * b + w * c),     1 - two * (a * a + c * c), two * (b * c - w * a),
        two * (a * c - w * b),     two * (b * c + w * a),     1 - two * (a * a + b * b),
    };
    for (int i = 0; i < 9; i++)
        t->matrix[i] = matrix[i];
}

void ted4_turn_shapes(const ted4_turn *t, size_t n, float *const mean[3], float *const rot[4])
{
    const double *const m = t->matrix, *const q = t->rot;

    for (size_t i = 0; i < n; i++) {
        const double x = (double)mean[0][i], y = (double)mean[1][i], z = (double)mean[2][i];
        const double w = (double)rot[0][i], a = (double)rot[1][i], b = (double)rot[2][i],
                     c = (double)rot[3][i];

        for (int k = 0; k < 3; k++)
            mean[k][i] = (float)(m[3 * k] * x + m[3 * k + 1] * y + m[3 * k + 2] * z);
        rot[0][i] = (float)(q[0] * w - q[1] * a - q[2] * b - q[3] * c);
        rot[1][i] = (float)(q[0] * a + q[1] * w + q[2] * c - q[3] * b);
        rot[2][i] = (float)(q[0] * b - q[1] * c + q[2] * w + q[3] * a);
        rot[3][i] = (float)(q[0] * c + q[1] * b - q[2] * a + q[3] * w);
    }
}
