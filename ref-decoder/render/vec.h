/* vec.h - sixteen floats at once, in portable vector C: the lanes are Gaussians in project.c and pixels of a 4x4 block in blend.c.
 * Compilers without 512-bit registers split the operations themselves.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VEC_H
#define TED4_VEC_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Vectors are passed by value, but only to functions that are always inlined: how an ABI would pass them does not matter. */
#pragma GCC diagnostic ignored "-Wpsabi"
#define TED4_INLINE static inline __attribute__((always_inline))

enum { TED4_VEC = 16 };

typedef float    ted4_vf __attribute__((vector_size(64)));
typedef int32_t  ted4_vi __attribute__((vector_size(64)));      /* as a mask: -1 or 0 in each lane, as comparisons give it */
typedef uint32_t ted4_vu __attribute__((vector_size(64)));

/* x in every lane. */
TED4_INLINE ted4_vf ted4_vf_all(float x)
{
    return x - (ted4_vf){0};
}

TED4_INLINE ted4_vf ted4_vf_load(const float *p)
{
    ted4_vf v;

    memcpy(&v, p, sizeof v);
    return v;
}

TED4_INLINE void ted4_vf_store(float *p, ted4_vf v)
{
    memcpy(p, &v, sizeof v);
}

/* The first n <= TED4_VEC values; lanes after them are 0, or are not stored. */
TED4_INLINE ted4_vf ted4_vf_load_n(const float *p, size_t n)
{
    ted4_vf v = {0};

    if (n >= TED4_VEC)
        return ted4_vf_load(p);
    memcpy(&v, p, n * sizeof *p);
    return v;
}

TED4_INLINE void ted4_vf_store_n(float *p, ted4_vf v, size_t n)
{
    if (n >= TED4_VEC)
        ted4_vf_store(p, v);
    else
        memcpy(p, &v, n * sizeof *p);
}

/* m ? a : 0 and m ? a : b. */
TED4_INLINE ted4_vf ted4_vf_keep(ted4_vi m, ted4_vf a)
{
    return (ted4_vf)(m & (ted4_vi)a);
}

TED4_INLINE ted4_vf ted4_vf_select(ted4_vi m, ted4_vf a, ted4_vf b)
{
    return (ted4_vf)((m & (ted4_vi)a) | (~m & (ted4_vi)b));
}

/* b where they do not compare (NaN). */
TED4_INLINE ted4_vf ted4_vf_min(ted4_vf a, ted4_vf b)
{
    return ted4_vf_select(a < b, a, b);
}

TED4_INLINE ted4_vf ted4_vf_max(ted4_vf a, ted4_vf b)
{
    return ted4_vf_select(a > b, a, b);
}

TED4_INLINE ted4_vf ted4_vf_sqrt(ted4_vf x)
{
    float a[TED4_VEC];

    memcpy(a, &x, sizeof x);
    for (int i = 0; i < TED4_VEC; i++)
        a[i] = sqrtf(a[i]);
    memcpy(&x, a, sizeof x);
    return x;
}

/* Bit i of the result: lane i of the mask. */
TED4_INLINE uint32_t ted4_vi_bits(ted4_vi m)
{
    const ted4_vi bit = { 1 << 0, 1 << 1, 1 << 2, 1 << 3, 1 << 4, 1 << 5, 1 << 6, 1 << 7,
                          1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15 };
    ted4_vi x = m & bit;

    x |= __builtin_shufflevector(x, x, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7);
    x |= __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11);
    x |= __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
    x |= __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14);
    return (uint32_t)x[0];
}

/* 2^x for x in [-126, 127], relative error 5e-7 (measured on [-8, 0.2]); outside that range the value means
 * nothing. Polynomial: minimax on [-1/2, 1/2] with value 1 at 0, computed for this file by Remez exchange. */
TED4_INLINE ted4_vf ted4_vf_exp2(ted4_vf x)
{
    const float   magic = 12582912.0f;      /* 1.5 * 2^23: adding it leaves round(x) in the low bits */
    const ted4_vf t = x + magic;
    const ted4_vf f = x - (t - magic);
    ted4_vf       y = f * 0.00111255073f + 0.00966628268f;

    y = y * f + 0.0555740036f;
    y = y * f + 0.240223512f;
    y = y * f + 0.693142831f;
    y = y * f + 1.0f;
    return (ted4_vf)((ted4_vu)y + ((ted4_vu)t << 23));
}

/* log2(x) for normal x > 0, absolute error 4e-7 on [1/255, 1]; else the value means nothing. x = m 2^e with m in [sqrt(1/2), sqrt(2)), and
 * log2(m) = 2 / ln(2) artanh((m - 1) / (m + 1)) by its power series. */
TED4_INLINE ted4_vf ted4_vf_log2(ted4_vf x)
{
    const uint32_t half = 0x3f3504f3u;      /* bits of sqrt(1/2) */
    const ted4_vu  d = (ted4_vu)x - half;
    const ted4_vi  e = (ted4_vi)d >> 23;
    const ted4_vf  m = (ted4_vf)((d & 0x7fffffu) + half);
    const ted4_vf  s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
    ted4_vf        y = s2 * (float)(2.0 / 9 / 0.6931471805599453) + (float)(2.0 / 7 / 0.6931471805599453);

    y = y * s2 + (float)(2.0 / 5 / 0.6931471805599453);
    y = y * s2 + (float)(2.0 / 3 / 0.6931471805599453);
    y = y * s2 + (float)(2.0 / 1 / 0.6931471805599453);
    return y * s + __builtin_convertvector(e, ted4_vf);
}

#endif
