/* init.c - sets the first values of anchors and networks (init.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "init.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/math/voxel_set.h"
#include "math/compare.h"
#include "math/elementary.h"
#include "train/math/random.h"
#include "normalise.h"

/* Returns the mean distance from point i to its three nearest neighbours among the n points. */
static float neighbour_distance(const float *p, size_t n, size_t i)
{
    float best[3] = { 1e30f, 1e30f, 1e30f };

    for (size_t k = 0; k < n; k++) {
        const float x = p[3 * k] - p[3 * i], y = p[3 * k + 1] - p[3 * i + 1],
                    z = p[3 * k + 2] - p[3 * i + 2];
        const float d = x * x + y * y + z * z;

        if (k == i || d >= best[2])
            continue;
        best[2] = d;
        for (int b = 2; b > 0 && best[b] < best[b - 1]; b--) {
            const float t = best[b];

            best[b] = best[b - 1];
            best[b - 1] = t;
        }
    }

    const int found = n > 3 ? 3 : n > 1 ? (int)n - 1 : 0;
    float sum = 0;

    for (int b = 0; b < found; b++)
        sum += sqrtf(best[b]);
    return found > 0 ? sum / (float)found : 0.05f;
}

/* Returns the median neighbour distance of a sample of the points. */
static double typical_distance(const float *p, size_t n)
{
    enum { SAMPLE = 500 };
    float d[SAMPLE];
    const size_t m = n < SAMPLE ? n : SAMPLE;

    for (size_t i = 0; i < m; i++)
        d[i] = neighbour_distance(p, n, i * n / m);
    qsort(d, m, sizeof d[0], ted4_compare_floats);
    return m > 0 ? fmax((double)d[m / 2], 1e-4) : 0.01;
}

/* Writes the points inside [-1, 1] to out, at most one per voxel, rounded to multiples of the
 * voxel's edge. out has room for n points. Returns how many were written. */
static size_t voxelise(const float *p, size_t n, double voxel, float *out, ted4_voxel_set *set)
{
    size_t m = 0;

    ted4_voxel_set_clear(set);
    for (size_t i = 0; i < n; i++) {
        float q[3];
        int inside = 1;

        for (int j = 0; j < 3; j++) {
            q[j] = (float)(rint((double)p[3 * i + (size_t)j] / voxel) * voxel);
            inside &= fabsf(q[j]) <= 1.0f;
        }
        if (!inside || !ted4_voxel_set_add(set, ted4_voxel_key(q, voxel)))
            continue;
        memcpy(out + 3 * m++, q, sizeof q);
    }
    return m;
}

typedef struct {
    ted4_anchors *a;
    const ted4_layout *l;
    const float *p;
    size_t n;
} fill_job;

/* Temporal features begin as waves over space, so that neighbours move together and the decoder
 * can distinguish places from the first step on: with equal features, all anchors could only move
 * as one. The wavelengths range from the whole scene to a sixteenth of it. */
#define PHI_AMPLITUDE 0.5f

static void fill_phi(fill_job *f, size_t i)
{
    const ted4_layout *l = f->l;

    for (int c = 0; c < l->head.phi_dim; c++) {
        const uint64_t key = ted4_mix(0x706869u + (uint64_t)c);
        const float turns = ted4_math_exp2f(4.0f * ted4_uniform(key, 0));
        float phase = ted4_uniform(key, 1), w[3], norm = 1e-6f;

        for (uint64_t j = 0; j < 3; j++) {
            w[j] = 2.0f * ted4_uniform(key, 2 + j) - 1.0f;
            norm += w[j] * w[j];
        }
        for (int j = 0; j < 3; j++)
            phase += 0.5f * turns * w[j] / sqrtf(norm) *
                     *ted4_anchor_value(f->a, TED4_ROW_POSITION, i, j);
        *ted4_anchor_value(f->a, TED4_ROW_VALUE, i, l->first[TED4_PHI] + c) =
            PHI_AMPLITUDE * ted4_math_sinf(6.2831853f * phase);
    }
}

