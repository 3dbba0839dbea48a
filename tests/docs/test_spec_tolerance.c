/* test_spec_tolerance.c - annex E: the thresholds of class T, computed by its rule; which records
 * satisfy them and which do not.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "spec_tolerance.h" /* before cmocka, whose fail() is a macro */
#include <stdio.h>

#include "test.h"
#include "random_scene.h"

enum { N_SCENES = 24 };
static const float camera[3] = { 0.5f, -1.0f, 2.0f };

/* Calls check for each random scene and query for which class X has a result. Returns the number of
 * calls. */
static int for_each(void (*check)(const tol_reference *t, const struct scene *s))
{
    int n = 0;

    for (uint64_t seed = 0; seed < N_SCENES; seed++) {
        ted4_scene *s = random_scene(seed);
        spec_model m = { .n_blocks = 0 };
        uint8_t *data = NULL;
        size_t size;

        assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, NULL), TED4_OK);
        spec_model_decode(&m, data, size);
        assert_null(m.p.v.id);
        for (uint32_t num = 0; num < 3; num++) {
            tol_reference t = { .n = 0 };

            if (tol_make(&t, &m.p.s, num, 2, camera) && t.n > 0) {
                check(&t, &m.p.s);
                n++;
            }
            tol_free(&t);
        }
        spec_model_free(&m);
        ted4_scene_free(s);
        free(data);
    }
    return n;
}

static unsigned differs[TOL_EVALUATIONS];

static void check_evaluations(const tol_reference *t, const struct scene *s)
{
    (void)s;
    for (int e = 0; e < TOL_EVALUATIONS; e++) {
        assert_int_equal(tol_judge(t, t->record[e]), -1);
        differs[e] += memcmp(t->record[e], t->record[TOL_EXACT], t->n * sizeof *t->record[e]) != 0;
    }
    for (int g = 0; g < TOL_GROUPS; g++) {
        int exponent;

        assert_true(t->rms[g] <= t->peak[g]);
        assert_true(t->peak[g] == 0 || frexp(t->peak[g], &exponent) == 0.5);
        assert_true(t->rms[g] == 0 || frexp(t->rms[g], &exponent) == 0.5);
    }
}

/* Every evaluation satisfies the thresholds that were derived from it and others, and each of them
 * uses different arithmetic. */
static void evaluations(void **state)
{
    (void)state;
    assert_true(for_each(check_evaluations) > N_SCENES);
    assert_int_equal(differs[TOL_EXACT], 0);
    for (int e = TOL_WIDE; e < TOL_EVALUATIONS; e++)
        assert_true(differs[e] > N_SCENES / 2);
}

/* One number of one record differs by a little more than the peak allows. */
static void check_error(const tol_reference *t, const struct scene *s)
{
    static const int first[TOL_GROUPS] = { 0, 3, 6, 10, 11 };
    const size_t bytes = t->n * sizeof *t->record[0], i = t->n / 2;
    float(*y)[14] = malloc(bytes);

    (void)s;
    for (int g = 0; g < TOL_GROUPS; g++) {
        const double scale = g == TOL_POSITION ? t->unit
                             : g == TOL_SCALE
                                 ? fmax((double)t->record[TOL_EXACT][i][3], 0x1p-24 * t->unit)
                                 : 1.0;

        if (!(t->judged[i] >> g & 1))
            continue;
        memcpy(y, t->record[TOL_EXACT], bytes);
        y[i][first[g]] = (float)((double)y[i][first[g]] + 1.5 * t->peak[g] * scale);
        assert_int_equal(tol_judge(t, y), g);
    }
    memcpy(y, t->record[TOL_EXACT], bytes);
    for (int j = 6; j < 10; j++)
        y[i][j] = -y[i][j];
    assert_int_equal(tol_judge(t, y), -1); /* the same rotation */
    y[i][10] = NAN;
    assert_true(tol_judge(t, y) >= 0);
    free(y);
}

static void errors(void **state)
{
    (void)state;
    assert_true(for_each(check_error) > N_SCENES);
}

/* A record in which one evaluation gives a number that is not finite is not judged; the others are
 * judged as before. */
static void check_infinite(const tol_reference *t, const struct scene *s)
{
    const size_t i = t->n / 2;
    tol_reference u = *t;
    float *const number = &u.record[TOL_WIDE + i % 3][i][i % 14], finite = *number;
    uint8_t *const before = malloc(t->n);

    memcpy(before, t->judged, t->n);
    *number = i % 2 == 0 ? INFINITY : NAN;
    tol_mark(&u, s, camera);
    for (size_t j = 0; j < t->n; j++)
        assert_int_equal(u.judged[j], j == i ? 0 : before[j]);
    *number = finite;
    tol_mark(&u, s, camera);
    assert_memory_equal(u.judged, before, t->n);
    free(before);
}

static void infinite(void **state)
{
    (void)state;
    assert_true(for_each(check_infinite) > N_SCENES);
}

/* tol_exact equals the reference decoder bit for bit (test_spec_code.c). Here: rounding up to a
 * power of two. */
static void rounding(void **state)
{
    (void)state;
    assert_true(tol_round_up(0.25) == 0.25);
    assert_true(tol_round_up(0.26) == 0.5);
    assert_true(tol_round_up(0x1.000002p-30) == 0x1p-29);
    assert_true(tol_round_up(0) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(evaluations), cmocka_unit_test(errors),
                                        cmocka_unit_test(infinite), cmocka_unit_test(rounding) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
