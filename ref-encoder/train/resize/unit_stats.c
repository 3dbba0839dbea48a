/* unit_stats.c - see unit_stats.h. These plain loops over a few thousand samples compute spec 10.1,
 * 10.3, 11.2, 11.3 and 11.5, except for the rounding inside the prior's networks.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "unit_stats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/state/anchor_masks.h"
#include "train/state/view_subset.h"
#include "math/lane_sum.h"
#include "train/model/formulas.h"
#include "train/math/random.h"
#include "train/state/visible_blocks.h"

/* PICTURES: training pictures that are sampled. DRAWS: anchors drawn for each picture, of which
 * those in view count. */
enum { PICTURES = 32, DRAWS = 192, MOST = 640 };

typedef struct {
    ted4_trainer *t;
    ted4_site site;
    double *moment;
    size_t width, n;
    const float *value; /* [n_channels][32] of the anchor's block, quantised */
    size_t lane, anchor;
    int dynamic;
    float view[3], bank[TED4_MAX_WIDTH];
} sampling;

static void take(sampling *s, const float *x)
{
    const size_t side = s->width + 1;

    for (size_t i = 0; i < s->width; i++) {
        double *row = s->moment + i * side;

        for (size_t j = 0; j <= i; j++)
            row[j] += (double)x[i] * (double)x[j];
    }
    for (size_t j = 0; j < s->width; j++)
        s->moment[s->width * side + j] += (double)x[j];
    s->n++;
}

/* y = W x + b; relu: max(0, y). */
static void dense(const float *w, size_t in, size_t out, const float *x, float *y, int relu)
{
    const float *b = w + in * out;

    for (size_t o = 0; o < out; o++, w += in) {
        const float sum = b[o] + ted4_lane_dot(in, w, x);

        y[o] = relu ? fmaxf(sum, 0.0f) : sum;
    }
}

/* Runs a network up to hidden layer last, or its outputs for last = n_layers. x is overwritten. */
static void run(const float *blob, const ted4_net_shape *s, float *x, int last)
{
    const float *w = blob + s->first;
    float y[MOST];

    for (int i = 0; i < last; i++) {
        dense(w, s->dim[i], s->dim[i + 1], x, y, i + 1 < s->n_layers);
        w += ted4_layer_size(s, (unsigned)i);
        memcpy(x, y, s->dim[i + 1] * sizeof *x);
    }
}

static float value_of(const sampling *s, int type, int c)
{
    return s->value[(size_t)(s->t->layout.first[type] + c) * TED4_LANES + s->lane];
}

/* Computes the input of F_deform, for motion bank and concat. */
static void deform_input(const sampling *s, float *x)
{
    const ted4_layout *l = &s->t->layout;
    const ted4_net_shape *p = &l->shape.netr[TED4_NET_PROJECT];
    const size_t d = l->head.phi_dim, D = l->head.bank_dim;
    float phi[TED4_MAX_PHI];

    for (int c = 0; c < l->head.phi_dim; c++)
        phi[c] = value_of(s, TED4_PHI, c);
    if (l->head.motion == TED4_MOTION_CONCAT) {
        memcpy(x, phi, d * sizeof *x);
        memcpy(x + d, s->bank, D * sizeof *x);
        return;
    }
    dense(s->t->net.value + l->netr + p->first, d, D, phi, x, 0);
    for (size_t c = 0; c < D; c++)
        x[c] *= s->bank[c];
}

static int has_deform(const ted4_layout *l)
{
    return l->head.motion == TED4_MOTION_BANK || l->head.motion == TED4_MOTION_CONCAT;
}

/* Computes the input of the heads: the anchor's feature, changed by F_deform if moved, followed by
 * the view direction. */
static void head_input(const sampling *s, int moved, float *x)
{
    const ted4_layout *l = &s->t->layout;
    const int F = l->head.feature_dim;
    float y[MOST] = { 0 };

    if (moved && s->dynamic && has_deform(l)) {
        deform_input(s, y);
        run(s->t->net.value + l->netr, &l->shape.netr[TED4_NET_DEFORM], y,
            l->shape.netr[TED4_NET_DEFORM].n_layers);
    } else {
        memset(y, 0, (size_t)(3 + F) * sizeof *y);
    }
    for (int c = 0; c < F; c++)
        x[c] = value_of(s, TED4_FEATURE, c) + y[3 + c];
    memcpy(x + F, s->view, sizeof s->view);
}

static void sample_motion(sampling *s)
{
    const ted4_layout *l = &s->t->layout;
    float x[MOST];

    if (!s->dynamic)
        return;
    if (s->site.kind == TED4_SITE_PHI) {
        for (int c = 0; c < l->head.phi_dim; c++)
            x[c] = value_of(s, TED4_PHI, c);
    } else {
        deform_input(s, x);
        if (s->site.kind == TED4_SITE_HIDDEN)
            run(s->t->net.value + l->netr, &l->shape.netr[TED4_NET_DEFORM], x, s->site.layer);
    }
    take(s, x);
}

static void sample_heads(sampling *s)
{
    const ted4_layout *l = &s->t->layout;
    const int moved = s->site.kind == TED4_SITE_FEATURE || s->site.net == TED4_NET_COVARIANCE;
    float x[MOST];

    head_input(s, moved, x);
    if (s->site.kind == TED4_SITE_HIDDEN)
        run(s->t->net.value + l->netr, &l->shape.netr[s->site.net], x, s->site.layer);
    take(s, x);
    if (s->site.kind == TED4_SITE_FEATURE && s->dynamic && has_deform(l)) {
        head_input(s, 0, x);
        take(s, x);
    }
}