static void fill_anchor(fill_job *f, size_t i)
{
    const ted4_layout *l = f->l;
    const float d = fmaxf(neighbour_distance(f->p, f->n, i), 1e-5f);

    for (int j = 0; j < 3; j++)
        *ted4_anchor_value(f->a, TED4_ROW_POSITION, i, j) = f->p[3 * i + (size_t)j];
    for (int j = 0; j < 6; j++)
        *ted4_anchor_value(f->a, TED4_ROW_VALUE, i, l->first[TED4_SCALING] + j) =
            ted4_math_log2f(d);
    fill_phi(f, i);
    if (l->first[TED4_TAU] >= 0) {
        const float tau[4] = { 0.0f, -3.3f, 1.0f, -3.3f }; /* b = 0.1 */

        for (int j = 0; j < 4; j++)
            *ted4_anchor_value(f->a, TED4_ROW_VALUE, i, l->first[TED4_TAU] + j) = tau[j];
    }
    for (int k = 0; k < l->head.n_offsets; k++)
        *ted4_anchor_value(f->a, TED4_ROW_VALUE, i, l->offset_logit + k) = 1.0f;
    *ted4_anchor_value(f->a, TED4_ROW_VALUE, i, l->temporal_logit) = 1.0f;
}

int ted4_init_anchors(ted4_anchors *a, const ted4_layout *l, const ted4_dataset *d, size_t most,
                      double cell, double *voxel)
{
    float *p = malloc((d->n_points + 1) * 3 * sizeof *p);
    float *out = malloc((d->n_points + 1) * 3 * sizeof *out);
    ted4_voxel_set set;
    int bad = p == NULL || out == NULL || ted4_voxel_set_init(&set, d->n_points) != 0;
    size_t n = 0;

    if (!bad) {
        for (size_t i = 0; i < d->n_points; i++)
            ted4_normalise_point(&l->head, d->points + 3 * i, p + 3 * i);
        *voxel = cell > 0 ? fmax(ldexp(cell, -l->head.exponent), TED4_FINEST_VOXEL)
                          : typical_distance(p, d->n_points);
        while ((n = voxelise(p, d->n_points, *voxel, out, &set)) > most)
            *voxel *= 1.1;
        ted4_voxel_set_finish(&set);
        bad = ted4_anchors_resize(a, n) != 0;
    }

    fill_job f = { a, l, out, n };

    for (size_t i = 0; !bad && i < n; i++)
        fill_anchor(&f, i);
    free(p);
    free(out);
    return bad || ted4_anchors_sort(a, NULL) != 0 ? -1 : 0;
}

static void init_layer(float *w, unsigned in, unsigned out, float gain, uint64_t key,
                       uint64_t *counter)
{
    const float range = in > 0 ? gain / sqrtf((float)in) : 0.0f;

    for (size_t i = 0; i < (size_t)in * out; i++)
        w[i] = range * (2.0f * ted4_uniform(key, (*counter)++) - 1.0f);
    for (size_t i = 0; i < out; i++)
        w[(size_t)in * out + i] = range * (2.0f * ted4_uniform(key, (*counter)++) - 1.0f);
}

/* last: gain of the last layer, or 0 to leave its weights at zero. */
static void init_network(float *blob, const ted4_net_shape *s, float last, uint64_t key,
                         uint64_t *counter)
{
    float *w = blob + s->first;

    for (int i = 0; i < s->n_layers; i++) {
        init_layer(w, s->dim[i], s->dim[i + 1], i + 1 < s->n_layers ? 1.0f : last, key, counter);
        w += ted4_layer_size(s, (unsigned)i);
    }
}

static void negate(float *x, size_t n)
{
    for (size_t i = 0; i < n; i++)
        x[i] = -x[i];
}

/* Negates those outputs of the opacity head that are negative for features of zero, where features
 * begin. The Gaussian of a negative output is not drawn, gets no gradient and stays dead in every
 * anchor. On average this would affect half of the outputs, and the number would depend on the
 * seed. */
static void wake(float *blob, const ted4_net_shape *s)
{
    float x[TED4_MAX_WIDTH] = { 0 }, y[TED4_MAX_WIDTH];
    float *w = blob + s->first;

    for (int i = 0; i < s->n_layers; i++) {
        const size_t in = s->dim[i], out = s->dim[i + 1];
        float *const bias = w + in * out;

        for (size_t k = 0; k < out; k++) {
            y[k] = bias[k];
            for (size_t c = 0; c < in; c++)
                y[k] += w[k * in + c] * x[c];
            if (i + 1 == s->n_layers && y[k] < 0) {
                negate(w + k * in, in);
                negate(bias + k, 1);
            }
            y[k] = fmaxf(y[k], 0.0f);
        }
        memcpy(x, y, out * sizeof *x);
        w = bias + out;
    }
}

