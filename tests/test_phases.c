/* test_phases.c - what happens when during training (paper, "Progressive 3D-to-4D Anchor Transformation"): activation begins after the static phase, from the
 * first and last time at which training views see an anchor; anchors come and go within the time that growth has; stage 2 only ever loses them, at its begin.
 * Single steps: test_densify.c, test_traps.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "ball_group.h"
#include "cloud_case.h"
#include "train/transient.h"

enum { STAGE1 = 400, ACTIVATION = 134, SPROUTS = 120, GROWTH_ENDS = 240, GROW_EVERY = 20 };

static float tau(const ted4_trainer *t, size_t i, int c)
{
    return *ted4_cell(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_TAU] + c);
}

/* ---- first and last visible time ---- */

/* World units between the two halves of the cloud: far more than a picture shows. */
#define APART 40.0

/* Every other point of a cloud lies far to the right. One camera sees the left half, in frames 1 to 3; the other the right half, in frames 2 to 4 and, held
 * out, in frames 0 and 1. */
static void make_halves(cloud_case *c, ted4_picture *pictures)
{
    size_t n = 0;

    cloud_make(c, FRAMES);
    for (size_t i = 1; i < CLOUD_POINTS; i += 2)
        c->point[i][0] += (float)APART;
    for (uint32_t camera = 0; camera < 2; camera++)
        for (uint32_t frame = 0; frame < FRAMES; frame++) {
            if (camera == 0 && (frame < 1 || frame > 3))
                continue;
            pictures[n] = c->picture;
            pictures[n].camera_id = camera;
            pictures[n].frame = frame;
            pictures[n].is_test = camera == 1 && frame < 2;
            pictures[n++].camera.t[0] -= camera == 1 ? APART : 0;
        }
    c->data.pictures = pictures;
    c->data.n_pictures = n;
}

static void check_span(const ted4_trainer *t, size_t i, float from, float to)
{
    assert_true(tau(t, i, 0) >= from && tau(t, i, 0) < from + 0.02f);
    assert_true(tau(t, i, 2) <= to && tau(t, i, 2) > to - 0.02f);
}

static void test_spans(void **state)
{
    static cloud_case   c;
    static ted4_picture pictures[2 * FRAMES];
    ted4_trainer t;

    (void)state;
    for (int progressive = 0; progressive < 2; progressive++) {
        size_t right = 0;

        make_halves(&c, pictures);
        c.options.progressive = progressive;
        assert_int_equal(ted4_trainer_init(&t, &c.options, &c.data, NULL), 0);
        assert_int_equal(ted4_activation_begin(&t), 0);
        assert_int_equal(t.anchors.n, CLOUD_POINTS);
        for (size_t i = 0; i < t.anchors.n; i++) {
            const double x = (double)t.layout.head.origin[0] +
                             ldexp((double)*ted4_cell(&t.anchors, TED4_ROW_POSITION, i, 0), t.layout.head.exponent);

            right += x > 30;
            check_span(&t, i, !progressive ? 0.0f : x > 30 ? 0.5f : 0.25f, !progressive || x > 30 ? 1.0f : 0.75f);
        }
        assert_int_equal(right, CLOUD_POINTS / 2);
        ted4_trainer_finish(&t);
    }
}

/* ---- when activation is learnt ---- */

/* Anchors that are not transient: those whose span is all times, as it was before activation; those whose span lies inside and has moved since it began. */
typedef struct { size_t whole, learnt, transient; } spans;

static spans count_spans(const ted4_trainer *t)
{
    spans n = { 0, 0, 0 };

    for (size_t i = 0; i < t->anchors.n; i++)
        if (tau(t, i, 0) == 0.0f && tau(t, i, 1) == -3.3f && tau(t, i, 2) == 1.0f && tau(t, i, 3) == -3.3f)
            n.whole++;
        else if (tau(t, i, 1) != -3.3f && tau(t, i, 3) != -3.3f && tau(t, i, 2) - tau(t, i, 0) > 0.6f)
            n.learnt++;
        else
            n.transient++;
    return n;
}

/* Is the activation of every anchor still one that an anchor began with? Growth copies it. */
static int are_seeds(const ted4_trainer *t, const float *seed, size_t n)
{
    for (size_t i = 0; i < t->anchors.n; i++) {
        size_t k = 0;

        while (k < n && (tau(t, i, 0) != seed[4 * k] || tau(t, i, 1) != seed[4 * k + 1] ||
                         tau(t, i, 2) != seed[4 * k + 2] || tau(t, i, 3) != seed[4 * k + 3]))
            k++;
        if (k == n)
            return 0;
    }
    return 1;
}

/* In the static phase nothing is learnt, not even by transients, which fade in and out already. */
static void test_static_phase(void **state)
{
    const ted4_train_options o = ball_options();
    static float seed[4 * BALLS * BALL_POINTS];
    ted4_trainer t;
    size_t       n;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    n = t.anchors.n;
    assert_true(n <= BALLS * BALL_POINTS && count_spans(&t).whole > 10 && count_spans(&t).transient > 10);
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 4; c++)
            seed[4 * i + (size_t)c] = tau(&t, i, c);
    ball_train(&t, SPROUTS);
    assert_true(t.anchors.n > n && are_seeds(&t, seed, n));
    ted4_trainer_finish(&t);
}

static void test_activation(void **state)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, ACTIVATION);
    assert_int_equal(count_spans(&t).learnt, 0);
    assert_true(count_spans(&t).whole > t.anchors.n / 4);
    ball_train(&t, ACTIVATION + 1);
    assert_int_equal(count_spans(&t).whole, 0);
    ball_train(&t, ACTIVATION + 60);
    assert_true(count_spans(&t).learnt > t.anchors.n / 4);
    ted4_trainer_finish(&t);

    ball_set(&o, "progressive=0");
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, 1);
    assert_int_equal(count_spans(&t).whole, 0);
    ball_train(&t, 60);
    assert_true(count_spans(&t).learnt > t.anchors.n / 4);
    ted4_trainer_finish(&t);
}

/* ---- when anchors come and go ---- */

static void test_growth(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;
    int          early = 0, late = 0;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    for (uint64_t step = 0; step < ted4_trainer_total(&t); step++) {
        const size_t before = t.anchors.n;

        ball_train(&t, step + 1);
        if (t.anchors.n == before)
            continue;
        if (step == STAGE1) {
            assert_true(t.anchors.n < before);
        } else {
            assert_true(step > STAGE1 / GROW_EVERY && step <= GROWTH_ENDS);
            assert_true(step == SPROUTS || step % GROW_EVERY == 0);
            early += step < ACTIVATION;
            late += step > ACTIVATION;
        }
    }
    assert_true(early > 0 && late > 0);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spans),
        cmocka_unit_test(test_static_phase),
        cmocka_unit_test(test_activation),
        cmocka_unit_test(test_growth),
    };

    return cmocka_run_group_tests_name("phases", tests, set_up, tear_down);
}
