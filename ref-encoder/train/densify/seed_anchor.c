/* seed_anchor.c - see seed_anchor.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "seed_anchor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/elementary.h"
#include "train/state/anchor_appearance.h"

int ted4_seed_parents_measure(ted4_trainer *t, ted4_seed_parents *l)
{
    l->n = t->anchors.n;
    l->rgb = malloc(3 * t->anchors.n * sizeof *l->rgb);
    l->opacity = malloc(t->anchors.n * sizeof *l->opacity);
    if (l->rgb == NULL || l->opacity == NULL)
        return ted4_trainer_fail(t, "no memory to look at anchors");
    return ted4_anchor_appearance(t, l->opacity, l->rgb);
}

void ted4_seed_parents_free(ted4_seed_parents *l)
{
    free(l->rgb);
    free(l->opacity);
    memset(l, 0, sizeof *l);
}

/* An anchor with less opacity than this is not chosen as a source of features. */
#define OPAQUE 0.5f

/* Finds, among the parents, the one with the most similar colour and the nearest one. */
static void find_parents(const ted4_trainer *t, const ted4_seed_parents *l, const ted4_place *p,
                         size_t *alike, size_t *near)
{
    float best_colour = INFINITY, best_place = INFINITY;

    *alike = *near = 0;
    for (size_t i = 0; i < l->n; i++) {
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

int ted4_seed_add(ted4_trainer *t, const ted4_seed_parents *l, const ted4_place *p,
                  const ted4_span *span)
{
    const ted4_layout *y = &t->layout;
    ted4_anchors *a = &t->anchors;
    const size_t i = a->n;
    size_t alike, near;

    if (ted4_anchors_resize(a, i + 1) != 0)
        return ted4_trainer_fail(t, "no memory for %zu anchors", i + 1);
    find_parents(t, l, p, &alike, &near);
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
