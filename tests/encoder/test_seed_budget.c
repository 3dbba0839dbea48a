/* test_seed_budget.c - train/densify/mv_seed.h: which places become anchors, and how wide, compared
 * with a slow choice that looks at all pairs.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>

#include "test.h"
#define BALL_FRAMES 24
#include "ball_group.h"
#include "ball_missing.h"
#include "train/densify/mv_seed.h"
#include "train/densify/photo_votes.h"
#include "train/densify/plane_sweep.h"
#include "train/math/voxel_set.h"

enum { SPEED = 2, STEPS = 80 };

static int set_up_without_blue(void **state)
{
    (void)state;
    ball_load_without_blue(&folder, &balls, FRAMES, SPEED);
    return 0;
}

static ted4_train_options options(void)
{
    ted4_train_options o = ball_options();

    o.sprouts = 0.3;
    o.max_anchors = 320;
    return o;
}

/* ---- which places a small budget goes to ---- */

/* The places of all frames, most reliable first, and when they exist. */
typedef struct {
    ted4_places list;
    ted4_photo_votes votes;
    float *point;
    uint8_t *colour;
    ted4_span *span;
    uint8_t *goes; /* whether a place comes and goes */
} wanted;

static void find_wanted(ted4_trainer *t, wanted *w)
{
    memset(w, 0, sizeof *w);
    for (uint32_t f = 0; f < FRAMES; f++)
        assert_int_equal(ted4_mv_seed_search(t, f, &w->list), 0);
    qsort(w->list.item, w->list.n, sizeof *w->list.item, ted4_place_compare);
    w->point = malloc(3 * w->list.n * sizeof *w->point);
    w->colour = malloc(3 * w->list.n);
    w->span = calloc(w->list.n, sizeof *w->span);
    w->goes = calloc(w->list.n, 1);
    assert_true(w->point != NULL && w->colour != NULL && w->span != NULL && w->goes != NULL);
    for (size_t i = 0; i < w->list.n; i++) {
        memcpy(w->point + 3 * i, w->list.item[i].point, 3 * sizeof *w->point);
        memcpy(w->colour + 3 * i, w->list.item[i].colour, 3);
    }
    assert_int_equal(ted4_photo_votes_count(&w->votes, t, w->point, w->colour, w->list.n), 0);
    for (size_t i = 0; i < w->list.n; i++)
        w->goes[i] =
            (uint8_t)ted4_photo_votes_span(&w->votes, i, w->list.item[i].frame, &w->span[i]);
}

static void free_wanted(wanted *w)
{
    ted4_photo_votes_free(&w->votes);
    free(w->list.item);
    free(w->point);
    free(w->colour);
    free(w->span);
    free(w->goes);
}

static uint64_t voxel_of(const ted4_place *p, double wide)
{
    return ted4_voxel_key(p->point, wide * exp2(ceil(log2((double)p->size))));
}

/* Chooses at most most places, most reliable first, of which none lies in the voxel of a chosen one
 * that exists in its frame. Returns their number. */
static size_t choose_slowly(const wanted *w, size_t most, double wide, size_t *chosen)
{
    size_t n = 0;

    for (size_t i = 0; i < w->list.n && n < most; i++) {
        const ted4_place *p = &w->list.item[i];
        int is_free = w->goes[i];

        for (size_t k = 0; is_free && k < n; k++) {
            const ted4_span *s = &w->span[chosen[k]];

            is_free = voxel_of(&w->list.item[chosen[k]], wide) != voxel_of(p, wide) ||
                      p->frame < s->from || p->frame > s->to;
        }
        if (is_free)
            chosen[n++] = i;
    }
    return n;
}

static int has_anchor(const ted4_trainer *t, const ted4_place *p, float wide)
{
    for (size_t i = 0; i < t->anchors.n; i++) {
        int is_it = 1;

        for (int j = 0; j < 3; j++)
            is_it &= *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j) == p->point[j];
        for (int j = 0; is_it && j < 6; j++)
            is_it &= fabsf(*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                              t->layout.first[TED4_SCALING] + j) -
                           log2f(wide * p->size)) < 1e-5f;
        if (is_it)
            return 1;
    }
    return 0;
}

/* Asserts that a budget of most anchors is spent on the most reliable places, at the largest width
 * at which all of it is. Returns this width. */
static double check_budget(size_t most)
{
    const ted4_train_options o = options();
    size_t *chosen = malloc((most + 1) * sizeof *chosen), before, n;
    double wide = 1;
    ted4_trainer t;
    wanted w;

    assert_non_null(chosen);
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STEPS);
    find_wanted(&t, &w);
    while (choose_slowly(&w, most, 2 * wide, chosen) == most)
        wide *= 2;
    n = choose_slowly(&w, most, wide, chosen);
    before = t.anchors.n;
    t.opt.max_anchors = (int)(before + most);
    assert_int_equal(ted4_mv_seed(&t), 0);
    assert_int_equal(t.anchors.n, before + n);
    for (size_t i = 0; i < n; i++)
        assert_true(has_anchor(&t, &w.list.item[chosen[i]], (float)wide));
    free_wanted(&w);
    free(chosen);
    ted4_trainer_finish(&t);
    return wide;
}

static void test_budget(void **state)
{
    (void)state;
    assert_true(check_budget(20) > 1);
    assert_true(check_budget(10000) == 1); /* more than there are places */
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_budget) };

    return cmocka_run_group_tests_name("seed_budget", tests, set_up_without_blue, tear_down);
}
