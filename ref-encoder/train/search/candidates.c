/* candidates.c - the ways to make the model smaller: see candidates.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "candidates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sensitivity.h"
#include "train/model/header_from_options.h"
#include "train/resize/unit_stats.h"
#include "math/elementary.h"
#include "train/resize/resize.h"

static const char *const names[TED4_CANDIDATES] = {
    "motion",
    "activation",
    "bits of the heads' weights",
    "bits of the motion networks' weights",
    "bits of the bank",
    "bits of the prior's weights",
    "width of the hyperprior",
    "width of F_deform",
    "width of the slice networks",
    "width of the heads",
    "width of the bank",
    "feature",
    "slices of the feature",
    "octaves of the hyperprior",
    "view direction",
    "rows of the bank",
    "temporal feature",
    "scalings in log2",
    "Gaussians an anchor",
    "Gaussians in all",
};

const char *ted4_candidate_name(ted4_candidate m)
{
    return names[m];
}

int ted4_candidate_now(const ted4_trainer *t, ted4_candidate m)
{
    const ted4_header *h = &t->layout.head;

    switch (m) {
    case TED4_CANDIDATE_MOTION: return h->motion != TED4_MOTION_NONE;
    case TED4_CANDIDATE_ACTIVATION: return h->activation;
    case TED4_CANDIDATE_HEAD_BITS: return t->net.bits[TED4_WEIGHT_GRID_HEADS];
    case TED4_CANDIDATE_MOTION_BITS:
        return h->motion != TED4_MOTION_NONE ? t->net.bits[TED4_WEIGHT_GRID_MOTION] : 0;
    case TED4_CANDIDATE_BANK_BITS: return h->bank_dim > 0 ? t->net.bits[TED4_WEIGHT_GRID_BANK] : 0;
    case TED4_CANDIDATE_PRIOR_BITS: return t->net.bits[TED4_WEIGHT_GRID_PRIOR];
    case TED4_CANDIDATE_HYPER: return h->hyper_layers > 0 ? h->hyper_width : 0;
    case TED4_CANDIDATE_AR: return h->ar_width;
    case TED4_CANDIDATE_SLICES: return h->n_slices;
    case TED4_CANDIDATE_OCTAVES: return h->pe_octaves;
    case TED4_CANDIDATE_OFFSETS: return h->n_offsets;
    case TED4_CANDIDATE_FEATURE: return h->feature_dim;
    case TED4_CANDIDATE_VIEW: return h->view;
    case TED4_CANDIDATE_HEADS: return h->head_layers > 0 ? h->head_width : 0;
    case TED4_CANDIDATE_DEFORM:
        return h->motion == TED4_MOTION_BANK || h->motion == TED4_MOTION_CONCAT ? h->deform_width
                                                                                : 0;
    case TED4_CANDIDATE_BANK: return h->motion == TED4_MOTION_BANK ? h->bank_dim : 0;
    case TED4_CANDIDATE_ROWS: return (int)h->bank_rows;
    case TED4_CANDIDATE_PHI: return h->phi_dim;
    case TED4_CANDIDATE_SCALE: return h->scale_domain == TED4_SCALE_LOG2;
    case TED4_CANDIDATE_ANCHORS:
    case TED4_CANDIDATES: break;
    }
    return 0;
}

/* Returns a width reduced by a quarter, or by half if bold, rounded down to whole vectors
 * (multiple) if possible, or -1 if that would be less than least, or not smaller. */
static int fewer(int now, int multiple, int least, int bold)
{
    int to = bold ? now / 2 : now * 3 / 4;

    if (to > multiple)
        to = to / multiple * multiple;
    else if (now > multiple)
        to = multiple;
    return to >= least && to < now ? to : -1;
}

/* The range in which bits of weights are reduced one or two at a time. Most of the bits that
 * training leaves have no visible effect. */
enum { COARSE = 6, FINE = 12 };

static int coarser(int now, int bold)
{
    if (now > FINE)
        return bold ? COARSE : FINE;
    return now > COARSE ? now - 2 : now > 1 ? now - 1 : -1;
}

