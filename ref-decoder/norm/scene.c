/* scene.c - implements scene.h, and ted4_scene_free and ted4_scene_info of ted4.h. A scene lies in
 * its own arena. SPDX-License-Identifier: BSD-2-Clause */
#include "norm/scene.h"

#include <string.h>

ted4_scene *ted4_scene_empty(const ted4_options *o)
{
    ted4_arena arena;
    ted4_scene *s;

    ted4_arena_init(&arena, o);
    s = ted4_arena_alloc(&arena, 1, sizeof *s);
    if (s != NULL)
        s->arena = arena;
    return s;
}

void ted4_scene_free(ted4_scene *s)
{
    ted4_arena arena;

    if (s == NULL)
        return;
    arena = s->arena; /* a copy, because the scene lies in its own arena */
    ted4_arena_finish(&arena);
}

int ted4_blob_alloc(ted4_scene *s, ted4_blob *b, uint64_t n)
{
    b->values = ted4_arena_alloc(&s->arena, n, sizeof *b->values);
    return b->values != NULL;
}

int ted4_scene_alloc_shifts(ted4_scene *s)
{
    s->shift = ted4_arena_alloc(&s->arena, s->shape.n_units, 1);
    return s->shift != NULL;
}

int ted4_scene_alloc_anchors(ted4_scene *s)
{
    ted4_arena *a = &s->arena;
    const size_t n = s->head.n_anchors;
    int good;

    s->position = ted4_arena_alloc(a, n, 3 * sizeof *s->position);
    s->dynamic = ted4_arena_alloc(a, n, 1);
    s->offset_bits = ted4_arena_alloc(a, n, sizeof *s->offset_bits);
    s->prob = ted4_arena_alloc(a, s->shape.n_tiles, TED4_PROBS * sizeof *s->prob);
    good = s->position != NULL && s->dynamic != NULL && s->offset_bits != NULL && s->prob != NULL;
    for (int t = 0; t < TED4_TYPES && good; t++) {
        if (s->shape.dim[t] == 0)
            continue;
        s->step_index[t] = ted4_arena_alloc(a, n, 1);
        s->symbol[t] = ted4_arena_alloc(a, n, s->shape.dim[t] * sizeof(int16_t));
        good = s->step_index[t] != NULL && s->symbol[t] != NULL;
    }
    return good;
}

static int blob_new(ted4_scene *s, ted4_blob *b, uint64_t n)
{
    b->n = n;
    b->mode = TED4_BLOB_AUTO;
    return ted4_blob_alloc(s, b, n);
}

ted4_scene *ted4_scene_new(const ted4_header *h, const ted4_options *o)
{
    ted4_scene *s = ted4_scene_empty(o);

    if (s == NULL)
        return NULL;
    s->head = *h;
    ted4_shape_make(&s->shape, h);
    if (blob_new(s, &s->nete, s->shape.n_nete) && blob_new(s, &s->netr, s->shape.n_netr) &&
        blob_new(s, &s->bank, s->shape.n_bank) && ted4_scene_alloc_shifts(s) &&
        ted4_scene_alloc_anchors(s))
        return s;
    ted4_scene_free(s);
    return NULL;
}

static unsigned popcount16(unsigned x)
{
    unsigned n = 0;

    for (; x != 0; x &= x - 1)
        n++;
    return n;
}

void ted4_scene_info(const ted4_scene *s, ted4_info *info)
{
    const ted4_header *h = &s->head;

    memset(info, 0, sizeof *info);
    info->n_anchors = h->n_anchors;
    info->n_offsets = h->n_offsets;
    info->frames = h->frames;
    info->rate_num = h->rate_num;
    info->rate_den = h->rate_den;
    for (size_t i = 0; i < h->n_anchors; i++) {
        info->n_gaussians += popcount16(s->offset_bits[i]);
        info->n_dynamic += s->dynamic[i];
    }
    info->level = s->level;
    info->view = h->view;
    info->motion = h->motion;
    info->activation = h->activation;
    memcpy(info->origin, h->origin, sizeof info->origin);
    info->exponent = h->exponent;
    memcpy(info->background, h->background, sizeof info->background);
    memcpy(info->hash, s->hash, sizeof info->hash);
}
