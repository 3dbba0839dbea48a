/* test_turn.c - tool/turn.h and ted4_sh_turn: the named direction ends up at (0, -1, 0), exactly
 * for axes; matrix and quaternion agree; colours turn with the directions.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>

#include "test.h"
#include "random_source.h"
#include "tool/sh.h"
#include "tool/turn.h"

enum { N = 20 };

static random_source source = { 11 };

static void random_direction(float v[3])
{
    double square = 0.0;

    while (square < 0.01 || square > 1.0) {
        square = 0.0;
        for (int k = 0; k < 3; k++) {
            v[k] = random_float(&source, -1.0f, 1.0f);
            square += (double)v[k] * (double)v[k];
        }
    }
    for (int k = 0; k < 3; k++)
        v[k] = (float)((double)v[k] / sqrt(square));
}

static void apply(const double m[9], const double v[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m[3 * k] * v[0] + m[3 * k + 1] * v[1] + m[3 * k + 2] * v[2];
}

/* The matrix of a quaternion w x y z of length 1. */
static void matrix_of(const double q[4], double m[9])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double r[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
        2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)
    };

    memcpy(m, r, sizeof r);
}

static void check_turn(const float up[3])
{
    const double v[3] = { (double)up[0], (double)up[1], (double)up[2] };
    double same[9], out[3];
    ted4_turn t;

    ted4_turn_up(up, &t);
    apply(t.matrix, v, out);
    assert_true(fabs(out[0]) < 1e-6 && fabs(out[1] + 1.0) < 1e-6 && fabs(out[2]) < 1e-6);
    matrix_of(t.rot, same);
    for (int i = 0; i < 9; i++)
        assert_true(fabs(t.matrix[i] - same[i]) < 1e-12);
}

static void test_axes(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            float up[3] = { 0, 0, 0 };
            ted4_turn t;

            up[k] = (float)sign;
            check_turn(up);
            ted4_turn_up(up, &t);
            for (int i = 0; i < 9; i++)
                assert_true(t.matrix[i] == 0.0 || fabs(t.matrix[i]) == 1.0);
        }
    }
    for (int i = 0; i < 100; i++) {
        float up[3];

        random_direction(up);
        check_turn(up);
    }
}

/* Means by the matrix; each axis of a Gaussian by its rotation and then the matrix. */
static void test_shapes(void **state)
{
    float mean[3][N], rot[4][N], was_mean[3][N], was_rot[4][N], up[3];
    float *const means[3] = { mean[0], mean[1], mean[2] };
    float *const rots[4] = { rot[0], rot[1], rot[2], rot[3] };
    ted4_turn t;

    (void)state;
    for (int i = 0; i < N; i++) {
        double square = 0.0;

        for (int k = 0; k < 4; k++) {
            rot[k][i] = random_float(&source, -1.0f, 1.0f);
            square += (double)rot[k][i] * (double)rot[k][i];
        }
        for (int k = 0; k < 4; k++)
            rot[k][i] = (float)((double)rot[k][i] / sqrt(square));
        for (int k = 0; k < 3; k++)
            mean[k][i] = random_float(&source, -9.0f, 9.0f);
    }
    memcpy(was_mean, mean, sizeof mean);
    memcpy(was_rot, rot, sizeof rot);
    random_direction(up);
    ted4_turn_up(up, &t);
    ted4_turn_shapes(&t, N, means, rots);
    for (int i = 0; i < N; i++) {
        double before[9], after[9], out[3], q[4], p[4], v[3];

        for (int k = 0; k < 4; k++) {
            q[k] = (double)was_rot[k][i];
            p[k] = (double)rot[k][i];
        }
        for (int k = 0; k < 3; k++)
            v[k] = (double)was_mean[k][i];
        apply(t.matrix, v, out);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(out[k] - (double)mean[k][i]) < 1e-5);
        matrix_of(q, before);
        matrix_of(p, after);
        for (int c = 0; c < 3; c++) {
            const double axis[3] = { before[c], before[3 + c], before[6 + c] };

            apply(t.matrix, axis, out);
            for (int k = 0; k < 3; k++)
                assert_true(fabs(out[k] - after[3 * k + c]) < 1e-5);
        }
    }
}

static double colour(int degree, const float *sh, const double d[3])
{
    double basis[TED4_SH_MAX_COEFS], v = 0.0;

    ted4_sh_basis(d, degree, basis);
    for (int k = 0; k < ted4_sh_count(degree); k++)
        v += basis[k] * (double)sh[k];
    return v;
}

static void test_harmonics(void **state)
{
    (void)state;
    for (int degree = 0; degree <= 3; degree++) {
        const size_t n_coefs = (size_t)ted4_sh_count(degree);
        float sh[N * 3 * TED4_SH_MAX_COEFS], was[N * 3 * TED4_SH_MAX_COEFS], up[3];
        ted4_turn t;

        for (size_t i = 0; i < N * 3 * n_coefs; i++)
            was[i] = sh[i] = random_float(&source, -0.6f, 0.6f);
        random_direction(up);
        ted4_turn_up(up, &t);
        ted4_sh_turn(degree, t.matrix, N, sh);
        for (size_t i = 0; i < N * 3; i++) {
            float v[3];
            double turned[3];

            random_direction(v);
            const double d[3] = { (double)v[0], (double)v[1], (double)v[2] };

            apply(t.matrix, d, turned);
            assert_true(fabs(colour(degree, was + i * n_coefs, d) -
                             colour(degree, sh + i * n_coefs, turned)) < 1e-5);
            assert_true(sh[i * n_coefs] == was[i * n_coefs]); /* degree 0 stays as it is */
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_axes),
        cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_harmonics),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
