/* rate_row.c - bits of 32 symbols of one component, and their derivatives: a smooth model of the
 * alphabet of spec 9.4.
 *
 * With a = |k - mu| steps, sigma = 2^s steps, eps = 2^-16, and w = min(6 sigma, 4095) + 2, which is
 * half the width of the window:
 *     bits = -log2 P,  P = (1 - 2 w eps) p + eps h
 *     for a < w: p = Phi((a + 1/2) / sigma) - Phi((a - 1/2) / sigma)    the symbol's share
 *                h = 1 / (1 + a / w)                                    the slot that every symbol
 *                                                                       has
 *     beyond:    p = h (1 - Phi((w - 3/2) / sigma))                     the tail, which belongs to
 *                                                                       the escape, if 4095 narrows
 *                                                                       the window
 *                h = 1 / (2 (1 + a - w)^2)                              1 + 2 log2(1 + excess) bits
 *                                                                       after the escape
 * For a < w, a coder has the constant 1 instead of h. The difference is at most one bit, and only
 * where the floor dominates. But h has a slope everywhere: an outlier is pulled back, and its sigma
 * is pushed up, at any distance. A constant floor would leave it without gradient (annex D.1,
 * traps).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rate_lanes.h"

#define SLOT            0x1p-16f /* eps */
#define MAX_HALF_WINDOW 4095.0f
/* Width of a bin, in sigmas, below which a series is used; at this width, both formulas are correct
 * to 1e-5. */
#define NARROW          0.0625f
#define MAX_DISTANCE    1e9f /* keeps squares finite; the slope stays correct */

/* Probability p of the bin [a - 1/2, a + 1/2] / sigma, and its derivatives. They are computed
 * without any difference of nearly equal numbers. */
typedef struct {
    float p, d_a, d_ln_sigma;
} bin;

/* m and h are the midpoint and half the width of the bin, in sigmas. C is half the sum of the
 * densities at its ends, and S half their difference. */
static inline bin bin_make(float a, float inv_sigma)
{
    const float m = a * inv_sigma, h = 0.5f * inv_sigma;
    const float low = m - h, high = m + h, width = 2.0f * h, mh = m * h;
    const float f_low = ted4_lane_normal(low), f_high = ted4_lane_normal(high);
    const float C = 0.5f * (f_low + f_high);
    const float S = mh < 0.3f ? C * ted4_lane_tanh_small(mh) : 0.5f * (f_low - f_high);
    const float y_low = 1.0f + 0.25f * (low < 0.0f ? -low : low);
    const float y_high = 1.0f + 0.25f * high, y = 1.0f / (y_low * y_high);
    const float q_low = f_low * ted4_lane_mills(y * y_high);
    const float q_high = f_high * ted4_lane_mills(y * y_low);
    const float tails = low < 0.0f ? 1.0f - (q_low + q_high) : q_low - q_high;
    /* Narrow bins, Euler-Maclaurin: the trapezium and the first derivative. */
    const float d1 = width * C - 2.0f * m * S;
    const float narrow = width * C + width * width * (1.0f / 12.0f) * d1;
    const float p = inv_sigma < NARROW ? narrow : tails;
    const bin b = { p > 0.0f ? p : 0.0f, -2.0f * S * inv_sigma, -d1 };

    return b;
}

/* Computes the bins of a row. This is a separate loop so that both vectors of a row are in flight
 * at the same time, because latency limits the speed. */
static void bins(const float *restrict a, const float *restrict sigma, float *restrict p,
                 float *restrict d_a, float *restrict d_ln_sigma)
{
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const bin b = bin_make(a[j], 1.0f / sigma[j]);

        p[j] = b.p;
        d_a[j] = b.d_a;
        d_ln_sigma[j] = b.d_ln_sigma;
    }
}

/* Returns the share of one tail beyond a window's half width w. *d_ln_sigma receives its derivative
 * with respect to ln sigma, which is taken as 0 if w varies with sigma. */
static inline float tail_make(float w, float sigma, int fixed, float *d_ln_sigma)
{
    const float t = (w - 1.5f) / sigma, f = ted4_lane_normal(t);

    *d_ln_sigma = fixed ? f * t : 0.0f;
    return f * ted4_lane_mills(1.0f / (1.0f + 0.25f * t));
}

/* spec 9.4; see the head of this file. u = k - mu. d_u and d_s receive the derivatives of bits. */
void TED4_LEVELED(ted4_rate_row)(const float *restrict u, const float *restrict s,
                                 float *restrict bits, float *restrict d_u, float *restrict d_s)
{
    float a[TED4_LANES], sigma[TED4_LANES], p[TED4_LANES], dp_da[TED4_LANES], dp_ds[TED4_LANES];

#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float abs_u = u[j] < 0.0f ? -u[j] : u[j];

        a[j] = abs_u < MAX_DISTANCE ? abs_u : MAX_DISTANCE;
        sigma[j] = ted4_lane_pow2(ted4_lane_limit(s[j], TED4_S_MIN, TED4_S_MAX));
    }
    bins(a, sigma, p, dp_da, dp_ds);
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float six = 6.0f * sigma[j];
        const int fixed = six >= MAX_HALF_WINDOW;
        const float w = (fixed ? MAX_HALF_WINDOW : six) + 2.0f;
        const float dw = fixed ? 0.0f : six; /* with respect to ln sigma */
        const float e = a[j] > w ? 1.0f + (a[j] - w) : 1.0f;
        const float y = a[j] < w ? w + a[j] : 2.0f * w; /* h = w / (y e^2) */
        const float r = 1.0f / (y * e);
        const float h = w * r * r * y;
        const float dh_da = a[j] < w ? -w * r * r : -2.0f * h * r * y;
        const float dh_dw = a[j] < w ? a[j] * r * r : 2.0f * h * r * y;
        float tail_ds;
        const float tail = tail_make(w, sigma[j], fixed, &tail_ds);
        const float share = a[j] < w ? p[j] : h * tail;
        const float share_da = a[j] < w ? dp_da[j] : dh_da * tail;
        const float share_ds = a[j] < w ? dp_ds[j] : h * tail_ds + dh_dw * dw * tail;
        const float scale = 1.0f - 2.0f * w * SLOT;
        const float P = scale * share + SLOT * h;
        const float g = -1.0f / (P * TED4_LN2);
        const float d_a = g * (scale * share_da + SLOT * dh_da);

        bits[j] = -ted4_lane_log2(P);
        d_u[j] = u[j] < 0.0f ? -d_a : d_a;
        d_s[j] = g * TED4_LN2 * (scale * share_ds + SLOT * dw * (dh_dw - 2.0f * share));
    }
}
