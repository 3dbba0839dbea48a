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
#include "photo_votes.h"
#include "plane_sweep.h"
#include "train/model/normalise.h"
#include "train/state/anchor_appearance.h"

int ted4_mv_seed_reach(const ted4_trainer *t)
{
    return t->layout.first[TED4_TAU] < 0 || t->data->n_frames < 2 ? -1 : ted4_alternating_reach(t);
}

/* The current appearance of the anchors (ted4_anchor_appearance). */
typedef struct {
    float *rgb, *opacity; /* owned: [n][3], [n] */
} appearance;

/* Returns 0, or -1 with t->message filled. */
static int measure_appearance(ted4_trainer *t, appearance *l)
{
    l->rgb = malloc(3 * t->anchors.n * sizeof *l->rgb);
    l->opacity = malloc(t->anchors.n * sizeof *l->opacity);
    if (l->rgb == NULL || l->opacity == NULL)
        return ted4_trainer_fail(t, "no memory to look at anchors");
    return ted4_anchor_appearance(t, l->opacity, l->rgb);
}

/* An anchor with less opacity than this is not chosen as a source of features. */
#define OPAQUE 0.5f

/* Finds, among the first n anchors, the one with the most similar colour and the nearest one. */
static void find_parents(const ted4_trainer *t, const appearance *l, size_t n, const ted4_place *p,
                         size_t *alike, size_t *near)
{
    float best_colour = INFINITY, best_place = INFINITY;

    *alike = *near = 0;
    for (size_t i = 0; i < n; i++) {
        float colour = l->opacity[i] < OPAQUE ? 10.0f : 0.0f, place = 0;

        for (int k = 0; k < 3; k++) {
            const float c = l->rgb[3 * i + (size_t)k] - (float)p->colour[k] / 255.0f;
            const float d = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, k) - p->point[k];

            colour += c * c;
            place += d * d;
        }
        if (colour < best_colour) {
            best_colour = colour;
            *alike = i;
        }
        if (place < best_place) {
            best_place = place;
            *near = i;
        }
    }
}

/* Adds an anchor at a place. It takes its features from the anchor with the most similar colour,
 * and its motion from the nearest anchor. */
static int add(ted4_trainer *t, const appearance *l, size_t n_old, const ted4_place *p,
               const ted4_span *span)
{
    const ted4_layout *y = &t->layout;
    ted4_anchors *a = &t->anchors;
    const size_t i = a->n;
    size_t alike, near;

    if (ted4_anchors_resize(a, i + 1) != 0)
        return ted4_trainer_fail(t, "no memory for %zu anchors", i + 1);
    find_parents(t, l, n_old, p, &alike, &near);
    for (int r = 0; r < y->n_channels; r++)
        *ted4_anchor_value(a, TED4_ROW_VALUE, i, r) =
            *ted4_anchor_value(a, TED4_ROW_VALUE, near, r);
    for (int r = 0; r < y->head.feature_dim; r++)
        *ted4_anchor_value(a, TED4_ROW_VALUE, i, y->first[TED4_FEATURE] + r) =
            *ted4_anchor_value(a, TED4_ROW_VALUE, alike, y->first[TED4_FEATURE] + r);
    for (int j = 0; j < 3; j++)
        *ted4_anchor_value(a, TED4_ROW_POSITION, i, j) = p->point[j];
    for (int j = 0; j < 3 * y->head.n_offsets; j++)
        *ted4_anchor_value(a, TED4_ROW_VALUE, i, y->first[TED4_OFFSET] + j) = 0.0f;
    for (int j = 0; j < 6; j++)
        *ted4_anchor_value(a, TED4_ROW_VALUE, i, y->first[TED4_SCALING] + j) =
            ted4_math_log2f(p->size);
    ted4_span_set(t, i, span);
    return 0;
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
                 const appearance *l)
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
            bad = add(t, l, n_old, p, &span) != 0;
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
    appearance l = { 0 };
    float *point = NULL;
    uint8_t *colour = NULL;
    const int reach = ted4_mv_seed_reach(t);
    int bad = 0;

    if (reach < 0)
        return 0;
    for (uint32_t f = 0; !bad && f < t->data->n_frames; f++)
        bad = ted4_mv_seed_search(t, f, (uint32_t)reach, &list) != 0;
    if (!bad && arrange(&list, ted4_mv_seed_capacity(t->data->n_frames), &point, &colour) != 0)
        bad = ted4_trainer_fail(t, "no memory for new anchors");
    bad = bad || ted4_photo_votes_count(&s, t, point, colour, list.n, (uint32_t)reach) != 0 ||
          measure_appearance(t, &l) != 0 || plant(t, &list, &s, &l) != 0;
    if (!bad && ted4_anchors_sort(&t->anchors) != 0)
        bad = ted4_trainer_fail(t, "no memory to sort anchors");
    ted4_photo_votes_free(&s);
    free(list.item);
    free(point);
    free(colour);
    free(l.rgb);
    free(l.opacity);
    return bad ? -1 : 0;
}
