/* mv_seed.c - decides which places become anchors, and sets the first values of those anchors
 * (mv_seed.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mv_seed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/math/voxel_set.h"
#include "math/elementary.h"
#include "train/math/random.h"
#include "train/state/arrangement.h"
#include "photo_votes.h"
#include "plane_sweep.h"
#include "seed_anchor.h"

int ted4_mv_seed_applies(const ted4_trainer *t)
{
    return t->layout.first[TED4_TAU] >= 0 && t->data->n_frames >= 2 &&
           ted4_most_cameras(t->data) >= TED4_CAMERAS_NEEDED;
}

/* A place that may become an anchor, and when it exists. */
typedef struct {
    const ted4_place *place; /* borrowed */
    ted4_span span;
} candidate;

/* Fills c, [list->n], with the places that come and go, in the order of the list; returns their
 * number. */
static size_t list_candidates(const ted4_places *list, const ted4_photo_votes *s, candidate *c)
{
    size_t n = 0;

    for (size_t i = 0; i < list->n; i++) {
        c[n].place = &list->item[i];
        n += ted4_photo_votes_span(s, i, list->item[i].frame, &c[n].span) != 0;
    }
    return n;
}

/* Marks the voxel of a candidate, wide times as large as its place needs, in the frames of its
 * span. Returns 0 if it was already marked in the candidate's own frame, else 1. */
static int mark(ted4_voxel_set *taken, const candidate *c, double wide)
{
    const ted4_place *p = c->place;
    const double voxel = wide * ted4_math_exp2(ceil(ted4_math_log2((double)p->size)));
    const uint64_t key = ted4_voxel_key(p->point, voxel);

    if (!ted4_voxel_set_add(taken, ted4_random(key, p->frame) | 1))
        return 0;
    for (uint32_t f = c->span.from; f <= c->span.to; f++)
        if (f != p->frame)
            ted4_voxel_set_add(taken, ted4_random(key, f) | 1);
    return 1;
}

/* Chooses the candidates that become anchors if anchors are wide times as large as their places:
 * the first of each voxel that is still free, at most most. chosen: [most] their indices, in
 * increasing order. Returns their number. */
static size_t choose(const candidate *c, size_t n, size_t most, double wide, ted4_voxel_set *taken,
                     size_t *chosen)
{
    size_t found = 0;

    ted4_voxel_set_clear(taken);
    for (size_t i = 0; i < n && found < most; i++)
        if (mark(taken, &c[i], wide))
            chosen[found++] = i;
    return found;
}

/* The largest number of doublings of anchors' widths: 32 times as wide as the places are apart. */
enum { MOST_DOUBLINGS = 5 };

/* Chooses like choose, at the largest width that still uses all of a budget of most anchors, so
 * that the budget of a long sequence reaches beyond the few most reliable places. *wide: that
 * width. */
static size_t choose_wide(const candidate *c, size_t n, size_t most, ted4_voxel_set *taken,
                          size_t *chosen, double *wide)
{
    int doublings = 0;

    while (most < n && doublings < MOST_DOUBLINGS &&
           choose(c, n, most, 1 << (doublings + 1), taken, chosen) == most)
        doublings++;
    *wide = 1 << doublings;
    return choose(c, n, most, *wide, taken, chosen);
}

static int plant(ted4_trainer *t, const ted4_places *list, const ted4_photo_votes *s,
                 ted4_seeding *l)
{
    const size_t n_old = t->anchors.n, max_anchors = (size_t)t->opt.max_anchors;
    const size_t allowance = n_old < max_anchors ? max_anchors - n_old : 0;
    const size_t most = allowance < list->n ? allowance : list->n;
    candidate *c = malloc((list->n + 1) * sizeof *c);
    size_t *chosen = malloc((most + 1) * sizeof *chosen), n;
    ted4_voxel_set taken = { 0 };
    double wide;
    int bad = 0;

    if (c == NULL || chosen == NULL || ted4_voxel_set_init(&taken, most * t->data->n_frames) != 0) {
        free(chosen);
        free(c);
        return ted4_trainer_fail(t, "no memory for new anchors");
    }
    n = choose_wide(c, list_candidates(list, s, c), most, &taken, chosen, &wide);
    for (size_t i = 0; !bad && i < n; i++) {
        ted4_place p = *c[chosen[i]].place;

        p.size *= (float)wide;
        bad = ted4_seeding_add(t, l, &p, &c[chosen[i]].span) != 0;
    }
    ted4_voxel_set_finish(&taken);
    free(chosen);
    free(c);
    return bad ? -1 : 0;
}

/* Sorts the list by score and shortens it to at most most places. Copies their points and colours
 * to arrays. Returns 0, or -1 if memory ran out. */
static int arrange(ted4_places *list, size_t most, float **point, uint8_t **colour)
{
    if (list->n > 0)
        qsort(list->item, list->n, sizeof *list->item, ted4_place_compare);
    list->n = list->n < most ? list->n : most;
    *point = malloc((list->n + 1) * 3 * sizeof **point);
    *colour = malloc(list->n * 3 + 1);
    if (*point == NULL || *colour == NULL)
        return -1;
    for (size_t i = 0; i < list->n; i++) {
        memcpy(*point + 3 * i, list->item[i].point, sizeof list->item[i].point);
        memcpy(*colour + 3 * i, list->item[i].colour, 3);
    }
    return 0;
}

int ted4_mv_seed(ted4_trainer *t)
{
    ted4_places list = { 0 };
    ted4_photo_votes s = { 0 };
    ted4_seeding l = { 0 };
    float *point = NULL;
    uint8_t *colour = NULL;
    int bad = 0;

    for (uint32_t f = 0; !bad && f < t->data->n_frames; f++)
        bad = ted4_mv_seed_search(t, f, &list) != 0;
    if (!bad && arrange(&list, ted4_photo_votes_capacity(t->data->n_frames), &point, &colour) != 0)
        bad = ted4_trainer_fail(t, "no memory for new anchors");
    bad = bad || ted4_photo_votes_count(&s, t, point, colour, list.n) != 0 ||
          ted4_seeding_begin(t, &l) != 0 || plant(t, &list, &s, &l) != 0;
    bad = bad || ted4_arrange_anchors(t) != 0;
    ted4_photo_votes_free(&s);
    free(list.item);
    free(point);
    free(colour);
    ted4_seeding_finish(&l);
    return bad ? -1 : 0;
}
