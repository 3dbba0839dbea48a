/* recon_scene.h - scenes for the tests of ref-decoder/recon: random contents for any header, made
 * without a stream.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RECON_SCENE_H
#define RECON_SCENE_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "norm/half.h"
#include "norm/syntax.h"
#include "random_source.h"

static inline void *scene_take(size_t n, size_t size)
{
    void *p = calloc(n > 0 ? n : 1, size);

    if (p == NULL)
        abort();
    return p;
}

/* Weights that keep values near 1 for layers of any width. */
static inline void scene_networks(struct ted4_scene *s, random_source *r)
{
    s->netr.n = s->shape.n_netr;
    s->netr.values = scene_take(s->netr.n, sizeof(float));
    for (int i = 0; i < TED4_NETS_R; i++) {
        const ted4_net_shape *n = &s->shape.netr[i];
        float *w = s->netr.values + n->first;

        for (unsigned l = 0; l < n->n_layers; l++) {
            const float size = 2.0f / sqrtf((float)n->dim[l]);

            for (size_t k = 0; k < (size_t)n->dim[l + 1] * (n->dim[l] + 1u); k++)
                *w++ = random_float(r, -size, size);
        }
    }
    s->bank.n = s->shape.n_bank;
    s->bank.values = scene_take(s->bank.n, sizeof(float));
    for (size_t i = 0; i < s->bank.n; i++)
        s->bank.values[i] = random_float(r, -1, 1);
}

/* Symbols of a type around a centre, in units of the step, and steps of about Q0. */
static inline void scene_symbols(struct ted4_scene *s, random_source *r, ted4_type t, int low,
                                 int high)
{
    const size_t n = s->head.n_anchors, dim = s->shape.dim[t];

    if (dim == 0)
        return;
    s->step_index[t] = scene_take(n, 1);
    s->symbol[t] = scene_take(n * dim, sizeof(int16_t));
    for (size_t i = 0; i < n; i++)
        s->step_index[t][i] = (uint8_t)(108 + random_u32(r) % 40);
    for (size_t i = 0; i < n * dim; i++)
        s->symbol[t][i] = (int16_t)(low + (int)(random_u32(r) % (uint32_t)(high - low + 1)));
}

/* tau: a in about [0.2, 0.4] and [0.6, 0.8], log2 b in about [-4, -1]. */
static inline void scene_tau(struct ted4_scene *s, random_source *r)
{
    const size_t n = s->head.n_anchors;

    scene_symbols(s, r, TED4_TAU, -400, -100);
    for (size_t i = 0; s->symbol[TED4_TAU] != NULL && i < n; i++) {
        s->symbol[TED4_TAU][i] = (int16_t)(20 + random_u32(r) % 20);
        s->symbol[TED4_TAU][2 * n + i] = (int16_t)(60 + random_u32(r) % 20);
    }
}

/* Fills a scene for h, whose members are in range. Release it with scene_finish. */
static inline void scene_make(struct ted4_scene *s, const ted4_header *h, uint64_t seed)
{
    static const float q0[TED4_TYPES] = { 0.05f, 0.03f, 0.04f, 0.05f, 0.01f };
    random_source r = random_seed(seed);
    const size_t n = h->n_anchors;

    memset(s, 0, sizeof *s);
    s->head = *h;
    memcpy(s->head.step, q0, sizeof q0);
    ted4_shape_make(&s->shape, &s->head);
    scene_networks(s, &r);
    s->position = scene_take(3 * n, sizeof(uint16_t));
    s->dynamic = scene_take(n, 1);
    s->offset_bits = scene_take(n, sizeof(uint16_t));
    for (size_t i = 0; i < n; i++) {
        for (size_t c = 0; c < 3; c++)
            s->position[3 * i + c] = ted4_float_to_half(random_float(&r, -1, 1));
        s->dynamic[i] = h->temporal_mask ? random_u32(&r) % 3 == 0 : h->phi_dim > 0;
        s->offset_bits[i] =
            (uint16_t)((h->offset_mask ? random_u32(&r) >> 8 : ~0u) & ((1u << h->n_offsets) - 1));
    }
    scene_symbols(s, &r, TED4_FEATURE, -30, 30);
    scene_symbols(s, &r, TED4_SCALING, h->scale_domain == TED4_SCALE_LOG2 ? -200 : -5, 40);
    scene_symbols(s, &r, TED4_OFFSET, -40, 40);
    scene_symbols(s, &r, TED4_PHI, -30, 30);
    scene_tau(s, &r);
}

static inline void scene_finish(struct ted4_scene *s)
{
    free(s->netr.values);
    free(s->bank.values);
    free(s->position);
    free(s->dynamic);
    free(s->offset_bits);
    for (int t = 0; t < TED4_TYPES; t++) {
        free(s->step_index[t]);
        free(s->symbol[t]);
    }
}

#endif
