/* dense_product.c - the product of a dense layer and of its transpose (dense.h), which share one
 * kernel. The sums of a panel of outputs, for two registers of lanes, stay in registers while the
 * inputs stream by; each broadcast weight serves two fused multiply-adds. spec 7.1. Each output of
 * each lane is summed separately, input after input, so that the blocking does not change any bit.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/dense.h"
#include "render/vec.h"

/* The outputs of a panel. Twice as many sums, two registers of inputs and one weight fit in 32
 * registers (AVX-512, NEON) or in 16 (AVX2, SSE2). */
#if TED4_VEC_BYTES == 64 || defined(__aarch64__)
enum { PANEL = 12 };
#else
enum { PANEL = 6 };
#endif

/* The lanes that a panel processes at once. */
enum { SPAN = 2 * TED4_VEC };

/* All panels have nearly the same width, so that none is too narrow to hide the latency of its
 * sums. */
static int n_panels(int out)
{
    return (out + PANEL - 1) / PANEL;
}

static int panel_width(int out, int panel)
{
    const int n = n_panels(out);

    return out / n + (panel < out % n);
}

/* Packs a layer panel by panel: the biases of the panel's outputs, then, for each input, the
 * weights of the panel's outputs. step_out and step_in are the strides of w. If b is NULL, the
 * biases are 0. */
static void pack(int in, int out, const float *w, size_t step_out, size_t step_in, const float *b,
                 float *to)
{
    for (int p = 0, o = 0; p < n_panels(out); p++) {
        const int width = panel_width(out, p);

        for (int j = 0; j < width; j++)
            *to++ = b != NULL ? b[o + j] : 0.0f;
        for (int i = 0; i < in; i++)
            for (int j = 0; j < width; j++)
                *to++ = w[(size_t)(o + j) * step_out + (size_t)i * step_in];
        o += width;
    }
}

void TED4_LEVELED(ted4_dense_pack)(ted4_dense *d, const float *w, const float *b)
{
    pack(d->in, d->out, w, (size_t)d->in, 1, b, d->fwd);
    pack(d->out, d->in, w, 1, (size_t)d->in, NULL, d->bwd);
}

typedef enum { SET, SET_RELU, ADD } store_mode;

TED4_INLINE void store(float *y, ted4_vf sum, store_mode mode)
{
    if (mode == ADD)
        sum = ted4_vf_load(y) + sum;
    else if (mode == SET_RELU)
        sum = ted4_vf_keep(sum > 0.0f, sum);
    ted4_vf_store(y, sum);
}

/* Computes n outputs for SPAN lanes. */
TED4_INLINE void panel_n(const int n, int in, const float *w, const float *x, float *y,
                         store_mode mode)
{
    ted4_vf acc[PANEL][2];

    TED4_UNROLL
    for (int j = 0; j < n; j++)
        acc[j][0] = acc[j][1] = ted4_vf_all(w[j]);
    w += n;
    for (int i = 0; i < in; i++, w += n) {
        const ted4_vf x0 = ted4_vf_load(x + (size_t)i * TED4_LANES);
        const ted4_vf x1 = ted4_vf_load(x + (size_t)i * TED4_LANES + TED4_VEC);

        TED4_UNROLL
        for (int j = 0; j < n; j++) {
            const ted4_vf weight = ted4_vf_all(w[j]);

            acc[j][0] = ted4_vf_fma(weight, x0, acc[j][0]);
            acc[j][1] = ted4_vf_fma(weight, x1, acc[j][1]);
        }
    }
    TED4_UNROLL
    for (int j = 0; j < n; j++) {
        store(y + j * TED4_LANES, acc[j][0], mode);
        store(y + j * TED4_LANES + TED4_VEC, acc[j][1], mode);
    }
}

static void panel(int n, int in, const float *w, const float *x, float *y, store_mode mode)
{
    switch (n) {
    case 1: panel_n(1, in, w, x, y, mode); break;
    case 2: panel_n(2, in, w, x, y, mode); break;
    case 3: panel_n(3, in, w, x, y, mode); break;
    case 4: panel_n(4, in, w, x, y, mode); break;
    case 5: panel_n(5, in, w, x, y, mode); break;
#if TED4_VEC_BYTES == 64 || defined(__aarch64__)
    case 6: panel_n(6, in, w, x, y, mode); break;
    case 7: panel_n(7, in, w, x, y, mode); break;
    case 8: panel_n(8, in, w, x, y, mode); break;
    case 9: panel_n(9, in, w, x, y, mode); break;
    case 10: panel_n(10, in, w, x, y, mode); break;
    case 11: panel_n(11, in, w, x, y, mode); break;
#endif
    default: panel_n(PANEL, in, w, x, y, mode); break;
    }
}

static void product(int in, int out, const float *w, const float *x, float *y, store_mode mode)
{
    for (int p = 0; p < n_panels(out); p++) {
        const int width = panel_width(out, p);

        for (int lane = 0; lane < TED4_LANES; lane += SPAN)
            panel(width, in, w, x + lane, y + lane, mode);
        w += (size_t)width * ((size_t)in + 1);
        y += (size_t)width * TED4_LANES;
    }
}

void TED4_LEVELED(ted4_dense_forward)(const ted4_dense *d, const float *x, float *y, int relu)
{
    product(d->in, d->out, d->fwd, x, y, relu ? SET_RELU : SET);
}

void TED4_LEVELED(ted4_dense_backward_x)(const ted4_dense *d, const float *dy, float *dx, int add)
{
    product(d->out, d->in, d->bwd, dy, dx, add ? ADD : SET);
}
