/* test_prune_units.c - train/math/prune_units.c: which unit is removed first, how the others
 * replace it, and which must stay.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "larger.h"
#include "train/math/prune_units.h"
#include "train/math/random.h"

enum { N = 4, SIDE = N + 1, SAMPLES = 500, ROWS = 2 };

/* Units 0, 1 and 3 are independent; unit 2 is unit 0 minus twice unit 1 plus 3. */
static void draw(int i, double x[SIDE])
{
    x[0] = (double)ted4_uniform(1, (uint64_t)i);
    x[1] = (double)ted4_uniform(2, (uint64_t)i);
    x[3] = (double)ted4_uniform(3, (uint64_t)i);
    x[2] = x[0] - 2.0 * x[1] + 3.0;
    x[N] = 1.0;
}

static void moments(double m[SIDE * SIDE])
{
    for (int k = 0; k < SIDE * SIDE; k++)
        m[k] = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double x[SIDE];

        draw(i, x);
        for (int a = 0; a < SIDE; a++)
            for (int b = 0; b < SIDE; b++)
                m[a * SIDE + b] += x[a] * x[b] / SAMPLES;
    }
}

static int keeps(const ted4_pruned_units *w, int unit)
{
    for (int k = 0; k < w->to; k++)
        if (w->keep[k] == unit)
            return 1;
    return 0;
}

/* Largest difference between the readers' inputs before and after pruning. */
static double worst(const ted4_pruned_units *w, const float *readers)
{
    double most = 0;

    for (int i = 0; i < SAMPLES; i++) {
        double x[SIDE];

        draw(i, x);
        for (int r = 0; r < ROWS; r++) {
            double was = 0, now = 0;

            for (int a = 0; a < N; a++) {
                const double *d = w->decode + a * (w->to + 1);
                double estimate = d[w->to];

                for (int k = 0; k < w->to; k++)
                    estimate += d[k] * x[w->keep[k]];
                was += (double)readers[r * N + a] * x[a];
                now += (double)readers[r * N + a] * estimate;
            }
            most = larger(most, fabs(was - now));
        }
    }
    return most;
}

static void test_dependent(void **state)
{
    static const float readers[ROWS * N] = { 1, 2, 3, 4, -1, 1, 2, 0.5f };
    double m[SIDE * SIDE];
    ted4_units u = { N, ROWS, m, readers, NULL };
    ted4_pruned_units w;

    (void)state;
    moments(m);
    assert_int_equal(ted4_prune_units(&w, &u, N - 1), 0);
    assert_int_equal(w.to, N - 1);
    assert_true(keeps(&w, 3)); /* the unit that the others cannot replace */
    if (!(worst(&w, readers) <= 1e-3))
        fail_msg("%g is missed", worst(&w, readers));
    ted4_pruned_units_finish(&w);
    assert_int_equal(ted4_prune_units(&w, &u, N - 2), 0);
    assert_true(worst(&w, readers) > 0.1);
    ted4_pruned_units_finish(&w);
}

static void test_nothing_gone(void **state)
{
    static const float readers[ROWS * N] = { 1, 2, 3, 4, -1, 1, 2, 0.5f };
    double m[SIDE * SIDE];
    ted4_units u = { N, ROWS, m, readers, NULL };
    ted4_pruned_units w;

    (void)state;
    moments(m);
    assert_int_equal(ted4_prune_units(&w, &u, N), 0);
    assert_int_equal(w.from, N);
    assert_int_equal(w.to, N);
    for (int a = 0; a < N; a++)
        for (int k = 0; k <= N; k++)
            assert_true(w.decode[a * (N + 1) + k] == (k == a ? 1.0 : 0.0));
    ted4_pruned_units_finish(&w);
}

/* A unit without readers is removed first. */
static void test_unread(void **state)
{
    static const float readers[ROWS * N] = { 1, 0, 3, 4, -1, 0, 2, 0.5f };
    double m[SIDE * SIDE];
    ted4_units u = { N, ROWS, m, readers, NULL };
    ted4_pruned_units w;

    (void)state;
    moments(m);
    assert_int_equal(ted4_prune_units(&w, &u, N - 1), 0);
    assert_true(!keeps(&w, 1));
    assert_true(worst(&w, readers) < 1e-9);
    ted4_pruned_units_finish(&w);
}

static void test_held(void **state)
{
    static const float readers[ROWS * N] = { 1, 0, 3, 4, -1, 0, 2, 0.5f };
    static const uint8_t held[N] = { 1, 1, 1, 0 };
    double m[SIDE * SIDE];
    ted4_units u = { N, ROWS, m, readers, held };
    ted4_pruned_units w;

    (void)state;
    moments(m);
    assert_int_equal(ted4_prune_units(&w, &u, 1), 0);
    assert_int_equal(w.to, 3);
    assert_true(!keeps(&w, 3));
    ted4_pruned_units_finish(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dependent),
        cmocka_unit_test(test_nothing_gone),
        cmocka_unit_test(test_unread),
        cmocka_unit_test(test_held),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
