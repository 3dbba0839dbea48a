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

/* Marks the voxel of a place in the frames of its span. Returns 0 if it was already marked in its
 * own frame, else 1. */
static int mark(ted4_voxel_set *taken, const ted4_place *p, const ted4_span *span)
{
    const double voxel = ted4_math_exp2(ceil(ted4_math_log2((double)p->size)));
    const uint64_t key = ted4_voxel_key(p->point, voxel);

    if (!ted4_voxel_set_add(taken, ted4_mix(key + p->frame) | 1))
        return 0;
    for (uint32_t f = span->from; f <= span->to; f++)
        if (f != p->frame)
            ted4_voxel_set_add(taken, ted4_mix(key + f) | 1);
    return 1;
}

static int plant(ted4_trainer *t, const ted4_places *list, const ted4_photo_votes *s,
                 const ted4_seed_parents *l)
{
    const size_t n_old = t->anchors.n, most = (size_t)t->opt.max_anchors;
    const size_t allowance = n_old < most ? most - n_old : 0;
    ted4_voxel_set taken;
    int bad = 0;

    if (ted4_voxel_set_init(&taken,
                            (list->n < allowance ? list->n : allowance) * t->data->n_frames) != 0)
        return ted4_trainer_fail(t, "no memory for new anchors");
    for (size_t i = 0; !bad && i < list->n && t->anchors.n < most; i++) {
        const ted4_place *p = &list->item[i];
        ted4_span span;

        if (ted4_photo_votes_span(s, i, p->frame, &span) && mark(&taken, p, &span))
            bad = ted4_seed_add(t, l, p, &span) != 0;
    }
    ted4_voxel_set_finish(&taken);
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
    ted4_seed_parents l = { 0 };
    float *point = NULL;
    uint8_t *colour = NULL;
    int bad = 0;

    for (uint32_t f = 0; !bad && f < t->data->n_frames; f++)
        bad = ted4_mv_seed_search(t, f, &list) != 0;
    if (!bad && arrange(&list, ted4_mv_seed_capacity(t->data->n_frames), &point, &colour) != 0)
        bad = ted4_trainer_fail(t, "no memory for new anchors");
    bad = bad || ted4_photo_votes_count(&s, t, point, colour, list.n) != 0 ||
          ted4_seed_parents_measure(t, &l) != 0 || plant(t, &list, &s, &l) != 0;
    bad = bad || ted4_arrange_anchors(t) != 0;
    ted4_photo_votes_free(&s);
    free(list.item);
    free(point);
    free(colour);
    ted4_seed_parents_free(&l);
    return bad ? -1 : 0;
}