int ted4_candidate_next(const ted4_trainer *t, ted4_candidate m, int bold)
{
    const int now = ted4_candidate_now(t, m);

    switch (m) {
    case TED4_CANDIDATE_MOTION:
    case TED4_CANDIDATE_ACTIVATION:
    case TED4_CANDIDATE_SCALE:
    case TED4_CANDIDATE_VIEW: return now - 1;
    case TED4_CANDIDATE_SLICES: return now > 1 ? 1 : -1;
    case TED4_CANDIDATE_OCTAVES: return now > 2 ? now - 2 : now > 0 ? 0 : -1;
    case TED4_CANDIDATE_HYPER:
    case TED4_CANDIDATE_AR:
    case TED4_CANDIDATE_HEADS:
    case TED4_CANDIDATE_DEFORM:
    case TED4_CANDIDATE_BANK: return fewer(now, 4, 4, bold);
    case TED4_CANDIDATE_FEATURE: return fewer(now, 2, 4, bold);
    case TED4_CANDIDATE_HEAD_BITS:
    case TED4_CANDIDATE_MOTION_BITS:
    case TED4_CANDIDATE_BANK_BITS:
    case TED4_CANDIDATE_PRIOR_BITS: return coarser(now, bold);
    case TED4_CANDIDATE_OFFSETS:
    case TED4_CANDIDATE_PHI: return fewer(now, 1, 1, bold);
    case TED4_CANDIDATE_ROWS: return now > 3 ? (now + 1) / 2 : -1;
    case TED4_CANDIDATE_ANCHORS:
    case TED4_CANDIDATES: break;
    }
    return -1;
}

int ted4_candidate_finer(const ted4_trainer *t, ted4_candidate m)
{
    const int now = ted4_candidate_now(t, m),
              full = TED4_WEIGHT_GRID_FULL(m - TED4_CANDIDATE_HEAD_BITS + TED4_WEIGHT_GRID_HEADS);

    if (m < TED4_CANDIDATE_HEAD_BITS || m > TED4_CANDIDATE_PRIOR_BITS || now == 0)
        return -1;
    return now < COARSE ? now + 1 : now < FINE ? now + 2 : now < full ? full : -1;
}

/* ---- making candidates ---- */

/* Plans, in *w, the pruning of a site down to the number of units in to. Units marked in held,
 * which may be NULL, are kept. Returns 0, or -1 with t->message filled. */
static int prune_site(ted4_trainer *t, ted4_site site, int to, const uint8_t *held,
                      ted4_pruned_units *w)
{
    const int width = ted4_site_width(&t->layout, site);
    const size_t side = (size_t)width + 1;
    double *moment = malloc(side * side * sizeof *moment);
    float *rows = NULL;
    const int count = moment != NULL ? ted4_site_readers(t, site, &rows) : -1;
    const int failed = count >= 0 && ted4_site_moment(t, site, moment) != 0;
    int starved = count < 0;

    if (!starved && !failed) {
        const ted4_units u = { width, count, moment, rows, held };

        starved = ted4_prune_units(w, &u, to) != 0;
    }
    free(moment);
    free(rows);
    return starved ? ted4_trainer_fail(t, "no memory to change the model") : failed ? -1 : 0;
}

enum { MOST_PRUNED = TED4_NETS_R * TED4_MAX_LAYERS };

/* A planned resizing, and the pruned units that s points to. */
typedef struct {
    ted4_trainer *t;
    ted4_resize s;
    ted4_pruned_units pruned[MOST_PRUNED];
    int n;
} operation;

static const ted4_pruned_units *prune(operation *o, ted4_site site, int to, const uint8_t *held)
{
    if (prune_site(o->t, site, to, held, &o->pruned[o->n]) != 0)
        return NULL;
    return &o->pruned[o->n++];
}

static int prune_layers(operation *o, int net, int layers, int to)
{
    for (int i = 1; i <= layers; i++)
        if ((o->s.hidden[net][i] = prune(o, (ted4_site) { TED4_SITE_HIDDEN, net, i }, to, NULL)) ==
            NULL)
            return -1;
    return 0;
}

static int prune_heads(operation *o, int to)
{
    const int layers = o->s.head.head_layers;

    o->s.head.head_width = (uint16_t)to;
    return prune_layers(o, TED4_NET_OPACITY, layers, to) != 0 ||
           prune_layers(o, TED4_NET_COVARIANCE, layers, to) != 0 ||
           prune_layers(o, TED4_NET_COLOUR, layers, to) != 0;
}

