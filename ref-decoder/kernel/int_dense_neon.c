/* int_dense_neon.c - the variant of norm/int_dense.c for NEON. It processes eight anchors and eight
 * output units at a time; a vector holds the weights of one unit for eight channels. R-NET-006
 * keeps every partial sum in 32 bits. SPDX-License-Identifier: BSD-2-Clause */
#if defined(__AARCH64EL__)

#include <arm_neon.h>
#include "kernel/int_kernel.h"

enum { ROW = TED4_PRIOR_BLOCK, GROUP = 8, UNITS = 8 };

/* The sums of four anchors, and of the next four. */
typedef struct {
    int32x4_t lo, hi;
} pair;

/* Adds channel c of the eight channels whose weights are in w. */
#define TED4_CHANNEL(c)                                                        \
    do {                                                                       \
        const int16x8_t in = vld1q_s16(row + (c)*ROW);                         \
                                                                               \
        for (int j = 0; j < UNITS; j++) {                                      \
            sum[j].lo = vmlal_laneq_s16(sum[j].lo, vget_low_s16(in), w[j], c); \
            sum[j].hi = vmlal_high_laneq_s16(sum[j].hi, in, w[j], c);          \
        }                                                                      \
    } while (0)

/* Computes UNITS output units from o on for eight anchors. At the end of a layer, the last unit is
 * computed several times. Sets unit[UNITS] to the indices of the units, and y[UNITS] to their
 * outputs. */
static void units(const ted4_int_layer *l, const int16_t *x, unsigned o, unsigned *unit, pair *y)
{
    const int16_t *row = x, *at[UNITS];
    pair sum[UNITS];
    unsigned i = 0;

    for (int j = 0; j < UNITS; j++) {
        unit[j] = o + (unsigned)j < l->out ? o + (unsigned)j : l->out - 1;
        at[j] = l->w + (size_t)unit[j] * l->in_pad;
        sum[j].lo = sum[j].hi = vdupq_n_s32(l->b[unit[j]]);
    }
    for (; i + 8 <= l->in; i += 8, row += 8 * ROW) {
        int16x8_t w[UNITS];

        for (int j = 0; j < UNITS; j++)
            w[j] = vld1q_s16(at[j] + i);
        TED4_CHANNEL(0);
        TED4_CHANNEL(1);
        TED4_CHANNEL(2);
        TED4_CHANNEL(3);
        TED4_CHANNEL(4);
        TED4_CHANNEL(5);
        TED4_CHANNEL(6);
        TED4_CHANNEL(7);
    }
    for (; i < l->in; i++, row += ROW) {
        const int16x8_t in = vld1q_s16(row);

        for (int j = 0; j < UNITS; j++) {
            sum[j].lo = vmlal_n_s16(sum[j].lo, vget_low_s16(in), at[j][i]);
            sum[j].hi = vmlal_high_n_s16(sum[j].hi, in, at[j][i]);
        }
    }
    for (int j = 0; j < UNITS; j++) {
        const int32x4_t r = vdupq_n_s32(-(int32_t)l->r[unit[j]]);

        y[j].lo = vrshlq_s32(sum[j].lo, r);
        y[j].hi = vrshlq_s32(sum[j].hi, r);
    }
}

static void hidden(const ted4_int_layer *l, const int16_t *x, size_t n, int16_t *y)
{
    pair sum[UNITS];
    unsigned unit[UNITS];

    for (size_t a = 0; a < n; a += GROUP)
        for (unsigned o = 0; o < l->out; o += UNITS) {
            units(l, x + a, o, unit, sum);
            for (int j = 0; j < UNITS; j++) {
                const int16x8_t v = vcombine_s16(vqmovn_s32(sum[j].lo), vqmovn_s32(sum[j].hi));

                vst1q_s16(y + (size_t)unit[j] * ROW + a, vmaxq_s16(v, vdupq_n_s16(0)));
            }
        }
}

static void last(const ted4_int_layer *l, const int16_t *x, size_t n, int32_t *y)
{
    const int32x4_t most = vdupq_n_s32(TED4_OUTPUT_MAX), least = vdupq_n_s32(-TED4_OUTPUT_MAX);
    pair sum[UNITS];
    unsigned unit[UNITS];

    for (size_t a = 0; a < n; a += GROUP)
        for (unsigned o = 0; o < l->out; o += UNITS) {
            units(l, x + a, o, unit, sum);
            for (int j = 0; j < UNITS; j++) {
                int32_t *to = y + (size_t)unit[j] * ROW + a;

                vst1q_s32(to, vmaxq_s32(vminq_s32(sum[j].lo, most), least));
                vst1q_s32(to + 4, vmaxq_s32(vminq_s32(sum[j].hi, most), least));
            }
        }
}

const ted4_int_dense ted4_int_dense_neon = { hidden, last };

#else
typedef int ted4_int_dense_neon_is_for_aarch64;
#endif
