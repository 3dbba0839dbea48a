/* memory_bound.c - see memory_bound.h. Letters are those of spec 13.2.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "memory_bound.h"

static uint64_t larger(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* Returns C. */
static uint64_t components(const ted4_header *h)
{
    return h->feature_dim + 6u + 3u * h->n_offsets + h->phi_dim + (h->activation ? 4u : 0u);
}

/* Returns P: two outputs a component, and one a type. */
static uint64_t outputs(const ted4_header *h)
{
    return 2 * components(h) + 3u + (h->phi_dim > 0 ? 1u : 0u) + (h->activation ? 1u : 0u);
}

/* A byte of POSN pays for 76 bytes, one of a zlib stream for 4128 (1032 values for 4 bytes, 16
 * bytes each). */
uint64_t conf_memory_paid(uint64_t file_bytes)
{
    return ((uint64_t)1 << 20) + 4128 * file_bytes;
}

uint64_t conf_memory_decode(const ted4_header *h, uint64_t file_bytes, uint64_t n_values,
                            uint64_t n_tiles)
{
    const uint64_t n = h->n_anchors, tile = h->tile_size;
    const uint64_t n_t = ((tile < n ? tile : n) + 63) / 64 * 64;

    return ((uint64_t)1 << 20) + file_bytes + 16 * n_values + n * (2 * components(h) + 16) +
           n_tiles * (n_t * (4 * outputs(h) + 2u * h->feature_dim + 11) + ((uint64_t)1 << 17));
}

uint64_t conf_memory_query(const ted4_header *h, uint64_t n_values, uint64_t n_records)
{
    const uint64_t n = h->n_anchors, k = h->n_offsets, f = h->feature_dim;
    const uint64_t d_m = h->motion == TED4_MOTION_INR ? 63 : h->phi_dim;
    const uint64_t w = larger(1, larger(h->deform_width, h->head_width));
    const uint64_t i_d = h->motion == TED4_MOTION_NONE     ? 1
                         : h->motion == TED4_MOTION_INR    ? 84
                         : h->motion == TED4_MOTION_CONCAT ? h->bank_dim + d_m
                                                           : h->bank_dim;
    const uint64_t a = 2 * (f + 3) + 4 + i_d + 2 * w + larger(7 * k, f + 3) + 9 * k;

    return ((uint64_t)1 << 20) + 4 * n_values + (n + 64) * (4 * (f + 3 * k + 10 + d_m) + 10) +
           64 * n_records + 8192 * a;
}
