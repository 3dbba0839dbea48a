/* mutate_scene.c - see mutate_scene.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mutate_scene.h"

#include "places.h"

uint64_t fuzz_boundary(random_source *r)
{
    static const uint64_t bound[] = {
        0,          1,          2,          3,          4,          7,          8,
        10,         12,         16,         20,         30,         31,         32,
        64,         127,        128,        240,        255,        256,        512,
        600,        3600,       4096,       8192,       16384,      32767,      32768,
        36000,      65535,      65536,      1 << 18,    1 << 20,    1 << 22,    (1 << 24) - 1,
        1 << 24,    0x7fffffff, 0x80000000, 0xffffffff, 0x3c00,     0x7c00,     0x35800000,
        0x44800000, 0x00800000, 0x007fffff, 0x7f7fffff, 0x7f800000, 0x7fc00000, 0xff7fffff,
        0x3f800000, UINT64_MAX
    };

    return bound[random_in(r, 0, sizeof bound / sizeof *bound - 1)] + random_in(r, 0, 2) - 1;
}

/* Returns a legal binary32 of any magnitude, extremes included. */
static float any_value(random_source *r)
{
    const uint32_t bits = random_in(r, 0, 2) ? (uint32_t)fuzz_boundary(r) : random_u32(r);

    return ted4_float_legal(bits) ? ted4_bits_float(bits) : (float)random_normal(r);
}

/* Returns any multiple of the lowest power of two that x is one of, with up to 24 significant bits:
 * what mode 2 of a blob may hold where it holds x (spec 7.6). */
static float any_multiple(random_source *r, float x)
{
    const int32_t k = (int32_t)(fuzz_boundary(r) & 0xffffff);
    const uint32_t bits = ted4_float_bits(x);
    const uint32_t m = (bits & 0x7fffff) | 0x800000;
    const int e = bits == 0 ? -8 : (int)(bits >> 23 & 255) - 150 + (int)ted4_log2_floor(m & -m);
    const float y = ldexpf((float)(random_in(r, 0, 1) ? k : -k), e) + 0.0f; /* no -0 */

    return ted4_float_legal(ted4_float_bits(y)) ? y : x;
}

static void change_values(random_source *r, ted4_blob *b)
{
    float *x;

    if (b->n == 0)
        return;
    x = &b->values[random_in(r, 0, (uint32_t)b->n - 1)];
    *x = random_in(r, 0, 1) ? any_value(r) : any_multiple(r, *x);
    b->mode = random_in(r, 0, 2) ? TED4_BLOB_AUTO : TED4_BLOB_RAW;
}

static void change_symbol(random_source *r, ted4_scene *s)
{
    const int t = (int)random_in(r, 0, TED4_TYPES - 1);
    const size_t n = (size_t)s->shape.dim[t] * s->head.n_anchors;
    int16_t *k;

    if (n == 0)
        return;
    k = &s->symbol[t][random_in(r, 0, (uint32_t)n - 1)];
    *k = (int16_t)(random_in(r, 0, 1) ? ted4_sat16((int32_t)fuzz_boundary(r))
                                      : *k + (int)random_in(r, 0, 8) - 4);
    *k = *k == INT16_MIN ? -INT16_MAX : *k;
}

/* Changes header elements that do not determine any shape. */
static void change_world(random_source *r, ted4_header *h)
{
    switch (random_in(r, 0, 4)) {
    case 0:
        h->step[random_in(r, 0, TED4_TYPES - 1)] = ldexpf(1, (int)random_in(r, 0, 30) - 20);
        break;
    case 1: h->origin[random_in(r, 0, 2)] = any_value(r); break;
    case 2: h->exponent = (int8_t)((int)random_in(r, 0, 60) - 30); break;
    case 3: h->scale_domain ^= 1; break;
    default: h->frames = random_in(r, 1, 64); break;
    }
}

static void change_masks(random_source *r, ted4_scene *s)
{
    const uint32_t a = random_in(r, 0, s->head.n_anchors - 1);

    if (s->head.temporal_mask)
        s->dynamic[a] ^= 1;
    if (s->head.offset_mask)
        s->offset_bits[a] ^= (uint16_t)(1u << random_in(r, 0, s->head.n_offsets - 1u));
    s->prob[random_in(r, 0, s->shape.n_tiles * TED4_PROBS - 1)] =
        random_in(r, 0, 1) ? 1 : (uint16_t)random_in(r, 1, 65535);
}

/* Weights of Tier E must lie on the grid, and the steps depend on them. */
static void change_prior(random_source *r, ted4_scene *s)
{
    change_values(r, &s->nete);
    ted4_snap_coarse(&s->head, &s->shape, (int)random_in(r, 0, 20), s->nete.values, s->shift);
    (void)ted4_scene_steps(s, NULL, NULL);
}

/* Changes the grid, the profile, or where one anchor lies. */
static void change_places(random_source *r, ted4_scene *s)
{
    static const uint8_t grid[] = { 6, 7, 8, 9, 10, 11, 12, 16 };
    ted4_blob *const blob[] = { &s->nete, &s->netr, &s->bank };
    const size_t i = random_in(r, 0, 3 * s->head.n_anchors - 1);

    switch (random_in(r, 0, 3)) {
    case 0: s->grid = grid[random_in(r, 0, sizeof grid - 1)]; break;
    case 1:
        s->profile = (uint8_t)random_in(r, TED4_PROFILE_MAIN, TED4_PROFILE_COMPACT);
        s->grid = 16;
        for (int b = 0; b < 3; b++)
            blob[b]->mode = TED4_BLOB_AUTO;
        break;
    case 2: s->position[i] = (uint16_t)random_in(r, 0, 65535); break;
    default: s->position[i] = (uint16_t)(s->position[i] + random_in(r, 0, 2) - 1); break;
    }
    (void)fuzz_settle(s->position, s->head.n_anchors,
                      s->profile == TED4_PROFILE_COMPACT ? s->grid : 16);
    (void)ted4_scene_steps(s, NULL, NULL);
}

void fuzz_change_scene(random_source *r, ted4_scene *s)
{
    for (uint32_t i = random_in(r, 1, 4); i > 0; i--)
        switch (random_in(r, 0, 6)) {
        case 0: change_values(r, &s->netr); break;
        case 1: change_values(r, &s->bank); break;
        case 2: change_world(r, &s->head); break;
        case 3: change_masks(r, s); break;
        case 4: change_prior(r, s); break;
        case 5: change_places(r, s); break;
        default: change_symbol(r, s); break;
        }
    random_tidy(s);
}

ted4_scene *fuzz_any_scene(random_source *r)
{
    ted4_header h = random_header(r);
    const uint32_t grid = random_in(r, 0, 14);
    int wild;

    h.n_anchors = random_in(r, 1, random_in(r, 0, 3) ? 6 : 70);
    wild = (int)random_in(r, 0, 1);
    return grid < 6    ? random_scene_of(r, &h, wild)
           : grid < 13 ? random_compact_of(r, &h, wild, grid)
                       : random_compact_of(r, &h, wild, 16);
}
