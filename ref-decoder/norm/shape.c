/* shape.c - spec 6.2, 7, 9.1: derives from a header the dimensions of attributes and networks, and
 * the numbers of tiles and substreams.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/syntax.h"

#include <string.h>

/* Describes a network with in inputs, hidden layers of equal width, and out outputs. *values and
 * *units, the positions in the blob, are advanced past it. */
static void chain(ted4_net_shape *n, unsigned in, unsigned hidden, unsigned width, unsigned out,
                  size_t *values, size_t *units)
{
    n->n_layers = (uint8_t)(hidden + 1);
    n->first = *values;
    n->first_unit = *units;
    n->dim[0] = (uint16_t)in;
    for (unsigned i = 1; i <= hidden; i++)
        n->dim[i] = (uint16_t)width;
    n->dim[hidden + 1] = (uint16_t)out;
    for (unsigned i = 0; i <= hidden; i++) {
        *values += ted4_layer_size(n, i);
        *units += n->dim[i + 1];
    }
}

static void shape_types(ted4_shape *s, const ted4_header *h)
{
    unsigned at = 0;

    s->dim[TED4_FEATURE] = h->feature_dim;
    s->dim[TED4_SCALING] = 6;
    s->dim[TED4_OFFSET] = 3u * h->n_offsets;
    s->dim[TED4_PHI] = h->phi_dim;
    s->dim[TED4_TAU] = h->activation ? 4 : 0;
    for (int t = 0; t < TED4_TYPES; t++) {
        s->first_output[t] = at;
        at += 2 * s->dim[t];
        s->n_types += s->dim[t] > 0;
    }
    s->first_step_output = at;
    s->n_outputs = at + s->n_types;
    s->n_tiles = h->n_anchors / h->tile_size + (h->n_anchors % h->tile_size != 0);
    s->n_substreams = h->n_slices + s->n_types - 1u + (h->temporal_mask || h->offset_mask);
}

static void shape_tier_e(ted4_shape *s, const ted4_header *h)
{
    unsigned known = 0;

    chain(&s->hyper, h->prior == TED4_PRIOR_INR ? 3 + 6u * h->pe_octaves : 0, h->hyper_layers,
          h->hyper_width, s->n_outputs, &s->n_nete, &s->n_units);
    for (unsigned m = 1; m < h->n_slices; m++) {
        known += h->slice[m - 1];
        chain(&s->slice[m], known, 1, h->ar_width, 2u * h->slice[m], &s->n_nete, &s->n_units);
    }
}

static void shape_tier_r(ted4_shape *s, const ted4_header *h)
{
    const unsigned f = h->feature_dim, k = h->n_offsets;
    const unsigned seen = f + (h->view == TED4_VIEW_FULL ? 3 : 0);
    const unsigned colour = f + (h->view != TED4_VIEW_NONE ? 3 : 0);
    const unsigned deform = h->motion == TED4_MOTION_INR      ? 84
                            : h->motion == TED4_MOTION_CONCAT ? (unsigned)h->phi_dim + h->bank_dim
                                                              : h->bank_dim;

    if (h->motion == TED4_MOTION_BANK)
        chain(&s->netr[TED4_NET_PROJECT], h->phi_dim, 0, 0, h->bank_dim, &s->n_netr, &s->n_units_r);
    if (h->motion != TED4_MOTION_NONE)
        chain(&s->netr[TED4_NET_DEFORM], deform, h->deform_layers, h->deform_width, 3 + f,
              &s->n_netr, &s->n_units_r);
    chain(&s->netr[TED4_NET_OPACITY], seen, h->head_layers, h->head_width, k, &s->n_netr,
          &s->n_units_r);
    chain(&s->netr[TED4_NET_COVARIANCE], seen, h->head_layers, h->head_width, 7 * k, &s->n_netr,
          &s->n_units_r);
    chain(&s->netr[TED4_NET_COLOUR], colour, h->head_layers, h->head_width, 3 * k, &s->n_netr,
          &s->n_units_r);
    /* The biases of a layer are one more unit. */
    for (int i = 0; i < TED4_NETS_R; i++)
        s->n_units_r += s->netr[i].n_layers;
    s->n_bank = h->phi_dim > 0 ? (uint64_t)h->bank_rows * h->bank_dim : 0;
}

void ted4_shape_make(ted4_shape *s, const ted4_header *h)
{
    memset(s, 0, sizeof *s);
    shape_types(s, h);
    shape_tier_e(s, h);
    shape_tier_r(s, h);
}
