/* seed_anchor.c - see seed_anchor.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "seed_anchor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/elementary.h"
#include "train/state/anchor_appearance.h"
#include "train/state/visible_blocks.h"

int ted4_seeding_begin(ted4_trainer *t, ted4_seeding *s)
{
    s->n_parents = t->anchors.n;
    s->rgb = malloc(3 * t->anchors.n * sizeof *s->rgb);
    s->opacity = malloc(t->anchors.n * sizeof *s->opacity);
    if (s->rgb == NULL || s->opacity == NULL)
        return ted4_trainer_fail(t, "no memory to look at anchors");
    return ted4_anchor_appearance(t, s->opacity, s->rgb);
}

void ted4_seeding_finish(ted4_seeding *s)
{
    free(s->rgb);
    free(s->opacity);
    free(s->frame);
    memset(s, 0, sizeof *s);
}

/* An anchor with less opacity than this is not chosen as a source of features. */
#define OPAQUE 0.5f

/* Finds, among the parents, the one with the most similar colour and the nearest one. */
static void find_parents(const ted4_trainer *t, const ted4_seeding *s, const ted4_place *p,
                         size_t *alike, size_t *near)
{
    float best_colour = INFINITY, best_place = INFINITY;

    *alike = *near = 0;
    for (size_t i = 0; i < s->n_parents; i++) {
        float colour = s->opacity[i] < OPAQUE ? 10.0f : 0.0f, place = 0;

        for (int k = 0; k < 3; k++) {
            const float c = s->rgb[3 * i + (size_t)k] - (float)p->colour[k] / 255.0f;
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

/* Returns 0, or -1 if memory ran out. */
static int note_frame(ted4_seeding *s, uint32_t frame)
{
    if (s->n_added == s->room) {
        const size_t room = 2 * s->room + 64;
        uint32_t *more = realloc(s->frame, room * sizeof *more);

        if (more == NULL)
            return -1;
        s->frame = more;
        s->room = room;
    }
    s->frame[s->n_added++] = frame;
    return 0;
}

int ted4_seeding_add(ted4_trainer *t, ted4_seeding *s, const ted4_place *p, const ted4_span *span)
{
    const ted4_layout *y = &t->layout;
    ted4_anchors *a = &t->anchors;
    const size_t i = a->n;
    size_t alike, near;

    if (ted4_anchors_resize(a, i + 1) != 0 || note_frame(s, p->frame) != 0)
        return ted4_trainer_fail(t, "no memory for %zu anchors", i + 1);
    find_parents(t, s, p, &alike, &near);
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

/* Moves anchor i back by what its motion moves it. mean: the first Gaussians of its block at its
 * frame, [3], whose offsets are 0, so that they are where the anchor is. */
static void settle_anchor(ted4_trainer *t, size_t i, const float mean[3])
{
    float p[3];
    int inside = 1;

    for (int c = 0; c < 3; c++) {
        const float place = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, c);

        p[c] = place - (mean[c] - place);
        inside &= fabsf(p[c]) <= 1.0f;
    }
    for (int c = 0; inside && c < 3; c++)
        *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, c) = p[c];
    if (!inside)
        *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.temporal_logit) =
            TED4_MASK_CLOSED;
}

/* Settles the anchors from..to - 1, which were found in the same frame. */
static int settle_frame(ted4_trainer *t, size_t from, size_t to, uint32_t frame)
{
    const ted4_visible_blocks *v = &t->visible_blocks;
    const size_t block = from / TED4_LANES, K = t->layout.head.n_offsets;
    const ted4_generate_input in = { .layout = &t->layout,
                                     .net = t->net.value,
                                     .n_visible = (to - 1) / TED4_LANES + 1 - block,
                                     .attr = v->used + block,
                                     .position = v->position + block,
                                     .lanes = v->lanes + block,
                                     .num = frame,
                                     .den = t->data->n_frames - 1 };
    ted4_splats g;

    if (ted4_generate(t->work.generator, &in, t->parallel, &g) != 0)
        return ted4_trainer_fail(t, "no memory to look at motion");
    for (size_t i = from; i < to; i++) {
        const size_t at = (i / TED4_LANES - block) * K * TED4_LANES + i % TED4_LANES;

        settle_anchor(t, i, (const float[3]) { g.mean[0][at], g.mean[1][at], g.mean[2][at] });
    }
    return 0;
}

int ted4_seeding_settle(ted4_trainer *t, const ted4_seeding *s)
{
    if (t->layout.head.motion == TED4_MOTION_NONE || t->data->n_frames < 2)
        return 0;
    if (ted4_visible_blocks_fill(t, NULL) != 0)
        return -1;
    ted4_generator_pack(t->work.generator, t->net.value);
    for (size_t from = 0, to = 0; from < s->n_added; from = to) {
        while (to < s->n_added && s->frame[to] == s->frame[from])
            to++;
        if (settle_frame(t, s->n_parents + from, s->n_parents + to, s->frame[from]) != 0)
            return -1;
    }
    return 0;
}