void ted4_init_networks(float *net, const ted4_layout *l, uint32_t seed)
{
    const uint64_t key = ted4_mix(seed ^ 0x6e657477u);
    uint64_t counter = 0;

    memset(net, 0, l->n_net * sizeof *net);
    for (int i = 0; i < TED4_NETS_R; i++)
        init_network(net + l->netr, &l->shape.netr[i], i == TED4_NET_DEFORM ? 0.0f : 1.0f, key,
                     &counter);
    wake(net + l->netr, &l->shape.netr[TED4_NET_OPACITY]);
    /* N(0, 0.1) as a sum of four uniforms of variance 1/12 each. */
    for (size_t i = 0; i < l->shape.n_bank; i++) {
        float sum = -2.0f;

        for (int k = 0; k < 4; k++)
            sum += ted4_uniform(key, counter++);
        net[l->bank + i] = 0.1f * sum * 1.7320508f;
    }
}

/* Computes the mean and the standard deviation of one component over all anchors. */
static void component_moments(const ted4_anchors *a, int channel, double *mean, double *spread)
{
    double sum = 0, square = 0;

    for (size_t i = 0; i < a->n; i++) {
        const double x = (double)*ted4_anchor_value(a, TED4_ROW_VALUE, i, channel);

        sum += x;
        square += x * x;
    }
    const double n = a->n > 0 ? (double)a->n : 1.0;

    *mean = sum / n;
    *spread = sqrt(fmax(square / n - *mean * *mean, 0.0));
}

/* Returns the biases of the hyperprior's last layer. *weights: the weights of that layer,
 * [outputs][*in]. */
static float *last_biases(float *net, const ted4_layout *l, float **weights, unsigned *in)
{
    const ted4_net_shape *s = &l->shape.hyper;
    const int last = s->n_layers - 1;
    float *at = net + l->nete + s->first;

    for (int i = 0; i < last; i++)
        at += ted4_layer_size(s, (unsigned)i);
    *weights = at;
    *in = s->dim[last];
    return at + ted4_layer_weights(s, (unsigned)last);
}

/* Sets the biases of one type so that the hyperprior predicts the mean and the spread of the
 * anchors' values. */
static void init_biases(float *bias, const ted4_layout *l, const ted4_anchors *a, int t)
{
    const ted4_shape *s = &l->shape;

    for (unsigned c = 0; c < s->dim[t]; c++) {
        const double q = (double)l->head.step[t];
        double mean, spread;

        component_moments(a, l->first[t] + (int)c, &mean, &spread);
        bias[s->first_output[t] + c] = (float)(mean / q);
        bias[s->first_output[t] + s->dim[t] + c] =
            (float)fmin(fmax(ted4_math_log2(fmax(spread / q, 1e-3)), -1.0), 9.0);
    }
}

void ted4_init_prior(float *net, const ted4_layout *l, const ted4_anchors *a, uint32_t seed)
{
    const ted4_shape *s = &l->shape;
    const uint64_t key = ted4_mix(seed ^ 0x7072696fu);
    uint64_t counter = 0;
    float *nete = net + l->nete, *weights;
    unsigned in;

    memset(nete, 0, s->n_nete * sizeof *nete);
    init_network(nete, &s->hyper, 0.1f, key, &counter);
    for (unsigned m = 1; m < l->head.n_slices; m++)
        init_network(nete, &s->slice[m], 0.1f, key, &counter);

    float *const bias = last_biases(net, l, &weights, &in);

    for (int t = 0; t < TED4_TYPES; t++)
        init_biases(bias, l, a, t);
    for (unsigned t = 0; t < s->n_types; t++)
        bias[s->first_step_output + t] = 0.0f;
}

void ted4_init_prior_type(float *net, const ted4_layout *l, const ted4_anchors *a, int type)
{
    const ted4_shape *s = &l->shape;
    float *weights;
    unsigned in, step = s->first_step_output;
    float *const bias = last_biases(net, l, &weights, &in);

    for (int t = 0; t < type; t++)
        step += s->dim[t] > 0;
    memset(weights + (size_t)s->first_output[type] * in, 0,
           (size_t)2 * s->dim[type] * in * sizeof *weights);
    memset(weights + (size_t)step * in, 0, in * sizeof *weights);
    init_biases(bias, l, a, type);
    bias[step] = 0.0f;
}
