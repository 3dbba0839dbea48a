/* test_densify.c - growth and pruning of anchors (train/densify/densify.c) from statistics that the
 * test sets.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "anchor_checks.h"
#include "cloud_case.h"
#include "train/densify/densify.h"
#include "train/math/voxel_set.h"
#include "train/state/visible_blocks.h"
#include "train/step/events.h"
#include "train/step/trainer_init.h"

static cloud_case cloud;

/* ---- growth ---- */

enum { K = 3, SEEN = 5 }; /* an offset counts if it was in more than 0.4 grow_every = 4 views */

#define THRESHOLD 2e-4f

static void plant(ted4_trainer *t, size_t i, int k, float gradient, float views)
{
    *ted4_anchor_value(&t->anchors, TED4_ROW_GRADIENT, i, k) = gradient * views;
    *ted4_anchor_value(&t->anchors, TED4_ROW_GRADIENT, i, K + k) = views;
}

/* Makes offset k of anchor i point half-way between lattice points, at a place that no other anchor
 * points at. */
static void aim(ted4_trainer *t, size_t i, int k, float place[3])
{
    const ted4_layout *l = &t->layout;

    for (int j = 0; j < 3; j++) {
        const float o = 0.5f + 0.1f * (float)(k - 1),
                    s = exp2f(*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                                 l->first[TED4_SCALING] + j));

        *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, l->first[TED4_OFFSET] + 3 * k + j) = o;
        place[j] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j) + o * s;
    }
}

/* Writes the index of each anchor into its first channel, which children inherit. */
static void name_anchors(ted4_trainer *t)
{
    for (size_t i = 0; i < t->anchors.n; i++)
        *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, 0) = (float)(i + 1);
}

/* Fills the moments of all anchors, since new anchors are those with zero moments. */
static void give_moments(ted4_trainer *t)
{
    for (size_t i = 0; i < t->anchors.n; i++)
        for (int c = 0; c < t->layout.n_channels; c++)
            *ted4_anchor_value(&t->anchors, TED4_ROW_V, i, c) = 1.0f;
}

static int is_new(const ted4_trainer *t, size_t i)
{
    return *ted4_anchor_value(&t->anchors, TED4_ROW_V, i, 0) == 0.0f;
}

/* Checks a new anchor: it lies on the grid of one of three depths, at most half a voxel from the
 * place, and has its parent's values except for offsets and scalings. */
static void check_child(const ted4_trainer *t, size_t i, const float place[3])
{
    const ted4_layout *l = &t->layout;
    const int scaling = l->first[TED4_SCALING];
    const double s = exp2((double)*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, scaling));
    int depth = 0;

    while (depth < 3 && fabs(s - t->voxel * pow(0.25, depth)) > 1e-5 * s)
        depth++;
    assert_true(depth < 3);
    for (int j = 0; j < 3; j++) {
        const double x = (double)*ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j);

        assert_true(fabs(x - (double)place[j]) <= 0.5 * s + 1e-6);
        assert_true(fabs(x / s - rint(x / s)) < 1e-4);
    }
    for (int c = 0; c < l->n_channels; c++) {
        const float x = *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, c);

        if (c >= l->first[TED4_OFFSET] && c < l->first[TED4_OFFSET] + 3 * K)
            assert_true(x == 0.0f);
        if (c >= scaling && c < scaling + 6)
            assert_true(fabs((double)x - log2(s)) < 1e-5);
        if (c >= l->offset_logit)
            assert_true(x == 1.0f);
        assert_true(*ted4_anchor_value(&t->anchors, TED4_ROW_V, i, c) == 0.0f);
    }
    for (int r = 0; r < 2 * K; r++)
        assert_true(*ted4_anchor_value(&t->anchors, TED4_ROW_GRADIENT, i, r) == 0.0f);
}

/* Every fourth anchor gets a strong gradient on one offset; others get a weak one, or too few
 * views. */
