/* test_phases.c - the course of training (paper, "Progressive 3D-to-4D Anchor Transformation"):
 * activation begins after the static phase, from the first and last time at which training views
 * see an anchor; anchors are added and pruned within the time of growth; stage 2 only removes
 * anchors, at its beginning; pictures come in rounds, and are rendered from plain values, then from
 * values with noise, then from those that the file will hold. Single steps: test_densify.c,
 * test_traps.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_group.h"
#include "cloud_case.h"
#include "larger.h"
#include "train/densify/short_lived.h"
#include "train/step/stages.h"
#include "train/step/trainer_init.h"

enum {
    STAGE1 = 400,
    INTEGER = 600,
    ACTIVATION = 134,
    MV_SEED_STEP = 120,
    GROWTH_ENDS = 240,
    GROW_EVERY = 20
};

static float tau(const ted4_trainer *t, size_t i, int c)
{
    return *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_TAU] + c);
}

/* ---- first and last visible time ---- */

/* Distance between the two halves of the cloud, in world units: far more than a picture shows. */
#define APART 40.0

/* Every second point of a cloud lies far to the right. One camera sees the left half, in frames 1
 * to 3; the other the right half, in frames 2 to 4 and, held out, in frames 0 and 1. */
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
    c->data.n_cameras = 2;
    c->options.colour = 0; /* there are no files */
}

static void check_span(const ted4_trainer *t, size_t i, float from, float to)
{
    assert_true(tau(t, i, 0) >= from);
    assert_true(tau(t, i, 0) < from + 0.02f);
    assert_true(tau(t, i, 2) <= to);
    assert_true(tau(t, i, 2) > to - 0.02f);
}

static void test_spans(void **state)
{
    static cloud_case c;
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
                             ldexp((double)*ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, i, 0),
                                   t.layout.head.exponent);

            right += x > 30;
            check_span(&t, i,
                       !progressive ? 0.0f
                       : x > 30     ? 0.5f
                                    : 0.25f,
                       !progressive || x > 30 ? 1.0f : 0.75f);
        }
        assert_int_equal(right, CLOUD_POINTS / 2);
        ted4_trainer_finish(&t);
    }
}

/* ---- when activation is learnt ---- */

/* Numbers of anchors: those whose span is still the whole duration, as before activation; those
 * whose span lies inside it and has changed since; and short-lived ones. A short-lived anchor lives
 * for at most three of the five frames: 0.625, including the margins of its span. */
typedef struct {
    size_t whole, learnt, short_lived;
} spans;

static spans count_spans(const ted4_trainer *t)
{
    spans n = { 0, 0, 0 };

    for (size_t i = 0; i < t->anchors.n; i++)
        if (tau(t, i, 0) == 0.0f && tau(t, i, 1) == -3.3f && tau(t, i, 2) == 1.0f &&
            tau(t, i, 3) == -3.3f)
            n.whole++;
        else if (tau(t, i, 1) != -3.3f && tau(t, i, 3) != -3.3f &&
                 tau(t, i, 2) - tau(t, i, 0) > 0.65f)
            n.learnt++;
        else
            n.short_lived++;
    return n;
}

/* Whether the activation of every anchor still equals that of an initial anchor. Growth copies
 * it. */
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

/* In the static phase no activation is learnt, not even that of short-lived anchors, which already
 * fade in and out. */
static void test_static_phase(void **state)
{
    const ted4_train_options o = ball_options();
    static float seed[4 * BALLS * BALL_POINTS];
    ted4_trainer t;
    size_t n;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    n = t.anchors.n;
    assert_true(n <= BALLS * BALL_POINTS);
    assert_true(count_spans(&t).whole > 10);
    assert_true(count_spans(&t).short_lived > 10);
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 4; c++)
            seed[4 * i + (size_t)c] = tau(&t, i, c);
    ball_train(&t, MV_SEED_STEP);
    assert_true(t.anchors.n > n);
    assert_true(are_seeds(&t, seed, n));
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
    int early = 0, late = 0;

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
            assert_true(step > STAGE1 / GROW_EVERY);
            assert_true(step <= GROWTH_ENDS);
            assert_true(step == MV_SEED_STEP || step % GROW_EVERY == 0);
            early += step < ACTIVATION;
            late += step > ACTIVATION;
        }
    }
    assert_true(early > 0);
    assert_true(late > 0);
    ted4_trainer_finish(&t);
}

/* ---- in which order ---- */

