/* annex_h.h - the text of annex H. Ranges of elements of HEAD are those of the table of 6.1; other
 * numbers are constants of the decoder, or follow from the smallest file and from the largest
 * header.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANNEX_H_H
#define TED4_ANNEX_H_H

#include <inttypes.h>
#include <stdio.h>
#include "spec_head.h"
#include "annex_b_compact.h"
#include "norm/adaptive.h"
#include "norm/coded_weights.h"
#include "norm/coder.h"
#include "norm/gaussian.h"
#include "norm/octree.h"
#include "norm/prior.h"
#include "norm/rans.h"

/* A row of 6.1. */
typedef struct {
    const char *name;
    int64_t low, high;
    int conditional, levelled;
} annex_h_range;

typedef struct {
    char text[24];
} annex_h_number;

/* Large powers of two, and what is one below them, as such. */
static inline annex_h_number annex_h_text(int64_t x)
{
    annex_h_number n;
    int bits = 20;

    while (bits < 62 && (int64_t)1 << bits < x)
        bits++;
    if (x == (int64_t)1 << bits)
        snprintf(n.text, sizeof n.text, "2^%d", bits);
    else if (x == ((int64_t)1 << bits) - 1)
        snprintf(n.text, sizeof n.text, "2^%d - 1", bits);
    else
        snprintf(n.text, sizeof n.text, "%" PRId64, x);
    return n;
}

