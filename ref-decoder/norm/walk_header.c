/* walk_header.c - spec 6.1: codes the payload of HEAD. Each element has its own line, in file
 * order. SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coder.h"

#include "base/bytes.h"
#include "norm/limits.h"

/* The range of an element by itself, and the range that the other elements leave to it. */
typedef struct {
    uint32_t low, high; /* a value outside is hdr.range */
    int exists;         /* 0: must be 0; 1: must be at least low_if; otherwise hdr.combination */
    uint32_t low_if;
} range;

static uint32_t element(ted4_coder *c, const char *name, int64_t index, unsigned width,
                        uint32_t value, range r)
{
    const size_t at = c->pos;

    value = ted4_code(c, name, index, width, value);
    ted4_require(c, value >= r.low && value <= r.high, TED4_E_HDR_RANGE, at);
    ted4_require(c, r.exists ? value >= r.low_if : value == 0, TED4_E_HDR_COMBINATION, at);
    return value;
}

static range between(uint32_t low, uint32_t high)
{
    return (range) { low, high, 1, low };
}

/* Returns the range low .. high if the condition holds, else 0 .. 0. */
static range only_if(int condition, uint32_t low, uint32_t high)
{
    return (range) { 0, high, condition, low };
}

static void u8(ted4_coder *c, const char *name, uint8_t *v, range r)
{
    *v = (uint8_t)element(c, name, 0, 1, *v, r);
}

static void u16(ted4_coder *c, const char *name, uint16_t *v, range r)
{
    *v = (uint16_t)element(c, name, 0, 2, *v, r);
}

static void u32(ted4_coder *c, const char *name, uint32_t *v, range r)
{
    *v = element(c, name, 0, 4, *v, r);
}

/* Codes an element that the level also bounds. */
static void levelled(ted4_coder *c, const char *name, uint32_t *v, range r, uint32_t bound)
{
    const size_t at = c->pos;

    u32(c, name, v, r);
    ted4_require(c, *v <= bound, TED4_E_LVL_EXCEEDED, at);
}

static void walk_size(ted4_coder *c, ted4_header *h, const ted4_limits *l)
{
    size_t at;

    levelled(c, "n_anchors", &h->n_anchors, between(1, UINT32_MAX), l->n_anchors);
    u32(c, "tile_size", &h->tile_size, between(64, 65536));
    at = c->pos;
    u8(c, "n_offsets", &h->n_offsets, between(1, TED4_MAX_OFFSETS));
    ted4_require(c, h->n_offsets <= l->n_offsets, TED4_E_LVL_EXCEEDED, at);
    u8(c, "feature_dim", &h->feature_dim, between(1, TED4_MAX_FEATURE));
}

static void walk_motion(ted4_coder *c, ted4_header *h, const ted4_limits *l)
{
    int moves, banked;

    u8(c, "motion", &h->motion, between(0, TED4_MOTION_INR));
    moves = h->motion != TED4_MOTION_NONE;
    banked = moves && h->motion != TED4_MOTION_INR;
    u8(c, "phi_dim", &h->phi_dim, only_if(banked, 1, TED4_MAX_PHI));
    levelled(c, "bank_rows", &h->bank_rows, only_if(banked, 1, UINT32_MAX), l->frames);
    u16(c, "bank_dim", &h->bank_dim, only_if(banked, 1, TED4_MAX_WIDTH));
    u8(c, "deform_layers", &h->deform_layers, only_if(moves, 1, 8));
    u16(c, "deform_width", &h->deform_width, only_if(moves, 1, TED4_MAX_WIDTH));
    u8(c, "temporal_mask", &h->temporal_mask, moves ? between(0, 1) : only_if(0, 0, 1));
    u8(c, "offset_mask", &h->offset_mask, between(0, 1));
    u8(c, "activation", &h->activation, between(0, 1));
}