static int prune_hyper(operation *o, int to)
{
    o->s.head.hyper_width = (uint16_t)to;
    for (int i = 1; i <= o->s.head.hyper_layers; i++)
        if ((o->s.hyper[i] = prune(o, (ted4_site) { TED4_SITE_HYPER, 0, i }, to, NULL)) == NULL)
            return -1;
    return 0;
}

static int prune_slices(operation *o, int to)
{
    o->s.head.ar_width = (uint16_t)to;
    for (int m = 1; m < o->s.head.n_slices; m++)
        if ((o->s.slice[m] = prune(o, (ted4_site) { TED4_SITE_SLICE, 0, m }, to, NULL)) == NULL)
            return -1;
    return 0;
}

static void one_slice(ted4_header *h)
{
    h->n_slices = 1;
    memset(h->slice, 0, sizeof h->slice);
    h->slice[0] = h->feature_dim;
    h->ar_width = 0;
}

/* Adapts the slices to the components of the feature that remain; empty slices are removed. */
static void shrink_slices(ted4_header *h, const ted4_pruned_units *w)
{
    uint8_t size[TED4_MAX_SLICES] = { 0 };
    int m = 0, end = h->slice[0], n = 0;

    for (int k = 0; k < w->to; k++) {
        while (w->keep[k] >= end)
            end += h->slice[++m];
        size[m]++;
    }
    for (int i = 0; i < h->n_slices; i++)
        if (size[i] > 0)
            h->slice[n++] = size[i];
    h->n_slices = (uint8_t)n;
    h->feature_dim = (uint8_t)w->to;
    if (n == 1)
        one_slice(h);
}

static int prune_feature(operation *o, int to)
{
    o->s.feature = prune(o, (ted4_site) { TED4_SITE_FEATURE, 0, 0 }, to, NULL);
    if (o->s.feature == NULL)
        return -1;
    shrink_slices(&o->s.head, o->s.feature);
    return 0;
}

/* Removes the three inputs of the view direction. The feature replaces their mean, and as much of
 * them as it predicts. */
static int prune_view(operation *o, int to)
{
    uint8_t held[TED4_MAX_FEATURE + 3] = { 0 };
    const int F = o->s.head.feature_dim, was = o->s.head.view;

    memset(held, 1, (size_t)F);
    for (int net = TED4_NET_OPACITY; net <= TED4_NET_COLOUR; net++) {
        const int goes = net == TED4_NET_COLOUR ? to == TED4_VIEW_NONE : was == TED4_VIEW_FULL;

        if (goes &&
            (o->s.input[net] = prune(o, (ted4_site) { TED4_SITE_INPUT, net, 0 }, F, held)) == NULL)
            return -1;
    }
    o->s.head.view = (uint8_t)to;
    return 0;
}

/* Removes octaves, the finest first. */
static int prune_octaves(operation *o, int to)
{
    uint8_t held[3 + 6 * 16] = { 0 };
    const int n = 3 + 6 * to;

    memset(held, 1, (size_t)n);
    o->s.position = prune(o, (ted4_site) { TED4_SITE_POSITION, 0, 0 }, n, held);
    o->s.head.pe_octaves = (uint8_t)to;
    return o->s.position == NULL;
}

/* Keeps the offsets whose Gaussians have the highest opacity sensitivity. */
static int fewer_offsets(operation *o, int to)
{
    const size_t K = o->s.head.n_offsets, n = o->t->anchors.n;
    float *of_each = malloc((n * K + 1) * sizeof *of_each);
    double use[TED4_MAX_OFFSETS] = { 0 };
    int kept = 0;

    if (of_each == NULL)
        return ted4_trainer_fail(o->t, "no memory to look at Gaussians");

    const int bad = ted4_opacity_sensitivity(o->t, of_each) != 0;

    for (size_t i = 0; !bad && i < n * K; i++)
        use[i % K] += fmax((double)of_each[i], 0.0);
    free(of_each);
    for (size_t k = 0; !bad && k < K; k++) {
        int better = 0;

        for (size_t i = 0; i < K; i++)
            better += use[i] > use[k] || (!(use[i] < use[k]) && i < k);
        if (better < to)
            o->s.offset[kept++] = (int)k;
    }
    o->s.head.n_offsets = (uint8_t)to;
    return bad;
}

