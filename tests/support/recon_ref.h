/* recon_ref.h - a second implementation of spec 11, one record at a time, written directly from the
 * text, to test ref-decoder/recon against. Numbers are doubles. In strict mode rd() rounds each
 * operation to binary32: since 53 bits exceed twice 24, the double rounding is harmless for + - * /
 * and square root, so the result is of class X for any compiler flags. Otherwise nothing is rounded
 * and pow2 is exp2.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RECON_REF_H
#define RECON_REF_H

#include <math.h>
#include <stdint.h>
#include "norm/half.h"
#include "norm/syntax.h"

enum { REF_VALUES = 14, REF_WIDTH = 640 };

typedef struct {
    const struct ted4_scene *s;
    const ted4_query *q;
    int strict;
} ref;

/* volatile: gcc 12.2 at -O3 drops the narrowing where it vectorises two doubles. */
static inline double rd(const ref *r, double x)
{
    volatile float narrow = (float)x;

    return r->strict ? (double)narrow : x;
}

static inline double ref_max(double a, double b)
{
    return a > b ? a : b;
}

static inline double ref_pow2(const ref *r, double x)
{
    static const double c[8] = { 0x1.ffcbfcp-17, 0x1.430912p-13, 0x1.5d87fep-10, 0x1.3b2ab6p-7,
                                 0x1.c6b08ep-5,  0x1.ebfbep-3,   0x1.62e43p-1,   1 };
    if (x != x)
        return x;
    x = x < -126 ? -126 : x > 126 ? 126 : x;
    if (!r->strict)
        return exp2(x);
    const double n = floor(rd(r, x + 0.5)), f = rd(r, x - n);
    double p = c[0];

    for (int i = 1; i < 8; i++)
        p = rd(r, rd(r, p * f) + c[i]);
    return rd(r, p * exp2(n));
}

static inline double ref_sigmoid(const ref *r, double x)
{
    return rd(r, 1 / rd(r, 1 + ref_pow2(r, rd(r, -x * (double)0x1.715476p+0f))));
}

/* Root of the sum of n squares. */
static inline double ref_norm(const ref *r, const double *v, int n)
{
    double sum = rd(r, v[0] * v[0]);

    for (int i = 1; i < n; i++)
        sum = rd(r, sum + rd(r, v[i] * v[i]));
    return rd(r, sqrt(sum));
}

static inline void ref_network(const ref *r, int net, const double *in, double *out)
{
    const ted4_net_shape *n = &r->s->shape.netr[net];
    const float *w = r->s->netr.values + n->first;
    double x[REF_WIDTH], y[REF_WIDTH];

    for (unsigned i = 0; i < n->dim[0]; i++)
        x[i] = in[i];
    for (unsigned layer = 0; layer < n->n_layers; layer++) {
        const unsigned n_in = n->dim[layer], n_out = n->dim[layer + 1];

        for (unsigned o = 0; o < n_out; o++) {
            y[o] = (double)w[n_in * n_out + o];
            for (unsigned i = 0; i < n_in; i++)
                y[o] = rd(r, y[o] + rd(r, (double)w[o * n_in + i] * x[i]));
        }
        for (unsigned o = 0; o < n_out; o++)
            x[o] = layer + 1 < n->n_layers ? ref_max(0, y[o]) : y[o];
        w += (size_t)n_in * n_out + n_out;
    }
    for (unsigned o = 0; o < n->dim[n->n_layers]; o++)
        out[o] = x[o];
}

static inline double ref_value(const ref *r, ted4_type t, size_t c, size_t anchor)
{
    const struct ted4_scene *s = r->s;
    const double step = exp2((s->step_index[t][anchor] - 128) / 32.0);
    const double q = rd(r, (double)s->head.step[t] * (double)(float)step);

    return rd(r, s->symbol[t][c * s->head.n_anchors + anchor] * q);
}