/* Fills step[i] with where, in one order of n items, the item is that is number i of another. */
static void step_between(const uint32_t *from, const uint32_t *to, uint32_t n, uint32_t *step)
{
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t k = 0; k < n; k++)
            if (from[k] == to[i])
                step[i] = k;
}

/* Every round contains each training picture once and no held-out one, in a different order, and
 * the orders are not powers of one shuffle. */
static void test_order(void **state)
{
    enum { ROUNDS = 3, MOST = 64 };
    const ted4_train_options o = ball_options();
    uint32_t item[ROUNDS][MOST], step[2][MOST] = { { 0 } };
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    assert_true(t.order.n > 10);
    assert_true(t.order.n <= MOST);
    for (int r = 0; r < ROUNDS; r++) {
        int seen[MOST] = { 0 };

        for (uint32_t i = 0; i < t.order.n; i++) {
            ball_train(&t, t.iteration + 1);
            item[r][i] = t.order.item[t.order.next - 1];
            assert_true(item[r][i] < balls.n_pictures);
            assert_true(item[r][i] < MOST);
            assert_true(!balls.pictures[item[r][i]].is_test);
            assert_int_equal(seen[item[r][i]]++, 0);
        }
        for (int k = 0; k < r; k++)
            assert_memory_not_equal(item[r], item[k], t.order.n * sizeof **item);
    }
    for (int r = 0; r < 2; r++)
        step_between(item[r], item[r + 1], t.order.n, step[r]);
    assert_memory_not_equal(step[0], step[1], t.order.n * sizeof **step);
    ted4_trainer_finish(&t);
}

/* ---- rendered values ---- */

/* Mean distance of the last step's values from whole symbols: a quarter with noise. *most: the
 * largest. */
static double off_symbols(const ted4_trainer *t, double *most)
{
    double sum = 0, n = 0;

    *most = 0;
    for (size_t i = 0; i < t->visible_blocks.n; i++)
        for (int y = 0; y < TED4_TYPES; y++)
            for (size_t at = 0; at < (size_t)t->layout.shape.dim[y] * TED4_LANES; at++) {
                const float q =
                    t->visible_blocks.steps[i][(size_t)y * TED4_LANES + at % TED4_LANES];
                const double
                    k = (double)(t->visible_blocks
                                     .used[i][(size_t)t->layout.first[y] * TED4_LANES + at] /
                                 q),
                    off = fabs(k - rint(k));

                if (!(t->visible_blocks.lanes[i] >> at % TED4_LANES & 1))
                    continue;
                sum += off;
                n++;
                *most = larger(*most, off);
            }
    assert_true(n > 1000);
    return sum / n;
}

/* Whether the step sizes of all anchors are those of the decoder's table (spec 10.1). */
static int steps_are_tabled(const ted4_trainer *t)
{
    for (size_t i = 0; i < t->anchors.n; i++)
        for (int y = 0; y < TED4_TYPES; y++) {
            const double q = (double)*ted4_anchor_value(&t->anchors, TED4_ROW_STEP, i, y);
            const double octaves = log2(q / (double)t->layout.head.step[y]);

            if (t->layout.shape.dim[y] > 0 && !(fabs(32 * octaves - rint(32 * octaves)) <= 1e-3))
                return 0;
        }
    return 1;
}

static void test_drawn(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;
    double most;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STAGE1);
    for (size_t i = 0; i < t.visible_blocks.n; i++)
        assert_ptr_equal(t.visible_blocks.used[i], t.visible_blocks.raw[i]);
    for (size_t i = 0; i < t.anchors.n; i++) /* offset masks stay at 1 in stage 1 */
        for (int k = 0; k < t.layout.head.n_offsets; k++)
            assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i,
                                           t.layout.offset_logit + k) == 1.0f);
    ball_train(&t, INTEGER);
    assert_true(fabs(off_symbols(&t, &most) - 0.25) < 0.02);
    assert_true(most > 0.49);
    assert_false(steps_are_tabled(&t));
    ball_train(&t, INTEGER + 2);
    assert_true(off_symbols(&t, &most) < 1e-4);
    assert_true(most < 1e-2);
    assert_true(steps_are_tabled(&t));
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spans),      cmocka_unit_test(test_static_phase),
        cmocka_unit_test(test_activation), cmocka_unit_test(test_growth),
        cmocka_unit_test(test_order),      cmocka_unit_test(test_drawn),
    };

    return cmocka_run_group_tests_name("phases", tests, set_up, tear_down);
}
