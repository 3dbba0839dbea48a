/* rate_ref.h - a second implementation of the rate model, in double precision, one anchor at a
 * time, from spec 9.4, 10.1, 10.3 and the head of rate_row.c; and random models to test it on.
 * Shares no arithmetic with the files of train/rate.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RATE_REF_H
#define TED4_RATE_REF_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "norm/half.h"
#include "random_source.h"
#include "train/rate/rate.h"

enum { REF_MAX_CHANNELS = 128, REF_MAX_OUTPUTS = 256, REF_MAX_NET = 4096, REF_BLOCKS = 3 };

#define REF_S_MIN (-4.0)
#define REF_S_MAX (175.0 / 16.0)
#define REF_V_MIN (-4.0)
#define REF_V_MAX (127.0 / 32.0)

/* ---- random numbers of the tests ---- */

static random_source ref_source = { 1 };

/* Uniform in [-1, 1). */
static inline double ref_uniform(void)
{
    return 2 * random_unit(&ref_source) - 1;
}

/* ---- the model ---- */

/* Behaviour of clamped outputs while weights are varied: an open output follows its raw value,
 * starting from the limit (the one-sided gradient); a closed one stays. */
typedef struct {
    double raw[REF_MAX_OUTPUTS]; /* at the base point */
    int open[REF_MAX_OUTPUTS];   /* -1: not clamped */
    double nudge[REF_MAX_OUTPUTS];
} ref_clamps;

typedef struct {
    double position[3];
    double x[REF_MAX_CHANNELS], n[REF_MAX_CHANNELS]; /* attribute channels; k = x / q + n */
    double logit[TED4_MAX_OFFSETS + 1];              /* offsets, then temporal */
    double d_value[REF_MAX_CHANNELS];
} ref_anchor;

typedef struct {
    double bits[TED4_TYPES];                        /* masked */
    double offset_bits[TED4_MAX_OFFSETS], phi_bits; /* unmasked */
    double steps[TED4_TYPES];
    double loss;
    double raw[REF_MAX_OUTPUTS];
} ref_result;

typedef struct {
    const ted4_layout *layout;
    const double *nete;
    double bit_weight, distortion_weight;
    int activation;
} ref_model;

static inline double ref_octave_sine(uint32_t u)
{
    const double turn = 6.283185307179586476925, i = u >> 22, b = u >> 10 & 4095;
    const double at = rint(4096.0 * sin(turn * i / 1024.0));
    const double next = rint(4096.0 * sin(turn * (i + 1.0) / 1024.0));

    return at + floor((next - at) * b / 4096.0 + 0.5);
}

/* spec 10.1, divided by 4096. */
static inline void ref_inputs(const ted4_header *h, const double *p, double *x)
{
    if (h->prior == TED4_PRIOR_FACTORISED)
        return;
    for (int a = 0; a < 3; a++)
        *x++ = floor(p[a] * 4096.0) / 4096.0;
    for (int l = 0; l < h->pe_octaves; l++)
        for (int a = 0; a < 3; a++) {
            const uint32_t u = (uint32_t)(int32_t)(p[a] * 16777216.0) << (7 + l);

            *x++ = ref_octave_sine(u) / 4096.0;
            *x++ = ref_octave_sine(u + ((uint32_t)1 << 30)) / 4096.0;
        }
}

/* spec 7.1 */
static inline void ref_net(const ted4_net_shape *n, const double *nete, const double *x, double *y)
{
    const double *w = nete + n->first;
    double buffer[2][REF_MAX_OUTPUTS];

    for (int i = 0; i < n->n_layers; i++) {
        const int in = n->dim[i], out = n->dim[i + 1], last = i + 1 == n->n_layers;
        double *to = last ? y : buffer[i % 2];

        for (int o = 0; o < out; o++) {
            double acc = w[in * out + o];

            for (int j = 0; j < in; j++)
                acc += w[o * in + j] * x[j];
            to[o] = !last && acc < 0.0 ? 0.0 : acc;
        }
        w += (in + 1) * out;
        x = to;
    }
}

