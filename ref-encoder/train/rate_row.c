/* rate_row.c - bits of 32 symbols of one component and their derivatives: a smooth model of the alphabet of spec 9.4.
 *
 * With a = |k - mu| steps, sigma = 2^s steps, eps = 2^-16, and w = min(6 sigma, 4095) + 2 half the width of the window:
 *     bits = -log2 P,  P = (1 - 2 w eps) p + eps h
 *     p    = Phi((a + 1/2) / sigma) - Phi((a - 1/2) / sigma)
 *     h    = 1 / (1 + a / w)                for a < w:  the slot that every symbol has
 *          = 1 / (2 (1 + a - w)^2)          beyond:     an escape, 16 + 1 + 2 log2(1 + excess) bits
 * h stands where a coder has the constant 1. It costs at most one bit, only where the floor rules, and it has a slope everywhere: an outlier is pulled back,
 * and its sigma pushed up, however far out it lies. A constant floor would leave it without gradient (algorithm facts 5.8, item 4).
 * Used by rate.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rate_parts.h"

#include "rate_math.h"

#define SLOT            0x1p-16f        /* eps */
#define MAX_HALF_WINDOW 4095.0f
#define MAX_DISTANCE    1e9f            /* keeps squares finite; the slope stays right */

/* Probability p of the bin [a - 1/2, a + 1/2] / sigma and its derivatives; no differences of nearly equal numbers anywhere. */
typedef struct {
    float p, d_a, d_ln_sigma;
} bin;

/* Midpoint m and half width h of the bin in sigmas. With the densities at its ends, C is half their sum and S half their difference. */
static inline bin bin_make(float a, float inv_sigma)
{
    const float m = a * inv_sigma, h = 0.5f * inv_sigma;
    const float low = m - h, high = m + h, width = 2.0f * h, mh = m * h;
    const float f_low = ted4_lane_normal(low), f_high = ted4_lane_normal(high);
    const float C = 0.5f * (f_low + f_high);
    const float S = mh < 0.3f ? C * ted4_lane_tanh_small(mh)
                              : 0.5f * (f_low - f_high);
    const float q_low = f_low * ted4_lane_mills(low < 0.0f ? -low : low);
    const float q_high = f_high * ted4_lane_mills(high);
    const float tails = low < 0.0f ? 1.0f - (q_low + q_high) : q_low - q_high;
    /* Euler-Maclaurin for narrow bins: trapezium, first and third derivative. */
    const float d1 = width * C - 2.0f * m * S;
    const float d3 = (6.0f * m * m * h + 2.0f * h * h * h - 6.0f * h) * C
                   - (2.0f * m * m * m + 6.0f * m * h * h - 6.0f * m) * S;
    const float ww = width * width;
    const float narrow = width * C + ww * (1.0f / 12.0f) * d1
                       - ww * ww * (1.0f / 720.0f) * d3;
    const float p = inv_sigma < 0.25f ? narrow : tails;
    const bin b = { p > 0.0f ? p : 0.0f, -2.0f * S * inv_sigma, -d1 };

    return b;
}

/* spec 9.4; see the head of this file. u = k - mu. d_u and d_s are derivatives of bits. */
void ted4_rate_row(const float *restrict u, const float *restrict s,
                   float *restrict bits, float *restrict d_u,
                   float *restrict d_s)
{
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float log_sigma = ted4_lane_limit(s[j], TED4_S_MIN, TED4_S_MAX);
        const float sigma = ted4_lane_pow2(log_sigma);
        const float abs_u = u[j] < 0.0f ? -u[j] : u[j];
        const float a = abs_u < MAX_DISTANCE ? abs_u : MAX_DISTANCE;
        const bin b = bin_make(a, 1.0f / sigma);
        const float six = 6.0f * sigma;
        const float w = (six < MAX_HALF_WINDOW ? six : MAX_HALF_WINDOW) + 2.0f;
        const float dw = six < MAX_HALF_WINDOW ? six : 0.0f; /* by ln sigma */
        const float e = a > w ? 1.0f + (a - w) : 1.0f;
        const float h = 1.0f / ((a < w ? 1.0f + a / w : 2.0f) * e * e);
        const float dh_da = a < w ? -h * h / w : -2.0f * h / e;
        const float dh_dw = a < w ? h * h * a / (w * w) : 2.0f * h / e;
        const float scale = 1.0f - 2.0f * w * SLOT;
        const float P = scale * b.p + SLOT * h;
        const float g = -1.0f / (P * TED4_LN2);
        const float d_a = g * (scale * b.d_a + SLOT * dh_da);

        bits[j] = -ted4_lane_log2(P);
        d_u[j] = u[j] < 0.0f ? -d_a : d_a;
        d_s[j] = g * TED4_LN2 * (scale * b.d_ln_sigma
               + SLOT * dw * (dh_dw - 2.0f * b.p));
    }
}