#define LN2 0x1.62e42fefa39efp-1

/* Chooses a linear step that is, on average, as fine as the step in log2 was: d 2^x = 2^x ln 2 dx.
 */
static void make_linear(operation *o)
{
    const ted4_layout *l = &o->t->layout;
    double sum = 0;
    const double n = 6.0 * (double)o->t->anchors.n;

    for (size_t i = 0; i < o->t->anchors.n; i++)
        for (int c = 0; c < 6; c++)
            sum += (double)(*ted4_anchor_value(&o->t->anchors, TED4_ROW_VALUE, i,
                                               l->first[TED4_SCALING] + c) +
                            ted4_math_log2f(*ted4_anchor_value(&o->t->anchors, TED4_ROW_STEP, i,
                                                               TED4_SCALING)));
    o->s.head.scale_domain = TED4_SCALE_LINEAR;
    o->s.head.step[TED4_SCALING] = (float)fmax(LN2 * ted4_math_exp2(sum / n), 1e-5);
}

/* Plans the changes of a candidate, in o->s. Returns 0, or not 0 with t->message filled. */
static int plan(operation *o, ted4_candidate m, int to)
{
    ted4_header *h = &o->s.head;
    const ted4_site bank = { TED4_SITE_BANK, 0, 0 }, phi = { TED4_SITE_PHI, 0, 0 };

    switch (m) {
    case TED4_CANDIDATE_MOTION: ted4_header_without_motion(h); return 0;
    case TED4_CANDIDATE_ACTIVATION: h->activation = 0; return 0;
    case TED4_CANDIDATE_HYPER: return prune_hyper(o, to);
    case TED4_CANDIDATE_AR: return prune_slices(o, to);
    case TED4_CANDIDATE_SLICES: one_slice(h); return 0;
    case TED4_CANDIDATE_OCTAVES: return prune_octaves(o, to);
    case TED4_CANDIDATE_OFFSETS: return fewer_offsets(o, to);
    case TED4_CANDIDATE_FEATURE: return prune_feature(o, to);
    case TED4_CANDIDATE_VIEW: return prune_view(o, to);
    case TED4_CANDIDATE_HEADS: return prune_heads(o, to);
    case TED4_CANDIDATE_DEFORM:
        h->deform_width = (uint16_t)to;
        return prune_layers(o, TED4_NET_DEFORM, h->deform_layers, to);
    case TED4_CANDIDATE_BANK:
        h->bank_dim = (uint16_t)to;
        return (o->s.bank = prune(o, bank, to, NULL)) == NULL;
    case TED4_CANDIDATE_ROWS: h->bank_rows = (uint32_t)to; return 0;
    case TED4_CANDIDATE_PHI:
        h->phi_dim = (uint8_t)to;
        return (o->s.phi = prune(o, phi, to, NULL)) == NULL;
    case TED4_CANDIDATE_SCALE: make_linear(o); return 0;
    case TED4_CANDIDATE_HEAD_BITS:
    case TED4_CANDIDATE_MOTION_BITS:
    case TED4_CANDIDATE_BANK_BITS:
    case TED4_CANDIDATE_PRIOR_BITS:
    case TED4_CANDIDATE_ANCHORS:
    case TED4_CANDIDATES: break;
    }
    return 0;
}

int ted4_candidate_make(ted4_trainer *t, ted4_candidate m, int to)
{
    operation o = { .t = t };
    int bad;

    if (m >= TED4_CANDIDATE_HEAD_BITS && m <= TED4_CANDIDATE_PRIOR_BITS) {
        t->net.bits[m - TED4_CANDIDATE_HEAD_BITS + TED4_WEIGHT_GRID_HEADS] = to;
        return 0;
    }
    ted4_resize_begin(&o.s, t);
    bad = plan(&o, m, to) != 0 || ted4_resize_apply(t, &o.s) != 0;
    for (int i = 0; i < o.n; i++)
        ted4_pruned_units_finish(&o.pruned[i]);
    return bad ? -1 : 0;
}