static inline double ref_tail(double t)
{
    return 0.5 * erfc(t * 0.70710678118654752440);
}

/* As in the head of rate_row.c. */
static inline double ref_bits(double u, double s)
{
    const double a = fabs(u), sigma = exp2(s);
    const double low = (a - 0.5) / sigma, high = (a + 0.5) / sigma;
    const double p = low > 0.0 ? ref_tail(low) - ref_tail(high)
                               : 1.0 - ref_tail(-low) - ref_tail(high);
    const double w = fmin(6.0 * sigma, 4095.0) + 2.0;
    const double h = a < w ? 1.0 / (1.0 + a / w) : 0.5 / ((1.0 + a - w) * (1.0 + a - w));

    const double share = a < w ? p : h * ref_tail((w - 1.5) / sigma);

    return -log2((1.0 - 2.0 * w / 65536.0) * share + h / 65536.0);
}

static inline double ref_limit(const ref_clamps *c, unsigned i, double raw, double low, double high)
{
    const double limited = fmin(fmax(raw, low), high);

    if (c == NULL || c->open[i] < 0)
        return limited;
    return fmin(fmax(c->raw[i], low), high) + c->nudge[i] + (c->open[i] ? raw - c->raw[i] : 0.0);
}

static inline int ref_mask_on(double logit)
{
    return 1.0 / (1.0 + exp(-logit)) > 0.01;
}

/* Evaluates all networks: hyperprior and slices. q: steps. */
static inline void ref_outputs(const ref_model *m, const ref_anchor *a, const ref_clamps *c,
                               ref_result *r)
{
    const ted4_layout *l = m->layout;
    const ted4_shape *s = &l->shape;
    const unsigned f = s->dim[TED4_FEATURE];
    double x[REF_MAX_OUTPUTS], context[REF_MAX_CHANNELS], y[REF_MAX_OUTPUTS];

    ref_inputs(&l->head, a->position, x);
    ref_net(&s->hyper, m->nete, x, r->raw);
    for (unsigned t = 0, i = s->first_step_output; t < TED4_TYPES; t++) {
        r->steps[t] = 1.0;
        if (s->dim[t] > 0) {
            r->steps[t] = (double)l->head.step[t] *
                          exp2(ref_limit(c, i, r->raw[i], REF_V_MIN, REF_V_MAX));
            i++;
        }
    }
    for (unsigned j = 0; j < f; j++)
        context[j] = (a->x[j] + r->steps[0] * a->n[j]) / (double)l->head.step[0];
    for (unsigned k = 1, known = 0; k < l->head.n_slices; k++) {
        const unsigned dim = l->head.slice[k];

        known += l->head.slice[k - 1];
        ref_net(&s->slice[k], m->nete, context, y);
        for (unsigned j = 0; j < dim; j++) {
            r->raw[known + j] += y[j];
            r->raw[known + f + j] += y[dim + j];
        }
    }
}