static void test_growth(void **state)
{
    static float place[CLOUD_POINTS][3];
    ted4_trainer t;
    size_t children[CLOUD_POINTS] = { 0 }, n_parents = 0, n_planted = 0, old = 0;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    name_anchors(&t);
    give_moments(&t);
    for (size_t i = 0; i < CLOUD_POINTS; i++) {
        const int k = (int)(i % K);

        aim(&t, i, k, place[i]);
        plant(&t, i, k, (i % 4 == 1 ? 0.9f : 20.0f) * THRESHOLD, i % 4 < 2 ? SEEN : SEEN - 1);
        n_planted += i % 4 == 0;
    }
    assert_int_equal(ted4_densify_adjust(&t, ted4_growth_allowance(&t)), 0);
    anchors_check(&t.anchors);
    for (size_t i = 0; i < t.anchors.n; i++) {
        const size_t id = (size_t)*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, 0) - 1;

        assert_true(i == 0 || anchors_morton(&t.anchors, i - 1) <= anchors_morton(&t.anchors, i));
        for (int j = 0; j < 3; j++)
            assert_true(fabsf(*ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, i, j)) <= 1.0f);
        if (!is_new(&t, i)) {
            old++;
            continue;
        }
        assert_int_equal(id % 4, 0);
        check_child(&t, i, place[id]);
        n_parents += children[id]++ == 0;
        assert_true(children[id] <= 3);
    }
    assert_int_equal(old, CLOUD_POINTS);
    /* One in 64 fails the random selection at all three depths. */
    assert_true(n_parents >= n_planted * 9 / 10);
    ted4_trainer_finish(&t);
}

/* A finer grid needs a stronger gradient: 2 and 4 times the threshold at the second and third
 * depth. */
static void test_growth_depths(void **state)
{
    static float place[CLOUD_POINTS][3];

    (void)state;
    for (int most = 0; most < 3; most++) {
        ted4_trainer t;
        int n[3] = { 0 };

        cloud_make(&cloud, 5);
        cloud_begin(&cloud, &t);
        give_moments(&t);
        for (size_t i = 0; i < CLOUD_POINTS; i++) {
            aim(&t, i, K - 1, place[i]); /* nearer to the next voxel, free only at the lattice's
                                            faces, than to its own */
            plant(&t, i, K - 1, 1.5f * (float)(1 << most) * THRESHOLD, SEEN);
        }
        assert_int_equal(ted4_densify_adjust(&t, ted4_growth_allowance(&t)), 0);
        for (size_t i = 0; i < t.anchors.n; i++)
            if (is_new(&t, i))
                n[(int)lrint(0.5 * (log2(t.voxel) -
                                    (double)*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i,
                                                               t.layout.first[TED4_SCALING])))]++;
        for (int depth = 0; depth < 3; depth++)
            if ((n[depth] > 10) != (depth <= most) || (n[depth] > 0) != (depth <= most))
                fail_msg("%d at depth %d, gradients of %g thresholds", n[depth], depth,
                         1.5 * (1 << most));
        ted4_trainer_finish(&t);
    }
}

/* Makes the first offset of anchor i point at a place whose x is beyond the cube, with a strong
 * gradient. */
static void aim_outside(ted4_trainer *t, size_t i, float x)
{
    const float size =
        exp2f(*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_SCALING]));

    *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_OFFSET]) =
        (x - *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, 0)) / size;
    plant(t, i, 0, 1.0f, SEEN);
}

/* Of each adjustment and depth, no two anchors share a voxel; a place outside the cube grows
 * nothing; statistics that were used are reset, the others continue. */
static void test_growth_limits(void **state)
{
    ted4_trainer t;
    float place[3];

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    give_moments(&t);
    aim(&t, 50, 0, place);
    for (int k = 0; k < K; k++) /* offsets 1 and 2 are zero: the voxel is occupied */
        plant(&t, 50, k, 1.0f, SEEN);
    plant(&t, 51, 0, 1.0f, SEEN - 1);
    aim_outside(&t, 52, 1.25f);
    aim_outside(&t, 53, 30.0f);
    *ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, 51, 0) = 0.75f;
    *ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, 51, 1) = 3.0f;
    name_anchors(&t);
    assert_int_equal(ted4_densify_adjust(&t, ted4_growth_allowance(&t)), 0);
    assert_true(t.anchors.n <= CLOUD_POINTS + 3);
    for (size_t i = 0; i < t.anchors.n; i++) {
        const float id = *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, 0) - 1.0f;

        if (is_new(&t, i)) {
            assert_true(id == 50.0f);
            check_child(&t, i, place);
        } else if (id == 51.0f) {
            assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_GRADIENT, i, K) == SEEN - 1);
            assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 0) == 0.75f);
        } else {
            for (int r = 0; r < 2 * K; r++)
                assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_GRADIENT, i, r) == 0.0f);
        }
    }
    ted4_trainer_finish(&t);
}

