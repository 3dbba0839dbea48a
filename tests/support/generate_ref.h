/* generate_ref.h - spec 11.1 to 11.5 in double precision, one anchor at a time, written directly
 * from the text: the reference of test_generate.c and test_generate_grad.c. Masks are written so
 * that central differences see their straight-through gradient. Shares no code with train/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GENERATE_REF_H
#define TED4_GENERATE_REF_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "norm/syntax.h"

enum { REF_WIDEST = 256, REF_OUT = 14 };

typedef struct {
    ted4_header head;
    uint32_t num, den;
    double camera[3];
    int activation;
    const double *net; /* NETR, followed by BANK */
    size_t n_netr;
} ref_query;

/* Positions of an anchor's attributes in its array of channels (train/model/model.h). */
typedef struct {
    int feature, scaling, offset, phi, tau, offset_logit, temporal_logit, n;
} ref_channels;

static inline ref_channels ref_channels_of(const ted4_header *h)
{
    ref_channels c;

    c.feature = 0;
    c.scaling = h->feature_dim;
    c.offset = c.scaling + 6;
    c.phi = c.offset + 3 * h->n_offsets;
    c.tau = c.phi + h->phi_dim;
    c.offset_logit = c.tau + (h->activation ? 4 : 0);
    c.temporal_logit = c.offset_logit + h->n_offsets;
    c.n = c.temporal_logit + 1;
    return c;
}

static inline double ref_sigmoid(double x)
{
    return 1.0 / (1.0 + exp(-x));
}

/* The hard mask at the base logit, plus the change of the sigmoid from there: its value is that of
 * the hard mask, its slope that of the sigmoid. */
static inline double ref_mask(double logit, double base)
{
    return (ref_sigmoid(base) > 0.01 ? 1.0 : 0.0) + ref_sigmoid(logit) - ref_sigmoid(base);
}

/* spec 7.1: evaluates a network whose parameters start at *w, and advances *w past them. */
static inline void ref_network(const double **w, int in, int hidden, int width, int out,
                               const double *x, double *y)
{
    double a[REF_WIDEST], b[REF_WIDEST];

    memcpy(a, x, (size_t)in * sizeof *a);
    for (int i = 0; i <= hidden; i++) {
        const int n = i < hidden ? width : out;

        for (int o = 0; o < n; o++) {
            b[o] = (*w)[n * in + o];
            for (int j = 0; j < in; j++)
                b[o] += (*w)[o * in + j] * a[j];
            if (i < hidden && b[o] < 0.0)
                b[o] = 0.0;
        }
        *w += n * in + n;
        in = n;
        memcpy(a, b, (size_t)n * sizeof *a);
    }
    memcpy(y, a, (size_t)out * sizeof *y);
}

/* spec 10.1, the sine of a phase, times 4096. */
static inline double ref_sine(uint32_t u)
{
    const double step = 2.0 * 3.14159265358979323846 / 1024.0;
    const uint32_t i = u >> 22, b = u >> 10 & 4095;
    const double low = rint(4096.0 * sin(step * i)), high = rint(4096.0 * sin(step * (i + 1)));

    return low + floor(((high - low) * b + 2048.0) / 4096.0);
}

static inline void ref_encode(int n, const int32_t *x, double *to)
{
    for (int c = 0; c < n; c++)
        *to++ = floor(x[c] / 4096.0) / 4096.0;
    for (int octave = 0; octave < 10; octave++)
        for (int c = 0; c < n; c++) {
            const uint32_t u = (uint32_t)x[c] << (7 + octave);

            *to++ = ref_sine(u) / 4096.0;
            *to++ = ref_sine(u + 0x40000000u) / 4096.0;
        }
}

/* spec 11.2. */
static inline void ref_bank(const ref_query *q, double *z)
{
    const uint64_t g = (uint64_t)q->num * (q->head.bank_rows - 1), i = g / q->den;
    const int dim = q->head.bank_dim;
    const double w = (double)(g % q->den) / q->den;
    const double *row = q->net + q->n_netr + i * (size_t)dim;

    for (int c = 0; c < dim; c++)
        z[c] = i >= q->head.bank_rows - 1 ? row[c] : row[c] + w * (row[dim + c] - row[c]);
}

