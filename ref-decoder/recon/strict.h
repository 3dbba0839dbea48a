/* strict.h - the arithmetic of class X (spec 12.2): pow2, sigmoid and the plain dense layer.
 * Every operation is one binary32 operation, so files that include this header are compiled without
 * contraction. Anchors are processed in blocks of 32: a row holds one value per anchor, a block is
 * [channel][32]. Vector loops run over lanes, never over the terms of a sum, so that they give the
 * same bits as the scalar definition. Depends on base/bytes.h, kernel/strict_dense.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STRICT_H
#define TED4_STRICT_H

#include <math.h>
#include <stdint.h>
#include "base/bytes.h"
#include "kernel/strict_dense.h"

enum { TED4_ROW = 32 }; /* lanes of a row */

#define TED4_LOG2E 0x1.715476p+0f

/* spec 12.2: the coefficients of the polynomial of pow2; TED4_POW2_Cn belongs to the power n. */
#define TED4_POW2_C1 0x1.62e43p-1f
#define TED4_POW2_C2 0x1.ebfbep-3f
#define TED4_POW2_C3 0x1.c6b08ep-5f
#define TED4_POW2_C4 0x1.3b2ab6p-7f
#define TED4_POW2_C5 0x1.5d87fep-10f
#define TED4_POW2_C6 0x1.430912p-13f
#define TED4_POW2_C7 0x1.ffcbfcp-17f

/* max of spec 12.2. Returns b unless a > b, so that a NaN in b is returned. */
static inline float ted4_max(float a, float b)
{
    return a > b ? a : b;
}

/* pow2 of spec 12.2. floor() is computed by a conversion and a correction, because every machine
 * has vector instructions for conversions but not for floorf(). */
static inline float ted4_pow2(float x)
{
    const float low = x > -126.0f ? x : -126.0f; /* also of a NaN, which cannot be converted */
    const float y = low < 126.0f ? low : 126.0f;
    const float v = y + 0.5f;
    const int32_t cut = (int32_t)v;
    const int32_t n = cut - ((float)cut > v);
    const float f = y - (float)n;
    float p = TED4_POW2_C7;

    p = p * f + TED4_POW2_C6;
    p = p * f + TED4_POW2_C5;
    p = p * f + TED4_POW2_C4;
    p = p * f + TED4_POW2_C3;
    p = p * f + TED4_POW2_C2;
    p = p * f + TED4_POW2_C1;
    p = p * f + 1.0f;
    p = p * ted4_bits_float((uint32_t)(n + 127) << 23);
    return x == x ? p : x;
}

/* sigmoid of spec 11.5. */
static inline float ted4_sigmoid(float x)
{
    return 1.0f / (1.0f + ted4_pow2(-x * TED4_LOG2E));
}

/* The ted4_strict_dense_fn that runs on any machine. */
void ted4_strict_dense_plain(const ted4_strict_layer *l, const float *x, float *y);

/* probe.c: returns 1 if this process, in its present floating-point environment, rounds as spec
 * 12.2 requires, else 0. */
int ted4_strict_ok(void);

#endif