/* If there is room for some candidates only, those with the largest gradients become anchors. */
static void test_max_anchors(void **state)
{
    enum { CAPACITY = 7 };

    (void)state;
    for (int full = 0; full < 2; full++) {
        ted4_trainer t;
        float place[3], least = 1e9f;
        size_t n = 0;

        cloud_make(&cloud, 5);
        cloud.options.init_anchors = CLOUD_POINTS;
        cloud.options.max_anchors = CLOUD_POINTS + (full ? -20 : CAPACITY);
        cloud_begin(&cloud, &t);
        give_moments(&t);
        for (size_t i = 0; i < CLOUD_POINTS; i++) {
            aim(&t, i, 0, place);
            plant(&t, i, 0, (1.0f + (float)i) * THRESHOLD, SEEN);
        }
        name_anchors(&t);
        assert_int_equal(ted4_densify_adjust(&t, ted4_growth_allowance(&t)), 0);
        assert_int_equal(t.anchors.n, CLOUD_POINTS + (full ? 0 : CAPACITY));
        for (size_t i = 0; i < t.anchors.n; i++)
            if (is_new(&t, i)) {
                least = fminf(least, *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, 0));
                n++;
            }
        assert_int_equal(n, full ? 0 : CAPACITY);
        /* Random selection and the cube's faces drop some of the strongest; the weakest are never
         * chosen. */
        assert_true(full || least > CLOUD_POINTS - 60);
        ted4_trainer_finish(&t);
    }
}

/* ---- pruning ---- */

enum { VISITS = 9 }; /* more than 0.8 grow_every */

static void fade(ted4_trainer *t, size_t i, double mean, float visits)
{
    *ted4_anchor_value(&t->anchors, TED4_ROW_OPACITY, i, 0) = (float)mean * visits;
    *ted4_anchor_value(&t->anchors, TED4_ROW_OPACITY, i, 1) = visits;
    *ted4_anchor_value(&t->anchors, TED4_ROW_OPACITY, i, 2) = visits;
}

/* Anchor 4 i has faded; 4 i + 1 just not; 4 i + 2 has faded but too few visits; 4 i + 3 was never
 * seen. */
static void test_pruning(void **state)
{
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    name_anchors(&t);
    for (size_t i = 0; i < CLOUD_POINTS; i++)
        if (i % 4 < 3)
            fade(&t, i, t.opt.prune_opacity * (i % 4 == 1 ? 1.01 : 0.99), i % 4 == 2 ? 8 : VISITS);
    assert_int_equal(ted4_densify_adjust(&t, ted4_growth_allowance(&t)), 0);
    anchors_check(&t.anchors);
    assert_int_equal(t.anchors.n, CLOUD_POINTS * 3 / 4);
    for (size_t i = 0; i < t.anchors.n; i++) {
        const int id = (int)*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, 0) - 1;

        assert_int_not_equal(id % 4, 0);
        assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 1) ==
                    (id % 4 == 2 ? 8.0f : 0.0f));
    }
    ted4_trainer_finish(&t);
}

/* Short-lived anchors are judged only after enough visits during their lives, and by their mean
 * opacity over these: each has nine visits, of which there are while it lives. */
static void test_pruning_short_lives(void **state)
{
    static const struct {
        float there;
        double mean;
        int goes;
    } lives[] = {
        { 0, 0, 0 },
        { 7, 0, 0 },
        { 8, 0.99, 1 },
        { 8, 1.01, 0 },
    };
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    name_anchors(&t);
    for (size_t i = 0; i < CLOUD_POINTS; i++) {
        fade(&t, i, t.opt.prune_opacity * lives[i % 4].mean, lives[i % 4].there);
        *ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 1) = VISITS;
    }
    assert_int_equal(ted4_densify_adjust(&t, ted4_growth_allowance(&t)), 0);
    assert_int_equal(t.anchors.n, CLOUD_POINTS * 3 / 4);
    for (size_t i = 0; i < t.anchors.n; i++) {
        const int id = (int)*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, 0) - 1;

        assert_false(lives[id % 4].goes);
        assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 1) ==
                    (lives[id % 4].there < 8 ? VISITS : 0));
    }
    ted4_trainer_finish(&t);
}