/* spec 11.3: y of F_deform. Advances *w past the networks of motion. */
static inline void ref_motion(const ref_query *q, const double **w, const double *phi,
                              const double *p, double *y)
{
    const ted4_header *h = &q->head;
    const int d = h->phi_dim, dim = h->bank_dim;
    double x[REF_WIDEST], z[REF_WIDEST];
    int n = dim;

    if (h->motion == TED4_MOTION_INR) {
        int32_t fixed[3];
        const int32_t time = (int32_t)(((uint64_t)q->num << 24) / q->den);

        for (int c = 0; c < 3; c++)
            fixed[c] = (int32_t)(p[c] * 0x1p24);
        ref_encode(3, fixed, x);
        ref_encode(1, &time, x + 63);
        n = 84;
    } else {
        ref_bank(q, z);
        if (h->motion == TED4_MOTION_BANK) {
            ref_network(w, d, 0, 0, dim, phi, x);
            for (int c = 0; c < dim; c++)
                x[c] *= z[c];
        } else {
            memcpy(x, phi, (size_t)d * sizeof *x);
            memcpy(x + d, z, (size_t)dim * sizeof *x);
            n = d + dim;
        }
    }
    ref_network(w, n, h->deform_layers, h->deform_width, 3 + h->feature_dim, x, y);
}

/* spec 11.4. */
static inline double ref_activation(const ref_query *q, const double *tau)
{
    const double t = (float)q->num / (float)q->den;
    const double start = fmax(exp2(tau[1]), 0x1p-12), end = fmax(exp2(tau[3]), 0x1p-12);
    double u = 0.0;

    if (t < tau[0])
        u = (t - tau[0]) / start;
    else if (t > tau[2])
        u = (t - tau[2]) / end;
    return exp(-u * u);
}

static inline void ref_direction(const ref_query *q, const double *p, double *to)
{
    double n = 0.0;

    for (int c = 0; c < 3; c++) {
        to[c] = p[c] - q->camera[c];
        n += to[c] * to[c];
    }
    n = sqrt(n);
    for (int c = 0; c < 3; c++)
        to[c] = n < 0x1p-20 ? (c == 2) : to[c] / n;
}

static inline void ref_rotation(const double *y, double *to)
{
    const double n = sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3]);

    for (int c = 0; c < 4; c++)
        to[c] = n < 0x1p-20 ? (c == 0) : y[c] / n;
}

/* out: [K], each mean 3, scale 3, rotation 4, opacity, colour 3. base: the channels at which the
 * masks are evaluated as hard masks. */
static inline void ref_generate(const ref_query *q, const double *channel, const double *base,
                                const double *p, double (*out)[REF_OUT])
{
    const ted4_header *h = &q->head;
    const ref_channels at = ref_channels_of(h);
    const int f = h->feature_dim, k = h->n_offsets, n_full = f + (h->view == 2 ? 3 : 0);
    const double *w = q->net;
    double y[REF_WIDEST] = { 0 }, seen[REF_WIDEST], moved[REF_WIDEST], size[6];
    double opacity[REF_WIDEST], covariance[REF_WIDEST], colour[REF_WIDEST];
    double active = 1.0, moves = h->motion != TED4_MOTION_NONE;

    if (h->motion != TED4_MOTION_NONE)
        ref_motion(q, &w, channel + at.phi, p, y);
    if (h->temporal_mask)
        moves = ref_mask(channel[at.temporal_logit], base[at.temporal_logit]);
    for (int c = 0; c < f; c++) {
        seen[c] = channel[c];
        moved[c] = channel[c] + moves * y[3 + c];
    }
    ref_direction(q, p, seen + f);
    memcpy(moved + f, seen + f, 3 * sizeof *moved);
    ref_network(&w, n_full, h->head_layers, h->head_width, k, seen, opacity);
    ref_network(&w, n_full, h->head_layers, h->head_width, 7 * k, moved, covariance);
    ref_network(&w, f + (h->view > 0 ? 3 : 0), h->head_layers, h->head_width, 3 * k, seen, colour);
    if (h->activation && q->activation)
        active = ref_activation(q, channel + at.tau);
    for (int c = 0; c < 6; c++) {
        const double l = channel[at.scaling + c];

        size[c] = h->scale_domain == TED4_SCALE_LOG2 ? exp2(l) : fmax(l, 0x1p-20);
    }
    for (int i = 0; i < k; i++) {
        const double *offset = channel + at.offset + 3 * i;
        const double o = 2.0 * ref_sigmoid(2.0 * opacity[i]) - 1.0;
        const int logit = at.offset_logit + i;
        const double kept = h->offset_mask ? ref_mask(channel[logit], base[logit]) : 1.0;

        for (int c = 0; c < 3; c++) {
            out[i][c] = p[c] + moves * y[c] + offset[c] * size[c];
            out[i][3 + c] = size[3 + c] * ref_sigmoid(covariance[7 * i + c]);
            out[i][11 + c] = ref_sigmoid(colour[3 * i + c]);
        }
        ref_rotation(covariance + 7 * i + 3, out[i] + 6);
        out[i][10] = fmax(o, 0.0) * active * kept;
    }
}

#endif