static inline void ref_evaluate(const ref_model *m, const ref_anchor *a, const ref_clamps *clamps,
                                ref_result *r)
{
    const ted4_layout *l = m->layout;
    const ted4_shape *s = &l->shape;
    int kept[TED4_MAX_OFFSETS], any = 0;

    memset(r, 0, sizeof *r);
    ref_outputs(m, a, clamps, r);
    for (unsigned k = 0; k < l->head.n_offsets; k++) {
        kept[k] = !l->head.offset_mask || ref_mask_on(a->logit[k]);
        any |= kept[k];
    }
    const int moves = !l->head.temporal_mask || ref_mask_on(a->logit[l->head.n_offsets]);

    for (unsigned t = 0; t < TED4_TYPES; t++) {
        if (t == TED4_TAU && !m->activation)
            continue;
        for (unsigned c = 0; c < s->dim[t]; c++) {
            const unsigned mu = s->first_output[t] + c, i = mu + s->dim[t];
            const unsigned ch = (unsigned)l->first[t] + c;
            const double sigma = ref_limit(clamps, i, r->raw[i], REF_S_MIN, REF_S_MAX);
            const double bits = ref_bits(a->x[ch] / r->steps[t] + a->n[ch] - r->raw[mu], sigma);
            const int on = t == TED4_OFFSET ? kept[c / 3] : t == TED4_PHI ? any && moves : any;

            r->bits[t] += on ? bits : 0.0;
            if (t == TED4_OFFSET)
                r->offset_bits[c / 3] += bits;
            if (t == TED4_PHI)
                r->phi_bits += any ? bits : 0.0;
            r->loss += m->distortion_weight * a->d_value[ch] * r->steps[t] * a->n[ch];
        }
        r->loss += m->bit_weight * r->bits[t];
    }
}

/* Finds the outputs that are clamped at this point, and opens those that gradient descent would
 * move back inside the limits. */
static inline void ref_find_clamps(const ref_model *m, const ref_anchor *a, ref_clamps *c)
{
    const ted4_shape *s = &m->layout->shape;
    ref_result r, up, down;

    memset(c, 0, sizeof *c);
    ref_evaluate(m, a, NULL, &r);
    memcpy(c->raw, r.raw, sizeof c->raw);
    for (unsigned i = 0; i < REF_MAX_OUTPUTS; i++)
        c->open[i] = -1;
    for (unsigned i = 0; i < s->n_outputs; i++) {
        int is_s = 0;

        for (int t = 0; t < TED4_TYPES; t++)
            is_s |= i >= s->first_output[t] + s->dim[t] && i < s->first_output[t] + 2 * s->dim[t];
        const int is_v = i >= s->first_step_output;
        const double low = is_v ? REF_V_MIN : REF_S_MIN, high = is_v ? REF_V_MAX : REF_S_MAX;

        if ((!is_s && !is_v) || (r.raw[i] > low && r.raw[i] < high))
            continue;
        c->open[i] = 0;
        c->nudge[i] = 1e-5;
        ref_evaluate(m, a, c, &up);
        c->nudge[i] = -1e-5;
        ref_evaluate(m, a, c, &down);
        c->nudge[i] = 0.0;
        c->open[i] = r.raw[i] <= low ? up.loss < down.loss : up.loss > down.loss;
    }
}

/* ---- random models ---- */

typedef struct {
    ted4_layout layout;
    float *net;
    double nete[REF_MAX_NET];
    float *attr[REF_BLOCKS], *position[REF_BLOCKS], *d_value[REF_BLOCKS];
    float *d_attr[REF_BLOCKS], *steps[REF_BLOCKS];
    float *d_net;
    uint32_t lanes[REF_BLOCKS], block[REF_BLOCKS];
    ted4_rate *rate;
    ted4_rate_input in;
} ref_world;

static inline float *ref_floats(size_t n)
{
    float *p = aligned_alloc(64, (n * sizeof *p + 63) / 64 * 64);

    for (size_t i = 0; i < n; i++)
        p[i] = 0.0f;
    return p;
}

/* A small model with every feature; tests may change it before ref_world_make. */
static inline ted4_header ref_header(void)
{
    ted4_header h = { .n_anchors = 96,
                      .tile_size = 96,
                      .n_offsets = 2,
                      .feature_dim = 7,
                      .motion = TED4_MOTION_BANK,
                      .phi_dim = 2,
                      .bank_rows = 2,
                      .bank_dim = 2,
                      .deform_layers = 1,
                      .deform_width = 2,
                      .temporal_mask = 1,
                      .offset_mask = 1,
                      .activation = 1,
                      .scale_domain = TED4_SCALE_LOG2,
                      .prior = TED4_PRIOR_INR,
                      .pe_octaves = 3,
                      .hyper_layers = 2,
                      .hyper_width = 9,
                      .n_slices = 3,
                      .slice = { 2, 1, 4 },
                      .ar_width = 5,
                      .context_bits = 6,
                      .step = { 0.75f, 0.03f, 0.2f, 0.1f, 0.01f },
                      .frames = 10,
                      .rate_num = 30,
                      .rate_den = 1 };

    return h;
}