/* If all anchors have faded, one group of lanes remains: the most opaque anchors. */
static void test_all_faded(void **state)
{
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    name_anchors(&t);
    for (size_t i = 0; i < CLOUD_POINTS; i++)
        fade(&t, i, t.opt.prune_opacity * (0.1 + (double)(i * 7 % CLOUD_POINTS) / 1000), VISITS);
    assert_int_equal(ted4_densify_adjust(&t, ted4_growth_allowance(&t)), 0);
    anchors_check(&t.anchors);
    assert_int_equal(t.anchors.n, TED4_LANES);
    for (size_t i = 0; i < t.anchors.n; i++) {
        const size_t id = (size_t)*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, 0) - 1;

        assert_true(id * 7 % CLOUD_POINTS >= CLOUD_POINTS - TED4_LANES);
    }
    ted4_trainer_finish(&t);
}

/* ---- statistics of a step ---- */

static void test_gather(void **state)
{
    enum { SPLATS = 2 * K * TED4_LANES };
    static float opacity[SPLATS], moved[SPLATS];
    static uint8_t visible[SPLATS];
    const ted4_splats s = { .n = SPLATS, .opacity = opacity };
    ted4_generate_input in = { 0 };
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    in.layout = &t.layout;
    in.num = 1;
    in.den = 4;
    in.activation = 1;
    for (size_t i = 0; i < CLOUD_POINTS; i++) /* odd ones live exactly at 1/4, even ones at 1/2 */
        for (int c = 0; c < 4; c++)
            *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.first[TED4_TAU] + c) =
                c % 2   ? -4.0f
                : i % 2 ? 0.25f
                        : 0.5f;
    for (size_t i = 0; i < SPLATS; i++) {
        opacity[i] = 0.25f * (float)(i % 3);
        moved[i] = (float)i;
        visible[i] = i % 2;
    }
    assert_int_equal(ted4_visible_blocks_fill(&t, NULL), 0);
    t.visible_blocks.n = 2; /* the second block is visible, and half of the fourth */
    t.visible_blocks.block[0] = 1;
    t.visible_blocks.block[1] = 3;
    t.visible_blocks.lanes[1] = 0xffffu;
    t.work.splat_gradient.mean2d = moved;
    t.work.splat_gradient.visible = visible;
    in.n_visible = t.visible_blocks.n;
    in.attr = t.visible_blocks.raw;
    in.lanes = t.visible_blocks.lanes;
    ted4_densify_gather(&t, &in, &s);
    ted4_densify_gather(&t, &in, &s);
    for (size_t i = 0; i < t.anchors.n; i++) {
        const size_t block_index = i / TED4_LANES == 1 ? 0 : 1, j = i % TED4_LANES;
        const int seen = i / TED4_LANES == 1 || i / TED4_LANES == 3;
        float sum = 0;

        for (int k = 0; k < K; k++) {
            const size_t at = (block_index * K + (size_t)k) * TED4_LANES + j;
            const float on = seen && at % 2 ? 2.0f : 0.0f;

            sum += seen ? 2 * opacity[at] : 0;
            assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_GRADIENT, i, k) == on * moved[at]);
            assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_GRADIENT, i, K + k) == on);
        }
        assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 0) == sum);
        assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 1) ==
                    (seen && (block_index == 0 || j < 16) ? 2.0f : 0.0f));
        assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 2) ==
                    (seen && i % 2 && (block_index == 0 || j < 16) ? 2.0f : 0.0f));
    }
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_growth),        cmocka_unit_test(test_growth_depths),
        cmocka_unit_test(test_growth_limits), cmocka_unit_test(test_max_anchors),
        cmocka_unit_test(test_pruning),       cmocka_unit_test(test_pruning_short_lives),
        cmocka_unit_test(test_all_faded),     cmocka_unit_test(test_gather),
    };

    return cmocka_run_group_tests_name("densify", tests, NULL, NULL);
}