static inline double ref_sine(uint32_t u)
{
    const double turn = 2 * 3.14159265358979323846 / 1024;
    const uint32_t i = u >> 22, b = (u >> 10) % 4096;
    const double s0 = nearbyint(4096 * sin(turn * i)), s1 = nearbyint(4096 * sin(turn * (i + 1)));

    return s0 + floor(((s1 - s0) * b + 2048) / 4096);
}

/* spec 10.1 with 10 octaves of n coordinates, rounded to binary32. */
static inline void ref_encode(const int64_t *x, int n, double *out)
{
    for (int c = 0; c < n; c++)
        *out++ = floor((double)x[c] / 4096) / 4096;
    for (int l = 0; l < 10; l++)
        for (int c = 0; c < n; c++) {
            const uint32_t u = (uint32_t)((uint64_t)x[c] << (7 + l));

            *out++ = ref_sine(u) / 4096;
            *out++ = ref_sine(u + (1u << 30)) / 4096;
        }
}

/* spec 11.2 */
static inline void ref_bank(const ref *r, double *z)
{
    const size_t rows = r->s->head.bank_rows, dim = r->s->head.bank_dim;
    const uint64_t g = (uint64_t)r->q->num * (rows - 1), i = g / r->q->den;
    const double w = rd(r, (double)(g % r->q->den) / r->q->den);

    for (size_t c = 0; c < dim; c++) {
        const float *at = r->s->bank.values + i * dim + c;

        z[c] = (double)at[0];
        if (i < rows - 1)
            z[c] = rd(r, z[c] + rd(r, w * rd(r, (double)at[dim] - z[c])));
    }
}

/* spec 11.3: takes p and f, and gives p' and f'. */
static inline void ref_move(const ref *r, size_t anchor, double *p, double *f)
{
    const ted4_header *h = &r->s->head;
    double x[REF_WIDTH], z[REF_WIDTH], y[REF_WIDTH];
    unsigned n = 0;

    if (h->motion == TED4_MOTION_NONE || (h->temporal_mask && !r->s->dynamic[anchor]))
        return;
    if (h->motion == TED4_MOTION_INR) {
        int64_t at[3], t = (int64_t)(((uint64_t)r->q->num << 24) / r->q->den);

        for (int c = 0; c < 3; c++)
            at[c] = (int64_t)(p[c] * 16777216);
        ref_encode(at, 3, x);
        ref_encode(&t, 1, x + 63);
    } else {
        for (; n < h->phi_dim; n++)
            x[n] = ref_value(r, TED4_PHI, n, anchor);
        ref_bank(r, z);
        if (h->motion == TED4_MOTION_BANK) {
            ref_network(r, TED4_NET_PROJECT, x, x);
            for (unsigned i = 0; i < h->bank_dim; i++)
                x[i] = rd(r, x[i] * z[i]);
        } else {
            for (unsigned i = 0; i < h->bank_dim; i++)
                x[n + i] = z[i];
        }
    }
    ref_network(r, TED4_NET_DEFORM, x, y);
    for (int c = 0; c < 3; c++)
        p[c] = rd(r, p[c] + y[c]);
    for (unsigned c = 0; c < h->feature_dim; c++)
        f[c] = rd(r, f[c] + y[3 + c]);
}

/* spec 11.4 */
static inline double ref_activation(const ref *r, size_t anchor)
{
    const double t = rd(r, (double)r->q->num / r->q->den);
    double tau[4], a, b;

    if (!r->s->head.activation)
        return 1;
    for (size_t c = 0; c < 4; c++)
        tau[c] = ref_value(r, TED4_TAU, c, anchor);
    if (t < tau[0]) {
        a = tau[0];
        b = ref_max(ref_pow2(r, tau[1]), 0x1p-12);
    } else if (t > tau[2]) {
        a = tau[2];
        b = ref_max(ref_pow2(r, tau[3]), 0x1p-12);
    } else
        return 1;
    const double u = rd(r, rd(r, t - a) / b);

    return ref_pow2(r, rd(r, -rd(r, u * u) * (double)0x1.715476p+0f));
}

