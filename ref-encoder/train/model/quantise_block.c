/* quantise_block.c - quantises an attribute block for rendering and for the rate, by noise or by
 * rounding (spec 10.4). Every value becomes k q with k = x / q + n. Noise and rounding differ only
 * in the residual n, so that both callers take it from here.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "model.h"
#include "train/math/lane_math.h"
#include "train/math/random.h"

#define MAX_SYMBOL 32767.0f /* spec 9.4, R-ENT-007 */

enum { TAU_START = 0, TAU_END = 2 }; /* components a_s and a_f of tau: spec 11.4 */

/* Fills a row with uniform noise in (-1/2, 1/2) whose mean is exactly 0. The noise is a hash of
 * (key, block, channel, lane), in 32-bit arithmetic within the row. */
static void noise_row(uint64_t key, uint32_t block, uint32_t channel, float *row)
{
    const uint64_t seed = ted4_mix_short(ted4_mix_short(key + 0x9e3779b97f4a7c15u) +
                                         ((uint64_t)block << 32 | channel));
    const uint32_t low = (uint32_t)seed, high = (uint32_t)(seed >> 32);

#pragma omp simd
    for (uint32_t j = 0; j < TED4_LANES; j++) {
        uint32_t h = low + j * 0x9e3779b9u;

        h = (h ^ (h >> 16)) * 0x7feb352du;
        h = (h ^ (h >> 15) ^ high) * 0x846ca68bu;
        h ^= h >> 16;
        row[j] = ((float)(int32_t)(h >> 9) + 0.5f) * 0x1p-23f - 0.5f;
    }
}

/* Returns the nearest integer, ties to even, clamped to the range of symbols. The limits are
 * integers, so that clamping before rounding gives the same as clamping after it. */
static inline float symbol(float scaled)
{
    return ted4_lane_round(scaled > MAX_SYMBOL    ? MAX_SYMBOL
                           : scaled < -MAX_SYMBOL ? -MAX_SYMBOL
                                                  : scaled);
}

static void rounding_row(const float *x, const float *q, float *row)
{
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++)
        row[j] = symbol(x[j] / q[j]) - x[j] / q[j];
}

/* R-ATT-001: where k(a_s) > k(a_f), a_f takes the symbol of a_s. */
static void order_tau(const float *tau, const float *q, float *residual)
{
    const float *start = tau + TAU_START * TED4_LANES;
    const float *end = tau + TAU_END * TED4_LANES;

    for (int j = 0; j < TED4_LANES; j++) {
        const float k = start[j] / q[j] + residual[TAU_START * TED4_LANES + j];
        float *n = &residual[TAU_END * TED4_LANES + j];

        if (k > end[j] / q[j] + *n)
            *n = k - end[j] / q[j];
    }
}

void TED4_LEVELED(ted4_residuals)(const ted4_layout *l, ted4_quant quant, const float *value,
                                  const float *steps, uint32_t block, uint64_t key, float *residual)
{
    for (int t = 0; t < TED4_TYPES; t++)
        for (unsigned c = 0; c < l->shape.dim[t]; c++) {
            const uint32_t channel = (uint32_t)l->first[t] + c;

            if (quant == TED4_QUANT_NOISE)
                noise_row(key, block, channel, residual + ted4_row_floats(channel));
            else
                rounding_row(value + ted4_row_floats(channel), steps + ted4_row_floats((size_t)t),
                             residual + ted4_row_floats(channel));
        }
    if (l->first[TED4_TAU] >= 0) {
        const size_t tau = ted4_row_floats((size_t)l->first[TED4_TAU]);

        order_tau(value + tau, steps + ted4_row_floats(TED4_TAU), residual + tau);
    }
}

static void quantise_row(ted4_quant quant, const float *x, const float *q, const float *noise,
                         float *out)
{
    if (quant == TED4_QUANT_NOISE) {
#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++)
            out[j] = x[j] + q[j] * noise[j];
        return;
    }
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++)
        out[j] = symbol(x[j] / q[j]) * q[j];
}

void TED4_LEVELED(ted4_quantise)(const ted4_layout *l, ted4_quant quant, const float *attr,
                                 const float *steps, uint32_t block, uint64_t key, float *out)
{
    for (int t = 0; t < TED4_TYPES; t++)
        for (unsigned c = 0; c < l->shape.dim[t]; c++) {
            const uint32_t channel = (uint32_t)l->first[t] + c;
            const size_t at = ted4_row_floats(channel);
            float noise[TED4_LANES];

            if (quant == TED4_QUANT_NOISE)
                noise_row(key, block, channel, noise);
            quantise_row(quant, attr + at, steps + ted4_row_floats((size_t)t), noise, out + at);
        }
    if (l->first[TED4_TAU] >= 0) {
        float *tau = out + ted4_row_floats((size_t)l->first[TED4_TAU]);

        for (int j = 0; j < TED4_LANES; j++) {
            const float start = tau[TAU_START * TED4_LANES + j];
            float *end = &tau[TAU_END * TED4_LANES + j];

            *end = start > *end ? start : *end;
        }
    }
    const size_t logits = ted4_row_floats((size_t)l->offset_logit);
    const size_t n = ted4_row_floats((size_t)l->n_channels) - logits;

    memcpy(out + logits, attr + logits, n * sizeof *out);
}