static inline const annex_h_range *annex_h_find(const char *element)
{
    static const annex_h_range range[] = {
#define ELEMENT(name, count, width, is_signed, low, high, has_condition, condition, bound) \
    { #name, low, high, has_condition, BOUND_##bound != BOUND_NONE },
#define REAL(name, count, bounded)
#include "spec/head.inc"
#undef ELEMENT
#undef REAL
    };
    size_t i = 0;

    while (strcmp(range[i].name, element) != 0)
        i++;
    return &range[i];
}

/* An element's own row. It is 0 where its condition does not hold. */
static inline void annex_h_row(FILE *out, const char *quantity, const char *element)
{
    const annex_h_range *const r = annex_h_find(element);

    fprintf(out, "| %s | %" PRId64 " | %s%s | 6.1 |\n", quantity, r->conditional ? 0 : r->low,
            annex_h_text(r->high).text, r->levelled ? "; level" : "");
}

/* Every element that makes something larger at the top of its range. */
static inline void annex_h_largest(ted4_header *h, ted4_shape *s)
{
    memset(h, 0, sizeof *h);
    h->n_anchors = h->tile_size = (uint32_t)annex_h_find("tile_size")->high;
    h->n_offsets = (uint8_t)annex_h_find("n_offsets")->high;
    h->feature_dim = (uint8_t)annex_h_find("feature_dim")->high;
    h->motion = TED4_MOTION_CONCAT;
    h->phi_dim = (uint8_t)annex_h_find("phi_dim")->high;
    h->bank_dim = (uint16_t)annex_h_find("bank_dim")->high;
    h->deform_layers = (uint8_t)annex_h_find("deform_layers")->high;
    h->temporal_mask = h->offset_mask = h->activation = 1;
    h->head_layers = (uint8_t)annex_h_find("head_layers")->high;
    h->pe_octaves = (uint8_t)annex_h_find("pe_octaves")->high;
    h->hyper_layers = (uint8_t)annex_h_find("hyper_layers")->high;
    h->n_slices = (uint8_t)annex_h_find("n_slices")->high;
    h->hyper_width = (uint16_t)annex_h_find("hyper_width")->high;
    ted4_shape_make(s, h);
}

static inline void annex_h_file(FILE *out)
{
    size_t size, n_compact, n_chunks = 0, at = TED4_FILE_HEADER_SIZE;
    uint8_t *data = annex_b_encode(annex_b_smallest_compact(), &n_compact);

    free(data);
    data = annex_b_encode(annex_b_smallest(), &size);
    for (; at < size; n_chunks++)
        at += TED4_FRAME_HEAD_SIZE + load32(data + at + 8) + TED4_FRAME_HASH_SIZE;
    free(data);
    fprintf(out,
            "| file bytes | %zu (B.1); Compact: %zu (B.3) | level; 2^64 - 1 | R-LVL-001 |\n"
            "| payload bytes of a chunk | 0 | %s | 5.2 |\n",
            size, n_compact, annex_h_text(UINT32_MAX).text);
    fprintf(out, "| chunks | %zu, BANK not among them | as many as fit | R-CON-003 |\n", n_chunks);
    fprintf(out, "| TILE chunks | 1 | ceil(N / %" PRId64 ") | R-CON-003 |\n",
            annex_h_find("tile_size")->low);
}

static inline void annex_h_scene(FILE *out)
{
    ted4_header h;
    ted4_shape s;

    annex_h_largest(&h, &s);
    fprintf(out,
            "| anchors N | %" PRId64 " | %" PRIu32
            " (6 N bytes in one payload); Compact: %s; level | 6.1, 8 |\n",
            annex_h_find("n_anchors")->low, UINT32_MAX / 6,
            annex_h_text(annex_h_find("n_anchors")->high).text);
    fprintf(out, "| anchors per tile | 1 | %" PRIu32 " | 6.1 |\n", h.tile_size);
    annex_h_row(out, "offsets K", "n_offsets");
    fprintf(out, "| Gaussians G | 0 | N K | 11 |\n");
    annex_h_row(out, "feature F", "feature_dim");
    annex_h_row(out, "slices", "n_slices");
    annex_h_row(out, "phi d", "phi_dim");
    fprintf(out, "| components C | %u | %u + %u + %u + %u + %u = %u | 6.2 |\n",
            1 + s.dim[TED4_SCALING] + s.dim[TED4_OFFSET] / h.n_offsets, s.dim[TED4_FEATURE],
            s.dim[TED4_SCALING], s.dim[TED4_OFFSET], s.dim[TED4_PHI], s.dim[TED4_TAU],
            s.first_step_output / 2);
    annex_h_row(out, "bank rows M", "bank_rows");
    annex_h_row(out, "bank width D", "bank_dim");
}

static inline void annex_h_networks(FILE *out)
{
    ted4_header h;
    ted4_shape s;

    annex_h_largest(&h, &s);
    const unsigned hyper = s.hyper.n_layers, heads = s.netr[TED4_NET_COLOUR].n_layers;

    fprintf(out, "| values of a blob | 1 | (2^32 - 1) 512 (bank); level | 7.2, 13.1 |\n");
    fprintf(out,
            "| layers of a network | 1 | %u (F_deform), %u (heads), %u (hyperprior), %u (slices), "
            "1 (F_project) | 6.1 |\n",
            s.netr[TED4_NET_DEFORM].n_layers, heads, hyper, s.slice[1].n_layers);
    fprintf(
        out,
        "| width of a layer | 1 | %u inputs (concat), %u hidden, %u outputs (hyperprior) | 7 |\n",
        s.netr[TED4_NET_DEFORM].dim[0], s.hyper.dim[1], s.n_outputs);
    fprintf(out, "| inputs of the hyperprior | 0 | %u | 7.3 |\n", s.hyper.dim[0]);
    fprintf(out,
            "| shift s | 0 | %d | R-NET-003 |\n| integer weight | -32767 | 32767 | R-NET-004 |\n",
            TED4_MAX_SHIFT);
    fprintf(out, "| exponent E of a unit, Compact | -128 | 127 | 7.6 |\n");
    fprintf(out, "| significant bits of a coded integer, Compact | 0 | %d | R-NET-012 |\n",
            TED4_WEIGHT_BITS);
    /* As many bits 1 as a binary32 has, then bits 0. */
    fprintf(out,
            "| magnitude of a coded integer, Compact | 0 | 2^%d - 2^%d (%s can be coded) | 9.6, "
            "R-NET-012 |\n",
            31, 31 - TED4_WEIGHT_BITS, annex_h_text(INT32_MAX).text);
    fprintf(out, "| length of a coded integer, Compact | 0 | 31 | R-ENT-018 |\n");
    fprintf(out, "| accumulator | -(%s) | %s | R-NET-006 |\n", annex_h_text(INT32_MAX).text,
            annex_h_text(INT32_MAX).text);
    fprintf(out, "| outputs of Tier E networks | -(%s) | %s | 7.3 |\n",
            annex_h_text(TED4_OUTPUT_MAX).text, annex_h_text(TED4_OUTPUT_MAX).text);
}

static inline void annex_h_symbols(FILE *out)
{
    ted4_header h;
    ted4_shape s;

    annex_h_largest(&h, &s);
    fprintf(out, "| \\|X\\| | 0 | %s | 8 |\n", annex_h_text(q24(0x3c00)).text);
    fprintf(out, "| symbols of a substream of TILE | 0 | %" PRIu32 " x %u | 9.2 |\n", h.tile_size,
            h.feature_dim);
    fprintf(out, "| bits g of a place, Compact | 6 | 12, or %d | R-POS-004 |\n", TED4_OCTREE_DEPTH);
    fprintf(out,
            "| adaptive bits of a substream, Compact | 7 g (POSN), 5 (blobs) | 8 g (N + 1) (POSN), "
            "36 n (blobs) | 9.5, 9.6 |\n"
            "| bytes of a substream of adaptive bits, Compact | 4, and ceil(n / 8) of n anchors or "
            "values | the rest of the payload | R-ENT-016 |\n");
    fprintf(out,
            "| adaptive probability p | %d | 2^16 - %d | 9.5 |\n| bits seen | 0 | %d | 9.5 |\n",
            TED4_ADAPTIVE_LEAST, TED4_ADAPTIVE_LEAST, TED4_ADAPTIVE_MEMORY);
    fprintf(out, "| lanes | 1 | %d | R-ENT-009 |\n", TED4_MAX_LANES);
    /* The least has one slice, scaling and offsets. */
    fprintf(out, "| substreams S | 3 | %u | R-ENT-008 |\n", s.n_substreams);
    fprintf(out,
            "| probability of a mask bit | 1 | %d | R-ENT-002 |\n| sigma index | 0 | %d | 10.1 |\n",
            (1 << TED4_SLOT_BITS) - 1, TED4_N_SIGMA - 1);
    fprintf(out, "| alphabet of a symbol | %u | %u | 9.4 |\n", ted4_gauss_size(0),
            ted4_gauss_size(TED4_N_SIGMA - 1));
    fprintf(
        out,
        "| bits 1 of an escape | 0 | %d | R-ENT-006 |\n| symbol k | -32767 | 32767 | R-ENT-007 |\n",
        TED4_ESCAPE_BITS);
    annex_h_row(out, "context_bits", "context_bits");
}

static inline void annex_h_rest(FILE *out)
{
    /* 6.1 has no other bounds of an f32 (head.awk). */
    fprintf(out, "| base step Q0 | 2^-20 | 2^10 | 6.1 |\n");
    annex_h_row(out, "exponent e", "exponent");
    annex_h_row(out, "frames", "frames");
    annex_h_row(out, "rate_num, rate_den", "rate_num");
    fprintf(out, "| den of a query | 1 | 2^24 - 1 | R-REC-002 |\n"
                 "| memory of a decoder | | M_E, M_R | R-LVL-004 |\n| work of a decoder | | a "
                 "constant times W_E, W_R | R-LVL-006 |\n");
}

static inline void annex_h(FILE *out)
{
    fprintf(out, "# Annex H (normative): limits in one place\n\n"
                 "This annex lists every number that is bounded, and where it is bounded.\n"
                 "\"Level\" means that the level bounds the number further (13.1). The annex is\n"
                 "made by `make spec-annexes`.\n\n"
                 "| quantity | least | most | rule |\n|---|---|---|---|\n");
    annex_h_file(out);
    annex_h_scene(out);
    annex_h_networks(out);
    annex_h_symbols(out);
    annex_h_rest(out);
    fprintf(out, "\n"
                 "The limits that a decoder may set for itself are those on memory\n"
                 "(`limit.memory`) and on work (`limit.work`); it has to handle anything\n"
                 "else up to its level (R-DEC-007).\n");
}

#endif
