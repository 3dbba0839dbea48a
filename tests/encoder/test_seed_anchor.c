/* test_seed_anchor.c - train/densify/seed_anchor.h: new anchors are shown at their places in their
 * frames, wherever the motion of their parents moves them; one that would have to leave the cube
 * for that stands still.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>

#include "test.h"
#include "ball_group.h"
#include "larger.h"
#include "train/densify/seed_anchor.h"
#include "train/state/anchor_masks.h"

/* Anchors that are added in each frame: more and fewer than fill a block, and none. */
static const size_t added[FRAMES] = { 40, 3, 0, 70, 1 };
enum { STEPS = 120, ADDED = 114 };

/* Writes where the first Gaussian of each anchor behind the first n is in a frame. */
static void show(ted4_trainer *t, size_t n, uint32_t frame, float (*to)[3])
{
    const size_t K = t->layout.head.n_offsets;
    ted4_splats s;

    ball_generate(t, frame, &s);
    for (size_t i = n; i < t->anchors.n; i++)
        for (int c = 0; c < 3; c++)
            to[i - n][c] = s.mean[c][i / TED4_LANES * K * TED4_LANES + i % TED4_LANES];
}

/* Begins with anchors that move: by what some steps have taught them, and all of them by shift,
 * in units of normalised space, on every axis. */
static void begin(ted4_trainer *t, const ted4_train_options *o, float shift)
{
    const int motion = 3 + o->feature;

    ball_begin(t, o, &balls, NULL);
    ball_train(t, STEPS);
    if (o->motion != TED4_MOTION_NONE)
        ball_set_biases(t, TED4_NET_DEFORM, (size_t)motion, shift);
    for (size_t i = 0; i < t->anchors.n; i++)
        *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.temporal_logit) = 1.0f;
}

/* Begins seeding, and adds anchors on a line through the middle of the cube, edge half-sizes long
 * on either side. place: [ADDED]. */
static void add(ted4_trainer *t, float edge, ted4_seeding *s, ted4_place *place)
{
    size_t n = 0;

    assert_int_equal(ted4_seeding_begin(t, s), 0);
    for (uint32_t f = 0; f < FRAMES; f++)
        for (size_t i = 0; i < added[f]; i++, n++) {
            const float x = edge * (2.0f * (float)n / (ADDED - 1) - 1.0f);
            const ted4_span span = { f, f, 1, 1 };

            place[n] = (ted4_place) { .point = { x, 0.5f * x, -0.25f * x },
                                      .colour = { 20, 40, 200 },
                                      .frame = f,
                                      .size = 0.01f };
            assert_int_equal(ted4_seeding_add(t, s, &place[n], &span), 0);
        }
    assert_int_equal(n, ADDED);
}

/* Returns the largest distance, on any axis, of an added anchor from its place in its frame. */
static double farthest(ted4_trainer *t, const ted4_seeding *s, const ted4_place *place)
{
    float shown[ADDED][3];
    double most = 0;

    for (uint32_t f = 0; f < FRAMES; f++) {
        show(t, s->n_parents, f, shown);
        for (size_t i = 0; i < ADDED; i++)
            for (int c = 0; place[i].frame == f && c < 3; c++)
                most = larger(most, fabsf(shown[i][c] - place[i].point[c]));
    }
    return most;
}

static size_t count_closed(const ted4_trainer *t, const ted4_seeding *s)
{
    size_t n = 0;

    for (size_t i = s->n_parents; i < t->anchors.n; i++)
        n += !ted4_is_dynamic(t, i);
    return n;
}

static void test_shown_there(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_place place[ADDED];
    ted4_seeding s = { 0 };
    ted4_trainer t;

    (void)state;
    begin(&t, &o, 0.2f);
    add(&t, 0.5f, &s, place);
    assert_true(farthest(&t, &s, place) > 0.15);
    assert_int_equal(ted4_seeding_settle(&t, &s), 0);
    assert_true(farthest(&t, &s, place) < 1e-6);
    assert_int_equal(count_closed(&t, &s), 0);
    ted4_seeding_finish(&s);
    ted4_trainer_finish(&t);
}

/* Near the ends of the line, anchors cannot stay in the cube and be moved to their places. */
static void test_edge(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_place place[ADDED];
    ted4_seeding s = { 0 };
    ted4_trainer t;

    (void)state;
    begin(&t, &o, 0.2f);
    add(&t, 1.0f, &s, place);
    assert_int_equal(ted4_seeding_settle(&t, &s), 0);
    assert_true(farthest(&t, &s, place) < 1e-6);
    assert_in_range(count_closed(&t, &s), ADDED / 20, ADDED / 5);
    for (size_t i = s.n_parents; i < t.anchors.n; i++)
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(*ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, i, c)) <= 1.0f);
    ted4_seeding_finish(&s);
    ted4_trainer_finish(&t);
}

/* Where nothing moves, anchors stay where they were put. */
static void test_still(void **state)
{
    ted4_train_options o = ball_options();
    ted4_place place[ADDED];
    ted4_seeding s = { 0 };
    ted4_trainer t;

    (void)state;
    o.motion = TED4_MOTION_NONE;
    begin(&t, &o, 0);
    add(&t, 1.0f, &s, place);
    assert_int_equal(ted4_seeding_settle(&t, &s), 0);
    for (size_t i = 0; i < ADDED; i++)
        for (int c = 0; c < 3; c++)
            assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, s.n_parents + i, c) ==
                        place[i].point[c]);
    ted4_seeding_finish(&s);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shown_there),
        cmocka_unit_test(test_edge),
        cmocka_unit_test(test_still),
    };

    return cmocka_run_group_tests_name("seed_anchor", tests, set_up, tear_down);
}
