/* dump_tier.c - writes tiers T1 to T4 of a decoded scene (spec J.3 to J.6). For T2 and T3 it walks
 * the tiles once more, with a coder that only observes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "base/bytes.h"
#include "norm/half.h"
#include "norm/rans.h"
#include "norm/scene.h"
#include "norm/tables.h"
#include "read/observe.h"

typedef struct {
    ted4_coder base; /* must be first */
    ted4_sink *sink;
    void *user;
    int tier;
    size_t n; /* number of symbols of the open substream */
} observer;

static void put8(observer *l, uint8_t v)
{
    l->sink(l->user, &v, 1);
}

static void put16(observer *l, uint16_t v)
{
    uint8_t bytes[2];

    ted4_store16(bytes, v);
    l->sink(l->user, bytes, sizeof bytes);
}

static void put32(observer *l, uint32_t v)
{
    uint8_t bytes[4];

    ted4_store32(bytes, v);
    l->sink(l->user, bytes, sizeof bytes);
}

static observer *observer_of(ted4_coder *c)
{
    return (observer *)c;
}

static void open_substream(ted4_coder *c, size_t n)
{
    observer *l = observer_of(c);

    l->n = n;
    if (l->tier == 3)
        put32(l, (uint32_t)n);
}

/* Every lane ends in TED4_RANS_LOW, since the decoder has checked R-ENT-005. */
static void close_substream(ted4_coder *c)
{
    observer *l = observer_of(c);
    const unsigned lanes = l->n > 0 ? ted4_rans_lanes(l->n) : 0;

    if (l->tier != 3)
        return;
    put32(l, lanes);
    for (unsigned i = 0; i < lanes; i++)
        put32(l, TED4_RANS_LOW);
}

static int bit(ted4_coder *c, uint32_t prob, int value)
{
    (void)prob;
    if (observer_of(c)->tier == 3)
        put8(observer_of(c), (uint8_t)value);
    return value;
}

static void gauss(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    observer *l = observer_of(c);

    for (size_t i = 0; i < n; i++)
        if (l->tier == 3) {
            put16(l, (uint16_t)k[i]);
        } else {
            put8(l, sigma[i]);
            put32(l, (uint32_t)mu[i]);
        }
}

static size_t tile_end(const ted4_scene *s, size_t first)
{
    const size_t left = s->head.n_anchors - first;

    return left < s->head.tile_size ? s->head.n_anchors : first + s->head.tile_size;
}

/* Writes tier T1 (spec J.3). */
static void dump_masks(observer *l, const ted4_scene *s)
{
    const size_t n = s->head.n_anchors;

    for (size_t i = 0; i < 3 * n; i++)
        put32(l, (uint32_t)ted4_half_q24(s->position[i]));
    for (size_t a = 0; a < n; a++) {
        put8(l, s->dynamic[a]);
        put16(l, s->offset_bits[a]);
    }
}

static void dump_steps(observer *l, const ted4_scene *s, size_t first)
{
    for (int t = 0; t < TED4_TYPES; t++)
        for (size_t a = first; s->shape.dim[t] > 0 && a < tile_end(s, first); a++)
            put8(l, s->step_index[t][a]);
}

static int has(const ted4_scene *s, int type, unsigned comp, size_t a)
{
    return type == TED4_PHI      ? s->dynamic[a]
           : type == TED4_OFFSET ? s->offset_bits[a] >> comp / 3 & 1
                                 : 1;
}

/* Writes values of tier T4 (spec J.6, 10.4). T4 is exact whatever the class of the build
 * (R-TOL-007): q is volatile so that no compiler changes the order of the multiplications or keeps
 * the product in a wider type. */
static void dump_values(observer *l, const ted4_scene *s, int type, unsigned comp, size_t first)
{
    const int16_t *k = s->symbol[type] + (size_t)comp * s->head.n_anchors;

    for (size_t a = first; a < tile_end(s, first); a++) {
        if (!has(s, type, comp, a))
            continue;

        const float step = ted4_bits_float(ted4_step[s->step_index[type][a]]);
        const volatile float q = s->head.step[type] * step;

        put16(l, (uint16_t)k[a]);
        put32(l, ted4_float_bits((float)k[a] * q));
    }
}

/* Writes tier T2 or T3 (spec J.4, J.5). */
static ted4_status dump_walk(observer *l, const ted4_scene *given, const ted4_options *o)
{
    ted4_coder_ops ops = ted4_observe_ops;
    ted4_observation it;
    ted4_status verdict = ted4_observe_init(&it, given, o);

    ops.open = open_substream;
    ops.close = close_substream;
    ops.bit = bit;
    ops.gauss = gauss;
    l->base.ops = &ops;
    for (unsigned t = 0; verdict == TED4_OK && t < it.scene.shape.n_tiles; t++) {
        if (l->tier == 2)
            dump_steps(l, given, (size_t)t * given->head.tile_size);
        ted4_walk_tile(&l->base, &it.scene, &it.prior, t, it.work);
        verdict = l->base.error.code;
    }
    ted4_observe_finish(&it);
    return verdict;
}

ted4_status ted4_dump_tier(const ted4_scene *s, int tier, const ted4_options *o, ted4_sink *sink,
                           void *user)
{
    observer l;

    memset(&l, 0, sizeof l);
    l.sink = sink;
    l.user = user;
    l.tier = tier;
    if (tier == 2 || tier == 3)
        return dump_walk(&l, s, o);
    if (tier == 1)
        dump_masks(&l, s);
    for (size_t first = 0; tier == 4 && first < s->head.n_anchors; first = tile_end(s, first))
        for (int t = 0; t < TED4_TYPES; t++)
            for (unsigned c = 0; c < s->shape.dim[t]; c++)
                dump_values(&l, s, t, c, first);
    return TED4_OK;
}