static inline float *ref_bias(ref_world *w, unsigned output)
{
    const ted4_net_shape *n = &w->layout.shape.hyper;
    size_t at = w->layout.nete + n->first;

    for (int i = 0; i < n->n_layers - 1; i++)
        at += (n->dim[i] + 1u) * n->dim[i + 1];
    return w->net + at + (size_t)n->dim[n->n_layers - 1] * n->dim[n->n_layers] + output;
}

static inline void ref_random_net(ref_world *w)
{
    for (size_t i = 0; i < w->layout.n_net; i++)
        w->net[i] = (float)(0.5 * ref_uniform());
}

/* Draws values within a few steps of 0, and logits on both sides of the threshold, -4.6. */
static inline void ref_random_block(ref_world *w, int visible)
{
    const ted4_layout *l = &w->layout;

    for (int j = 0; j < TED4_LANES; j++) {
        for (int a = 0; a < 3; a++)
            w->position[visible][a * TED4_LANES + j] =
                ted4_half_to_float(ted4_float_to_half((float)ref_uniform()));
        for (int t = 0; t < TED4_TYPES; t++)
            for (unsigned c = 0; c < l->shape.dim[t]; c++) {
                const size_t at = ((size_t)l->first[t] + c) * TED4_LANES + (size_t)j;

                w->attr[visible][at] = (float)(3.0 * ref_uniform()) * l->head.step[t];
                w->d_value[visible][at] = (float)ref_uniform() / l->head.step[t];
            }
        for (int c = l->offset_logit; c < l->n_channels; c++)
            w->attr[visible][c * TED4_LANES + j] = (float)(-3.6 + 3.0 * ref_uniform());
    }
    w->lanes[visible] = 0xffffffffu;
    w->block[visible] = 17u + 1000u * (uint32_t)visible;
}

static inline void ref_world_make(ref_world *w, const ted4_header *h)
{
    memset(w, 0, sizeof *w);
    ted4_layout_make(&w->layout, h);
    w->net = ref_floats(w->layout.n_net);
    w->d_net = ref_floats(w->layout.n_net);
    ref_random_net(w);
    for (int i = 0; i < REF_BLOCKS; i++) {
        const size_t block = (size_t)w->layout.n_channels * TED4_LANES;

        w->attr[i] = ref_floats(block);
        w->d_attr[i] = ref_floats(block);
        w->d_value[i] = ref_floats(block);
        w->position[i] = ref_floats(3 * TED4_LANES);
        w->steps[i] = ref_floats(TED4_TYPES * TED4_LANES);
        ref_random_block(w, i);
    }
    w->rate = ted4_rate_new(&w->layout);
    w->in = (ted4_rate_input) { .layout = &w->layout,
                                .net = w->net,
                                .n_visible = REF_BLOCKS,
                                .attr = (const float *const *)w->attr,
                                .position = (const float *const *)w->position,
                                .lanes = w->lanes,
                                .block = w->block,
                                .key = 0x123456789abcdefu,
                                .quant = TED4_QUANT_NOISE,
                                .bit_weight = 0.7f,
                                .distortion_weight = 0.3f,
                                .activation = 1 };
}

static inline void ref_world_finish(ref_world *w)
{
    for (int i = 0; i < REF_BLOCKS; i++) {
        free(w->attr[i]);
        free(w->d_attr[i]);
        free(w->d_value[i]);
        free(w->position[i]);
        free(w->steps[i]);
    }
    free(w->net);
    free(w->d_net);
    ted4_rate_free(w->rate);
}

