/* test_mv_seed.c - train/densify/mv_seed.h: a fast ball without initial points is found at its
 * positions and times, and gets anchors. Scenes show the effect on quality: bench/report.md.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "ball_group.h"
#include "ball_missing.h"
#include "train/densify/mv_seed.h"
#include "train/densify/photo_votes.h"
#include "train/densify/plane_sweep.h"
#include "train/state/anchor_appearance.h"
#include "train/step/events.h"

enum { SPEED = 2, STEPS = 120 }; /* the blue ball moves 0.5 per frame; its radius is 0.3 */

static int set_up_without_blue(void **state)
{
    (void)state;
    ball_load_without_blue(&folder, &balls, FRAMES, SPEED);
    return 0;
}

static ted4_train_options options(double mv_seed_share)
{
    ted4_train_options o = ball_options();

    o.sprouts = mv_seed_share;
    o.max_anchors = 320;
    return o;
}

static void test_search(void **state)
{
    const ted4_train_options o = options(0.3);
    ted4_places list = { 0 };
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STEPS);
    for (uint32_t f = 0; f < 3; f++) { /* then it leaves the views */
        const size_t first = list.n;
        size_t near = 0;

        assert_int_equal(ted4_mv_seed_search(&t, f, &list), 0);
        for (size_t i = first; i < list.n; i++) {
            const double r = ball_radii(&t, list.item[i].point, SPEED, (double)f / (FRAMES - 1));

            assert_int_equal(list.item[i].frame, f);
            assert_true(list.item[i].score > 0);
            assert_true(list.item[i].size > 0);
            near += r > 0.5 && r < 1.5;
        }
        if (list.n < first + 10 || 2 * near < list.n - first)
            fail_msg("frame %u: %zu places, %zu on the ball", f, list.n - first, near);
    }
    free(list.item);
    ted4_trainer_finish(&t);
}

/* In a sequence of any length each frame may get a place, and their total number is bounded. */
static void test_long(void **state)
{
    const ted4_train_options o = options(0.3);
    const uint32_t frames = balls.n_frames;
    ted4_places list = { 0 };
    ted4_trainer t;

    (void)state;
    for (uint32_t n = 1; n <= 36000; n++) {
        assert_true(ted4_photo_votes_capacity(n) > 0);
        assert_true(ted4_photo_votes_capacity(n) * n <= (size_t)1 << 27);
    }
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STEPS);
    balls.n_frames = 20000;
    for (uint32_t f = 0; f < 3; f++) {
        assert_int_equal(ted4_mv_seed_search(&t, f, &list), 0);
        assert_int_equal(list.n, f + 1);
    }
    free(list.item);
    ted4_trainer_finish(&t);
    balls.n_frames = frames;
}

/* Multi-view seeding uses the anchors that growth leaves: short-lived anchors, at the ball and at
 * its times. */
static void test_mv_seed(void **state)
{
    const ted4_train_options o = options(0.3);
    ted4_trainer t;
    size_t near;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    for (size_t i = 0; i < t.anchors.n; i++)
        assert_false(ted4_is_short_lived(&t, i));
    ball_train(&t, STEPS - 1);
    assert_int_equal(t.anchors.n + ted4_growth_allowance(&t), 224); /* 0.7 of 320 */
    ball_train(&t, STEPS);

    const size_t before = t.anchors.n;

    ball_train(&t, STEPS + 1);
    assert_int_equal(t.anchors.n + ted4_growth_allowance(&t), 320);

    const size_t n = ball_count_short_lived(&t, SPEED, 0.71f, &near);

    if (t.anchors.n < before + 20 || n < t.anchors.n - before || 2 * near < n)
        fail_msg("%zu new anchors, %zu with short lives, %zu on the ball", t.anchors.n - before, n,
                 near);
    ted4_trainer_finish(&t);
}

/* ---- what a new anchor is made of ---- */

enum { MOST_ANCHORS = 320, FEATURES = 8, PHI = 4 };

/* The anchors before seeding. */
typedef struct {
    size_t n;
    float feature[MOST_ANCHORS][FEATURES], phi[MOST_ANCHORS][PHI], point[MOST_ANCHORS][3],
        opacity[MOST_ANCHORS], rgb[3 * MOST_ANCHORS];
} parents;

