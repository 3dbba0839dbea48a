/* annex_c.h - the text of annex C: what the bounds of 13.1 come to, by the formulas of 13.3 as the
 * text prints them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANNEX_C_H
#define TED4_ANNEX_C_H

#include <inttypes.h>
#include <stdio.h>
#include "spec_model.h"

/* Bounds of one level, in the order of the table of 13.1. */
typedef struct {
    int number;
    uint64_t n_anchors, n_offsets, frames, values, products, file_bytes, symbols;
} annex_c_level;

/* The header for which formulas give most; but for M_R, which may be larger with motion inr. */
static inline struct header annex_c_worst(const annex_c_level *l)
{
    struct header h;

    memset(&h, 0, sizeof h);
    h.n_anchors = (int64_t)l->n_anchors;
    h.tile_size = 65536;
    h.n_offsets = (int64_t)l->n_offsets;
    h.feature_dim = 128;
    h.motion = 2;
    h.phi_dim = 32;
    h.bank_dim = h.deform_width = h.head_width = 512;
    h.activation = 1;
    h.n_slices = 1;
    return h;
}

/* Tiles at a time of the reference decoder, for tiles of 65536 anchors. */
static inline uint64_t annex_c_tiles(const annex_c_level *l, const struct header *h)
{
    const uint64_t one = memory_e(h, 0, 0, 1) - memory_e(h, 0, 0, 0),
                   tiles = (l->n_anchors + 65535) / 65536;
    uint64_t j = (1u << 28) / one;

    j = j < 1 ? 1 : j;
    return j < tiles ? j : tiles;
}

/* M_R at most: inr has the larger d_m and I_d (13.3), unless bank and feature are as wide. */
static inline uint64_t annex_c_memory_r(const annex_c_level *l)
{
    struct header concat = annex_c_worst(l), inr = concat;
    uint64_t with_concat, with_inr;

    inr.motion = 3;
    with_concat = memory_r(&concat, l->values, l->n_anchors * l->n_offsets);
    with_inr = memory_r(&inr, l->values, l->n_anchors * l->n_offsets);
    return larger(with_concat, with_inr);
}

static inline void annex_c_row(FILE *out, const annex_c_level *l)
{
    const struct header h = annex_c_worst(l);
    const uint64_t n = l->n_anchors, c = components(&h), mib = 1 << 20,
                   work = work_e(&h, l->file_bytes, l->values, l->products);

    fprintf(out,
            "| %d | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " | %.1f | %.1f | %.1f | %.1f | %.1f |\n",
            l->number, n, n * l->n_offsets, c, (double)l->values * 4 / (double)mib,
            (double)memory_e(&h, l->file_bytes, l->values, 1) / (double)mib,
            (double)memory_e(&h, l->file_bytes, l->values, annex_c_tiles(l, &h)) / (double)mib,
            (double)annex_c_memory_r(l) / (double)mib, (double)work / 1e9);
}

/* The numbers of the example in C.1. */
static inline void annex_c_example(FILE *out)
{
    struct header h = { .n_anchors = 40000,
                        .tile_size = 4096,
                        .n_offsets = 10,
                        .feature_dim = 50,
                        .motion = 1,
                        .phi_dim = 8,
                        .bank_rows = 150,
                        .bank_dim = 128,
                        .deform_layers = 2,
                        .deform_width = 128,
                        .temporal_mask = 1,
                        .offset_mask = 1,
                        .activation = 1,
                        .view = 1,
                        .head_layers = 1,
                        .head_width = 50,
                        .pe_octaves = 10,
                        .hyper_layers = 2,
                        .hyper_width = 100,
                        .n_slices = 4,
                        .slice = { 5, 10, 15, 20 },
                        .ar_width = 100 };
    struct net net[16], net_r[NETS_R];
    size_t units;
    const uint64_t v = nets_e(&h, net, &units) + nets_r(&h, net_r) + 150 * 128;
    uint64_t products = 0;

    fprintf(out,
            "## C.1 An example\n\n"
            "The example has the shape of the method's paper, with 40000 anchors and 300\n"
            "frames: F = 50 in slices of 5, 10, 15, 20; K = 10; d = 8; a bank of 150 rows\n"
            "of 128 numbers; a hyperprior 63-100-100-201; slice networks that are 100 wide and\n"
            "two layers of F_deform that are 128 wide; heads with one hidden layer of 50,\n"
            "view = 1; all masks, activation; 4096 anchors per tile; and a file of 2 MB.\n\n");
    for (int i = 0; i < h.n_slices; i++)
        products += spec_products(&net[i]);
    fprintf(out,
            "| quantity | value |\n|---|---|\n| C, P | %" PRIu64 ", %d |\n| V | %" PRIu64
            " |\n| A_E | %" PRIu64 " |\n| M_E, J = 1 | %.1f MiB |\n"
            "| M_R, all offsets kept | %.1f MiB |\n| lowest level | 2 |\n",
            components(&h), n_outputs(&h), v, products,
            (double)memory_e(&h, 2000000, v, 1) / 1048576,
            (double)memory_r(&h, v, 400000) / 1048576);
}

static inline void annex_c(FILE *out)
{
    static const annex_c_level level[] = {
#define LEVEL(...) { __VA_ARGS__ },
#include "spec/levels.inc"
#undef LEVEL
    };

    fprintf(out,
            "# Annex C (informative): levels in numbers\n\n"
            "The table shows what a decoder has to handle at each level: the largest\n"
            "values that the formulas of 13.3 and 13.4 give within the bounds of 13.1, for\n"
            "any header. Hardly any file comes near all of them at once. The annex is made\n"
            "by `make spec-annexes`.\n\n"
            "| level | anchors N | records G | components C | networks and bank, MiB | M_E with J "
            "= 1, MiB | M_E of the reference decoder, MiB | M_R, MiB | W_E, 10^9 steps |\n"
            "|---|---|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof level / sizeof *level; i++)
        if (level[i].n_anchors != UINT64_MAX)
            annex_c_row(out, &level[i]);
    fprintf(out, "\n"
                 "Level 31 has no bounds; the formulas hold for it too.\n\n");
    annex_c_example(out);
}

#endif
