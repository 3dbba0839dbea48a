/* unit_sites.c - the places of the sites of unit_stats.h in the networks: their widths, and the
 * weights that read them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "unit_stats.h"

#include <stdlib.h>
#include <string.h>

static int head_sees(const ted4_header *h, int net)
{
    return h->view == TED4_VIEW_FULL || (h->view == TED4_VIEW_COLOUR && net == TED4_NET_COLOUR);
}

static int hidden_width(const ted4_net_shape *s, int layer)
{
    return layer > 0 && layer < s->n_layers ? s->dim[layer] : 0;
}

int ted4_site_width(const ted4_layout *l, ted4_site site)
{
    const ted4_header *h = &l->head;
    const int banked = h->motion == TED4_MOTION_BANK || h->motion == TED4_MOTION_CONCAT;

    switch (site.kind) {
    case TED4_SITE_FEATURE: return h->feature_dim;
    case TED4_SITE_PHI: return banked ? h->phi_dim : 0;
    case TED4_SITE_BANK: return h->motion == TED4_MOTION_BANK ? h->bank_dim : 0;
    case TED4_SITE_INPUT: return head_sees(h, site.net) ? h->feature_dim + 3 : 0;
    case TED4_SITE_HIDDEN:
        return site.net == TED4_NET_DEFORM && !banked
                   ? 0
                   : hidden_width(&l->shape.netr[site.net], site.layer);
    case TED4_SITE_POSITION: return l->shape.hyper.dim[0];
    case TED4_SITE_HYPER: return hidden_width(&l->shape.hyper, site.layer);
    case TED4_SITE_SLICE:
        return site.layer < h->n_slices ? hidden_width(&l->shape.slice[site.layer], 1) : 0;
    }
    return 0;
}

/* The rows of weights gathered so far. */
typedef struct {
    float *rows;
    int width, count;
} reader_rows;

/* Gathers the first width columns of a layer of a network. */
static int gather(reader_rows *r, const float *blob, const ted4_net_shape *s, int layer)
{
    const float *w = blob + s->first;

    for (int i = 0; i < layer; i++)
        w += ted4_layer_size(s, (unsigned)i);

    const size_t in = s->dim[layer], out = s->dim[layer + 1];
    const size_t width = (size_t)r->width;
    float *const more = realloc(r->rows, ((size_t)r->count + out) * width * sizeof *more);

    if (more == NULL)
        return -1;
    r->rows = more;
    for (size_t o = 0; o < out; o++)
        memcpy(more + ((size_t)r->count + o) * width, w + o * in, width * sizeof *more);
    r->count += (int)out;
    return 0;
}

static int gather_heads(reader_rows *r, const float *netr, const ted4_shape *s)
{
    return gather(r, netr, &s->netr[TED4_NET_OPACITY], 0) != 0 ||
           gather(r, netr, &s->netr[TED4_NET_COVARIANCE], 0) != 0 ||
           gather(r, netr, &s->netr[TED4_NET_COLOUR], 0) != 0;
}

int ted4_site_readers(const ted4_trainer *t, ted4_site site, float **rows)
{
    const ted4_layout *l = &t->layout;
    const ted4_shape *s = &l->shape;
    const float *netr = t->net.value + l->netr, *nete = t->net.value + l->nete;
    const int concat = l->head.motion == TED4_MOTION_CONCAT;
    reader_rows r = { NULL, ted4_site_width(l, site), 0 };
    int bad = 0;

    switch (site.kind) {
    case TED4_SITE_FEATURE: bad = gather_heads(&r, netr, s); break;
    case TED4_SITE_PHI:
        bad = gather(&r, netr, &s->netr[concat ? TED4_NET_DEFORM : TED4_NET_PROJECT], 0);
        break;
    case TED4_SITE_BANK: bad = gather(&r, netr, &s->netr[TED4_NET_DEFORM], 0); break;
    case TED4_SITE_INPUT: bad = gather(&r, netr, &s->netr[site.net], 0); break;
    case TED4_SITE_HIDDEN: bad = gather(&r, netr, &s->netr[site.net], site.layer); break;
    case TED4_SITE_POSITION: bad = gather(&r, nete, &s->hyper, 0); break;
    case TED4_SITE_HYPER: bad = gather(&r, nete, &s->hyper, site.layer); break;
    case TED4_SITE_SLICE: bad = gather(&r, nete, &s->slice[site.layer], 1); break;
    }
    if (bad)
        free(r.rows);
    *rows = bad ? NULL : r.rows;
    return bad ? -1 : r.count;
}