static void read_values(const ted4_trainer *t, size_t i, int type, int n, float *to)
{
    for (int c = 0; c < n; c++)
        to[c] = *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[type] + c);
}

static void read_point(const ted4_trainer *t, size_t i, float *to)
{
    for (int j = 0; j < 3; j++)
        to[j] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j);
}

static void read_parents(ted4_trainer *t, parents *p)
{
    p->n = t->anchors.n;
    assert_true(p->n <= MOST_ANCHORS);
    assert_int_equal(t->layout.head.feature_dim, FEATURES);
    assert_int_equal(t->layout.head.phi_dim, PHI);
    assert_int_equal(ted4_anchor_appearance(t, p->opacity, p->rgb), 0);
    for (size_t i = 0; i < p->n; i++) {
        read_values(t, i, TED4_FEATURE, FEATURES, p->feature[i]);
        read_values(t, i, TED4_PHI, PHI, p->phi[i]);
        read_point(t, i, p->point[i]);
    }
}

/* The nearest parent, or the one of the most similar colour among those that are opaque. */
static size_t parent_of(const parents *p, const ted4_place *place, int by_colour)
{
    double least = INFINITY;
    size_t best = 0;

    for (size_t i = 0; i < p->n; i++) {
        double off = by_colour && p->opacity[i] < 0.5f ? 10 : 0;

        for (int k = 0; k < 3; k++) {
            const float d = by_colour ? p->rgb[3 * i + (size_t)k] - (float)place->colour[k] / 255
                                      : p->point[i][k] - place->point[k];

            off += (double)(d * d);
        }
        if (off < least - 1e-9) {
            least = off;
            best = i;
        }
    }
    return best;
}

/* A new anchor has the features of the anchor that looks most like it, and moves as its nearest
 * neighbour does. */
static void test_parents(void **state)
{
    const ted4_train_options o = options(0.3);
    static parents p;
    ted4_places list = { 0 };
    ted4_trainer t;
    size_t n = 0, apart = 0;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STEPS);
    read_parents(&t, &p);
    for (uint32_t f = 0; f < FRAMES; f++)
        assert_int_equal(ted4_mv_seed_search(&t, f, &list), 0);
    assert_int_equal(ted4_mv_seed(&t), 0);
    for (size_t i = 0; i < t.anchors.n; i++) {
        const ted4_place *place = ball_place_of(&t, i, &list);
        float feature[FEATURES], phi[PHI];

        if (place == NULL)
            continue;

        const size_t alike = parent_of(&p, place, 1), near = parent_of(&p, place, 0);

        read_values(&t, i, TED4_FEATURE, FEATURES, feature);
        read_values(&t, i, TED4_PHI, PHI, phi);
        assert_memory_equal(feature, p.feature[alike], sizeof feature);
        assert_memory_equal(phi, p.phi[near], sizeof phi);
        apart += alike != near;
        n++;
    }
    assert_int_equal(t.anchors.n, p.n + n);
    assert_true(apart > 5);
    free(list.item);
    ted4_trainer_finish(&t);
}

static void test_impossible(void **state)
{
    ted4_train_options o = options(0.3);
    ted4_trainer t;

    (void)state;
    o.activation = 0;
    ball_begin(&t, &o, &balls, NULL);
    assert_false(ted4_mv_seed_applies(&t));
    assert_int_equal(t.anchors.n + ted4_growth_allowance(&t), 320);
    ted4_trainer_finish(&t);
    o.activation = 1;
    for (size_t i = 0; i < balls.n_pictures; i++) /* two cameras per frame */
        balls.pictures[i].is_test = balls.pictures[i].camera_id >= 2;
    ball_begin(&t, &o, &balls, NULL);
    assert_false(ted4_mv_seed_applies(&t));
    ted4_trainer_finish(&t);
    for (size_t i = 0; i < balls.n_pictures; i++)
        balls.pictures[i].is_test = 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_search),     cmocka_unit_test(test_long),
        cmocka_unit_test(test_mv_seed),    cmocka_unit_test(test_parents),
        cmocka_unit_test(test_impossible),
    };

    return cmocka_run_group_tests_name("mv_seed", tests, set_up_without_blue, tear_down);
}