static void walk_heads(ted4_coder *c, ted4_header *h)
{
    u8(c, "view", &h->view, between(0, TED4_VIEW_FULL));
    u8(c, "head_layers", &h->head_layers, between(0, 4));
    u16(c, "head_width", &h->head_width, only_if(h->head_layers > 0, 1, TED4_MAX_WIDTH));
    u8(c, "scale_domain", &h->scale_domain, between(0, TED4_SCALE_LINEAR));
}

static void walk_prior(ted4_coder *c, ted4_header *h)
{
    int inr;
    unsigned sum = 0;
    size_t at = 0;

    u8(c, "prior", &h->prior, between(0, TED4_PRIOR_FACTORISED));
    inr = h->prior == TED4_PRIOR_INR;
    u8(c, "pe_octaves", &h->pe_octaves, only_if(inr, 0, 16));
    u8(c, "hyper_layers", &h->hyper_layers, only_if(inr, 0, 4));
    u16(c, "hyper_width", &h->hyper_width, only_if(h->hyper_layers > 0, 1, TED4_MAX_WIDTH));
    u8(c, "n_slices", &h->n_slices, between(1, TED4_MAX_SLICES));
    if (c->error.code != TED4_OK)
        return;
    for (unsigned i = 0; i < h->n_slices; i++) {
        at = c->pos;
        h->slice[i] = (uint8_t)element(c, "slice", i, 1, h->slice[i], between(1, TED4_MAX_FEATURE));
        sum += h->slice[i];
    }
    ted4_require(c, sum == h->feature_dim, TED4_E_HDR_COMBINATION, at);
    u16(c, "ar_width", &h->ar_width, only_if(h->n_slices > 1, 1, TED4_MAX_WIDTH));
    u8(c, "context_bits", &h->context_bits, between(0, 12));
}

static void walk_world(ted4_coder *c, ted4_header *h, const ted4_limits *l)
{
    /* Patterns of positive binary32 values sort like the values; these are 2^-20 and 2^10. */
    const range steps = between(0x35800000, 0x44800000);
    const range rate = between(1, (1 << 24) - 1);
    size_t at;

    for (int t = 0; t < TED4_TYPES; t++)
        h->step[t] = ted4_bits_float(element(c, "step", t, 4, ted4_float_bits(h->step[t]), steps));
    levelled(c, "frames", &h->frames, between(1, UINT32_MAX), l->frames);
    u32(c, "rate_num", &h->rate_num, rate);
    u32(c, "rate_den", &h->rate_den, rate);
    for (int i = 0; i < 3; i++) {
        at = c->pos;
        h->origin[i] = ted4_bits_float(ted4_code(c, "origin", i, 4, ted4_float_bits(h->origin[i])));
        ted4_require(c, ted4_float_legal(ted4_float_bits(h->origin[i])), TED4_E_HDR_RANGE, at);
    }
    at = c->pos;
    h->exponent = (int8_t)ted4_code(c, "exponent", 0, 1, (uint8_t)h->exponent);
    ted4_require(c, h->exponent >= -30 && h->exponent <= 30, TED4_E_HDR_RANGE, at);
    for (int i = 0; i < 3; i++)
        h->background[i] = (uint8_t)ted4_code(c, "background", i, 1, h->background[i]);
}

/* spec 6.1 */
void ted4_walk_header(ted4_coder *c, ted4_header *h, ted4_shape *shape, unsigned level,
                      uint64_t file_bytes)
{
    const ted4_limits *l = ted4_limits_of(level);
    uint8_t zero = 0;
    size_t at;

    walk_size(c, h, l);
    walk_motion(c, h, l);
    walk_heads(c, h);
    walk_prior(c, h);
    walk_world(c, h, l);
    at = c->pos;
    u8(c, "reserved", &zero, between(0, 0));
    if (c->error.code != TED4_OK)
        return;
    ted4_shape_make(shape, h);
    ted4_require(c, file_bytes == UINT64_MAX || ted4_limits_hold(l, h, shape, file_bytes),
                 TED4_E_LVL_EXCEEDED, at);
}
