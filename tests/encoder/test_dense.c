/* test_dense.c - kernel/dense.h against plain double loops: odd and even shapes, strides, several
 * blocks.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "kernel/dense.h"
#include "random_source.h"

enum { MAX_CH = 150, MAX_BLOCKS = 5, PAD = 3 };

static random_source source = { 1 };

static float *fill(size_t n)
{
    const size_t lines = (uint32_t)(n + 15) / 16;
    float *v = aligned_alloc(64, lines * 64);

    assert_non_null(v);
    for (size_t i = 0; i < n; i++)
        v[i] = random_float(&source, -1, 1);
    return v;
}

/* Tolerance for the rounding of n terms of size 1: far below any real error, which is of size 1. */
static void near(double got, double want, int n)
{
    assert_true(fabs(got - want) < 1e-6 * (n + 4));
}

static void check_forward(const ted4_dense *d, const float *w, const float *b, const float *x)
{
    float *y = fill((size_t)(d->out + 1) * TED4_LANES);
    const float guard = y[d->out * TED4_LANES];

    for (int relu = 0; relu < 2; relu++) {
        ted4_dense_forward(d, x, y, relu);
        for (int o = 0; o < d->out; o++)
            for (int j = 0; j < TED4_LANES; j++) {
                double acc = b[o];

                for (int i = 0; i < d->in; i++)
                    acc += (double)w[o * d->in + i] * x[i * TED4_LANES + j];
                if (relu && acc < 0.0)
                    acc = 0.0;
                near(y[o * TED4_LANES + j], acc, d->in);
            }
        assert_true(y[d->out * TED4_LANES] == guard);
    }
    free(y);
}

static void check_backward_x(const ted4_dense *d, const float *w, const float *dy)
{
    const size_t n = (size_t)d->in * TED4_LANES;
    float *dx = fill(n + TED4_LANES), *old = fill(n);
    const float guard = dx[n];

    for (int add = 0; add < 2; add++) {
        memcpy(dx, old, n * sizeof *dx);
        ted4_dense_backward_x(d, dy, dx, add);
        for (int i = 0; i < d->in; i++)
            for (int j = 0; j < TED4_LANES; j++) {
                double acc = add ? old[i * TED4_LANES + j] : 0.0;

                for (int o = 0; o < d->out; o++)
                    acc += (double)w[o * d->in + i] * dy[o * TED4_LANES + j];
                near(dx[i * TED4_LANES + j], acc, d->out);
            }
        assert_true(dx[n] == guard);
    }
    free(dx);
    free(old);
}

static void check_backward_w(int in, int out, size_t n_blocks)
{
    const size_t sx = (size_t)(in + PAD) * TED4_LANES;
    const size_t sy = (size_t)(out + 2 * PAD) * TED4_LANES;
    const size_t n_w = (size_t)in * (size_t)out;
    float *x = fill(sx * MAX_BLOCKS), *dy = fill(sy * MAX_BLOCKS);
    float *dw = fill(n_w + 1), *db = fill((size_t)out + 1);
    float *w0 = fill(n_w + 1), *b0 = fill((size_t)out + 1);

    memcpy(w0, dw, (n_w + 1) * sizeof *dw);
    memcpy(b0, db, ((size_t)out + 1) * sizeof *db);
    ted4_dense_backward_w(in, out, x, sx, dy, sy, n_blocks, dw, db);
    for (int o = 0; o < out; o++) {
        double bias = b0[o];

        for (int i = 0; i < in; i++) {
            double acc = w0[o * in + i];

            for (size_t k = 0; k < n_blocks; k++)
                for (int j = 0; j < TED4_LANES; j++)
                    acc += (double)dy[k * sy + (size_t)(o * TED4_LANES + j)] *
                           x[k * sx + (size_t)(i * TED4_LANES + j)];
            near(dw[o * in + i], acc, 32 * MAX_BLOCKS);
        }
        for (size_t k = 0; k < n_blocks; k++)
            for (int j = 0; j < TED4_LANES; j++)
                bias += dy[k * sy + (size_t)(o * TED4_LANES + j)];
        near(db[o], bias, 32 * MAX_BLOCKS);
    }
    assert_true(dw[n_w] == w0[n_w]);
    assert_true(db[out] == b0[out]);
    free(x), free(dy), free(dw), free(db), free(w0), free(b0);
}

static void check_shape(int in, int out)
{
    ted4_dense d;
    float *w = fill((size_t)in * (size_t)out), *b = fill((size_t)out);
    float *x = fill((size_t)in * TED4_LANES), *dy = fill((size_t)out * TED4_LANES);

    assert_int_equal(ted4_dense_init(&d, in, out), 0);
    ted4_dense_pack(&d, w, b);
    check_forward(&d, w, b, x);
    check_backward_x(&d, w, dy);
    ted4_dense_finish(&d);
    ted4_dense_finish(&d);
    for (size_t n = 0; n <= MAX_BLOCKS; n += n < 2 ? 1 : 3)
        check_backward_w(in, out, n);
    free(w), free(b), free(x), free(dy);
}

static void test_small_shapes(void **state)
{
    (void)state;
    for (int in = 1; in <= 26; in += in < 6 ? 1 : 5)
        for (int out = 1; out <= 26; out++)
            check_shape(in, out);
}

static void test_real_shapes(void **state)
{
    static const int shape[][2] = { { 50, 10 },     { 53, 70 },    { 50, 50 },
                                    { 32, 32 },     { 8, 128 },    { 128, 35 },
                                    { 99, MAX_CH }, { MAX_CH, 1 }, { 63, 64 } };

    (void)state;
    for (size_t i = 0; i < sizeof shape / sizeof shape[0]; i++)
        check_shape(shape[i][0], shape[i][1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_small_shapes),
        cmocka_unit_test(test_real_shapes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