/* spec 10.1: computes the integers of the specification, divided by 4096. */
static void encode_position(const sampling *s, float *x)
{
    const int octaves = s->t->layout.head.pe_octaves;

    for (int a = 0; a < 3; a++) {
        const float p = *ted4_anchor_value(&s->t->anchors, TED4_ROW_POSITION, s->anchor, a);
        const uint32_t phase = ted4_encode_phase(p);

        x[a] = ted4_encode_coordinate(p);
        for (int o = 0; o < octaves; o++) {
            x[3 + 6 * o + 2 * a] = ted4_encode_sine(phase << o);
            x[3 + 6 * o + 2 * a + 1] = ted4_encode_cosine(phase << o);
        }
    }
}

static void sample_prior(sampling *s)
{
    const ted4_layout *l = &s->t->layout;
    const float *nete = s->t->net.value + l->nete;
    float x[MOST] = { 0 };

    if (s->site.kind == TED4_SITE_SLICE) {
        for (int c = 0; c < l->head.feature_dim; c++)
            x[c] = value_of(s, TED4_FEATURE, c) / l->head.step[TED4_FEATURE];
        run(nete, &l->shape.slice[s->site.layer], x, 1);
    } else {
        if (l->head.prior == TED4_PRIOR_INR)
            encode_position(s, x);
        if (s->site.kind == TED4_SITE_HYPER)
            run(nete, &l->shape.hyper, x, s->site.layer);
    }
    take(s, x);
}

static void sample(sampling *s)
{
    switch (s->site.kind) {
    case TED4_SITE_PHI:
    case TED4_SITE_BANK: sample_motion(s); break;
    case TED4_SITE_HIDDEN:
        (s->site.net == TED4_NET_DEFORM ? sample_motion : sample_heads)(s);
        break;
    case TED4_SITE_FEATURE:
    case TED4_SITE_INPUT: sample_heads(s); break;
    case TED4_SITE_POSITION:
    case TED4_SITE_HYPER:
    case TED4_SITE_SLICE: sample_prior(s); break;
    }
}

/* spec 11.2: interpolates the bank at time num. */
static void bank_at(sampling *s, uint32_t num)
{
    const ted4_layout *l = &s->t->layout;
    const uint32_t den = s->t->data->n_frames > 1 ? s->t->data->n_frames - 1 : 1;
    const size_t D = l->head.bank_dim;

    if (!has_deform(l))
        return;

    float mix;
    const float *z = s->t->net.value + l->bank + ted4_bank_row(&l->head, num, den, &mix) * D;

    for (size_t c = 0; c < D; c++)
        s->bank[c] = ted4_bank_value(z, D, c, mix);
}

static void look_from(sampling *s, const float camera[3])
{
    for (int a = 0; a < 3; a++)
        s->view[a] = *ted4_anchor_value(&s->t->anchors, TED4_ROW_POSITION, s->anchor, a) -
                     camera[a];
    ted4_view_direction(&s->view[0], &s->view[1], &s->view[2]);
}

/* Samples the anchors in view of one training picture. value: memory for one block. */
static void sample_picture(sampling *s, size_t item, float *value)
{
    ted4_trainer *t = s->t;
    const ted4_picture *pic = &t->data->pictures[item];
    const uint64_t key = ted4_random(t->opt.seed ^ 0x6163746976u, item);
    ted4_view v;
    float camera[3];

    ted4_trainer_view(t, pic, &v, camera);
    bank_at(s, t->data->n_frames > 1 ? pic->frame : 0);
    for (uint64_t i = 0; i < DRAWS; i++) {
        const size_t block = (s->anchor = ted4_below(key, i, (uint32_t)t->anchors.n)) / TED4_LANES;

        s->lane = s->anchor % TED4_LANES;
        if (!(ted4_block_visible(t, block, &v) >> s->lane & 1))
            continue;
        s->value = t->phase.stage2 ? value : ted4_block(&t->anchors, TED4_ROW_VALUE, block);
        if (t->phase.stage2)
            ted4_quantise(&t->layout, TED4_QUANT_ROUND,
                          ted4_block(&t->anchors, TED4_ROW_VALUE, block),
                          ted4_block(&t->anchors, TED4_ROW_STEP, block), (uint32_t)block, 0, value);
        s->dynamic = ted4_is_dynamic(t, s->anchor);
        look_from(s, camera);
        sample(s);
    }
}

/* Turns the sums in the lower triangle into means of the whole matrix. */
static void mean_of(sampling *s)
{
    const size_t side = s->width + 1;
    const double n = s->n > 0 ? (double)s->n : 1.0;

    s->moment[side * side - 1] = n;
    for (size_t i = 0; i < side; i++)
        for (size_t j = 0; j <= i; j++)
            s->moment[i * side + j] = s->moment[j * side + i] = s->moment[i * side + j] / n;
}

int ted4_site_moment(ted4_trainer *t, ted4_site site, double *moment)
{
    sampling s = {
        .t = t, .site = site, .moment = moment, .width = (size_t)ted4_site_width(&t->layout, site)
    };
    const size_t n = t->order.n < PICTURES ? t->order.n : PICTURES;
    uint32_t item[PICTURES];
    float *value;

    if (ted4_view_subset_choose(t, t->opt.seed ^ 0x6163746976u, n, item) != 0)
        return -1;
    value = malloc((size_t)t->layout.n_channels * TED4_LANES * sizeof *value);
    if (value == NULL)
        return ted4_trainer_fail(t, "no memory to look at networks");
    memset(moment, 0, (s.width + 1) * (s.width + 1) * sizeof *moment);
    for (size_t i = 0; i < n; i++)
        sample_picture(&s, item[i], value);
    mean_of(&s);
    free(value);
    return 0;
}