static inline void ref_direction(const ref *r, const double *p, double *dir)
{
    double v[3];

    for (int c = 0; c < 3; c++) {
        const double eye = rd(r, rd(r, (double)r->q->camera[c] - (double)r->s->head.origin[c]) *
                                     exp2(-r->s->head.exponent));
        v[c] = rd(r, p[c] - eye);
    }
    const double n = ref_norm(r, v, 3);

    for (int c = 0; c < 3; c++)
        dir[c] = n < 0x1p-20 ? (c == 2) : rd(r, v[c] / n);
}

static inline double ref_scale(const ref *r, size_t c, size_t anchor)
{
    const double l = ref_value(r, TED4_SCALING, c, anchor);

    return r->s->head.scale_domain == TED4_SCALE_LOG2 ? ref_pow2(r, l) : ref_max(l, 0x1p-20);
}

/* The values that all records of an anchor share. */
typedef struct {
    double p[3], opacity[16], covariance[7 * 16], colour[3 * 16], size[6], activation;
} ref_anchor;

static inline void ref_make_anchor(const ref *r, size_t anchor, ref_anchor *a)
{
    const ted4_header *h = &r->s->head;
    double f[TED4_MAX_FEATURE + 3], moved[TED4_MAX_FEATURE + 3], dir[3];

    for (int c = 0; c < 3; c++)
        a->p[c] = (double)ted4_half_to_float(r->s->position[3 * anchor + c]);
    for (size_t c = 0; c < 6; c++)
        a->size[c] = ref_scale(r, c, anchor);
    ref_direction(r, a->p, dir);
    for (size_t c = 0; c < h->feature_dim + 3u; c++)
        moved[c] = f[c] = c < h->feature_dim ? ref_value(r, TED4_FEATURE, c, anchor)
                                             : dir[c - h->feature_dim];
    ref_move(r, anchor, a->p, moved);
    a->activation = ref_activation(r, anchor);
    ref_network(r, TED4_NET_OPACITY, f, a->opacity);
    ref_network(r, TED4_NET_COVARIANCE, moved, a->covariance);
    ref_network(r, TED4_NET_COLOUR, f, a->colour);
}

static inline void ref_make_record(const ref *r, size_t anchor, const ref_anchor *a, size_t k,
                                   double *v)
{
    const ted4_header *h = &r->s->head;
    const double unit = exp2(h->exponent), *y = a->covariance + 7 * k;
    const double n = ref_norm(r, y + 3, 4);

    for (size_t c = 0; c < 3; c++) {
        const double o = ref_value(r, TED4_OFFSET, 3 * k + c, anchor);
        const double at = rd(r, a->p[c] + rd(r, o * a->size[c]));

        v[c] = rd(r, (double)h->origin[c] + rd(r, at * unit));
        v[3 + c] = rd(r, rd(r, a->size[3 + c] * ref_sigmoid(r, y[c])) * unit);
        v[11 + c] = ref_sigmoid(r, a->colour[3 * k + c]);
    }
    for (size_t c = 0; c < 4; c++)
        v[6 + c] = n < 0x1p-20 ? (c == 0) : rd(r, y[3 + c] / n);
    const double o = rd(r, rd(r, 2 * ref_sigmoid(r, rd(r, 2 * a->opacity[k]))) - 1);

    v[10] = rd(r, ref_max(0, o) * a->activation);
}

/* Computes all records of a query, in order: record[n][REF_VALUES]. Returns n. */
static inline size_t ref_query(const struct ted4_scene *s, const ted4_query *q, int strict,
                               double *record)
{
    const ref r = { s, q, strict };
    ref_anchor a;
    size_t n = 0;

    for (size_t i = 0; i < s->head.n_anchors; i++) {
        ref_make_anchor(&r, i, &a);
        for (size_t k = 0; k < s->head.n_offsets; k++)
            if (s->offset_bits[i] >> k & 1)
                ref_make_record(&r, i, &a, k, record + REF_VALUES * n++);
    }
    return n;
}

#endif