/* Computes all gradients, starting from zero. Returns 0 or -1. */
static inline int ref_run(ref_world *w, const ted4_parallel *p, double *bits)
{
    const size_t block = (size_t)w->layout.n_channels * TED4_LANES;

    for (int i = 0; i < REF_BLOCKS; i++)
        memset(w->d_attr[i], 0, block * sizeof(float));
    memset(w->d_net, 0, w->layout.n_net * sizeof(float));
    ted4_rate_pack(w->rate, w->net);
    return ted4_rate_evaluate(w->rate, &w->in, p, (const float *const *)w->d_value, w->d_attr,
                              w->d_net, w->steps, bits);
}

static inline ref_model ref_model_make(ref_world *w)
{
    for (size_t i = 0; i < w->layout.shape.n_nete; i++)
        w->nete[i] = (double)w->net[w->layout.nete + i];
    return (ref_model) { &w->layout, w->nete, (double)w->in.bit_weight,
                         (double)w->in.distortion_weight, w->in.activation };
}

/* Extracts the noise of a block by means of ted4_quantise on values 0 with steps 1 (a_s and a_f are
 * kept apart, so that enforcing their order has no effect). */
static inline void ref_noise(const ref_world *w, int visible, float *noise)
{
    const ted4_layout *l = &w->layout;
    const size_t block = (size_t)l->n_channels * TED4_LANES;
    float *zero = ref_floats(block), *one = ref_floats(TED4_TYPES * TED4_LANES);

    for (int i = 0; i < TED4_TYPES * TED4_LANES; i++)
        one[i] = 1.0f;
    for (int j = 0; j < TED4_LANES && l->first[TED4_TAU] >= 0; j++) {
        zero[(l->first[TED4_TAU] + 0) * TED4_LANES + j] = -2.0f;
        zero[(l->first[TED4_TAU] + 2) * TED4_LANES + j] = 2.0f;
    }
    ted4_quantise(l, TED4_QUANT_NOISE, zero, one, w->block[visible], w->in.key, noise);
    for (size_t i = 0; i < (size_t)l->offset_logit * TED4_LANES; i++)
        noise[i] -= zero[i];
    free(zero);
    free(one);
}

/* Fills *a with the anchor of a visible block and lane after ref_run, with its residuals. */
static inline void ref_anchor_make(const ref_world *w, const ref_model *m, int visible, int lane,
                                   const float *noise, ref_anchor *a)
{
    const ted4_layout *l = &w->layout;
    ref_result r;

    memset(a, 0, sizeof *a);
    for (int i = 0; i < 3; i++)
        a->position[i] = (double)w->position[visible][i * TED4_LANES + lane];
    for (int c = 0; c < l->offset_logit; c++) {
        a->x[c] = (double)w->attr[visible][c * TED4_LANES + lane];
        a->d_value[c] = (double)w->d_value[visible][c * TED4_LANES + lane];
        a->n[c] = (double)noise[c * TED4_LANES + lane];
    }
    for (int c = l->offset_logit; c < l->n_channels; c++)
        a->logit[c - l->offset_logit] = (double)w->attr[visible][c * TED4_LANES + lane];
    ref_outputs(m, a, NULL, &r); /* steps do not depend on residuals */
    for (int t = 0; t < TED4_TYPES && w->in.quant == TED4_QUANT_ROUND; t++)
        for (unsigned c = 0; c < l->shape.dim[t]; c++) {
            const double x = a->x[l->first[t] + (int)c] / r.steps[t];

            a->n[l->first[t] + (int)c] = rint(x) - x;
        }
    if (l->first[TED4_TAU] >= 0) { /* R-ATT-001 */
        const int s = l->first[TED4_TAU], f = s + 2;
        const double k = a->x[s] / r.steps[TED4_TAU] + a->n[s];
        const double end = a->x[f] / r.steps[TED4_TAU];

        a->n[f] = fmax(end + a->n[f], k) - end;
    }
}

#endif
