/* limits.c - spec 13: the table of levels, and the quantities that levels bound.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/limits.h"

static const ted4_limits table[] = {
    { 1, 1 << 14, 10, 64, 1 << 18, 1 << 16, 1 << 22, 256 },
    { 2, 1 << 16, 10, 600, 1 << 20, 1 << 16, 1 << 24, 256 },
    { 3, 1 << 18, 16, 3600, 1 << 22, 1 << 17, 1 << 26, 512 },
    { 4, 1 << 20, 16, 36000, 1 << 24, 1 << 18, 1 << 28, 512 },
    { TED4_LEVEL_UNBOUNDED, UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX,
      UINT64_MAX },
};

const ted4_limits *ted4_limits_of(unsigned level)
{
    for (unsigned i = 0; i < sizeof table / sizeof *table; i++)
        if (table[i].level == level)
            return &table[i];
    return NULL;
}

uint64_t ted4_count_symbols(const ted4_header *h, const ted4_shape *s)
{
    uint64_t per_anchor = 0;

    for (int t = 0; t < TED4_TYPES; t++)
        per_anchor += s->dim[t];
    return h->n_anchors * per_anchor;
}

static uint64_t products(const ted4_net_shape *n)
{
    uint64_t sum = 0;

    for (unsigned i = 0; i < n->n_layers; i++)
        sum += (uint64_t)n->dim[i] * n->dim[i + 1];
    return sum;
}

uint64_t ted4_count_products(const ted4_header *h, const ted4_shape *s)
{
    uint64_t sum = products(&s->hyper);

    for (unsigned m = 1; m < h->n_slices; m++)
        sum += products(&s->slice[m]);
    return sum;
}

uint64_t ted4_count_work(const ted4_header *h, const ted4_shape *s, uint64_t file_bytes)
{
    const uint64_t values = s->n_nete + s->n_netr + s->n_bank;
    const uint64_t each = ted4_count_products(h, s) + s->n_outputs + h->n_offsets + 1u;

    return file_bytes + 4 * values + h->n_anchors * each + ted4_count_symbols(h, s);
}

uint64_t ted4_count_query_work(const ted4_header *h, const ted4_shape *s, uint64_t n_records)
{
    uint64_t each = 0;

    for (int i = 0; i < TED4_NETS_R; i++)
        each += products(&s->netr[i]);
    return h->n_anchors * each + 20 * n_records;
}

int ted4_limits_hold(const ted4_limits *l, const ted4_header *h, const ted4_shape *s,
                     uint64_t file_bytes)
{
    const uint64_t symbols = ted4_count_symbols(h, s);

    return s->n_nete + s->n_netr + s->n_bank <= l->values &&
           ted4_count_products(h, s) <= l->products && file_bytes <= l->file_bytes &&
           (symbols + file_bytes - 1) / file_bytes <= l->symbols_per_byte;
}

unsigned ted4_level_lowest(const ted4_header *h, const ted4_shape *s, uint64_t file_bytes)
{
    const ted4_limits *l = table;

    while (l->level != TED4_LEVEL_UNBOUNDED &&
           (h->n_anchors > l->n_anchors || h->n_offsets > l->n_offsets || h->frames > l->frames ||
            h->bank_rows > l->frames || !ted4_limits_hold(l, h, s, file_bytes)))
        l++;
    return l->level;
}
