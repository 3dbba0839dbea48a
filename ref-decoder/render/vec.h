/* vec.h - vector registers of 16, 8 or 4 floats, in portable vector C. Kernels work on groups of 16
 * lanes (Gaussians in project.c, pixels of a 4x4 block in blend.c), which are TED4_VECS registers.
 * The result of a lane does not depend on their number, and sums over lanes are always taken in the
 * same order. For files compiled once per level (leveled.h). Arithmetic uses the C operators;
 * functions exist for operations with an instruction that compilers would not use by themselves.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VEC_H
#define TED4_VEC_H

#include <math.h>
#include <stdint.h>
#include <string.h>
#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "render/leveled.h"

/* Vectors are passed by value, but only to functions that are always inlined, so the ABI's way of
 * passing them does not matter. */
#pragma GCC diagnostic ignored "-Wpsabi"
#define TED4_INLINE static inline __attribute__((always_inline))

/* Stands before a loop of at most 16 iterations whose vectors should stay in registers. */
#ifdef __clang__
#define TED4_UNROLL _Pragma("clang loop unroll(full)")
#else
#define TED4_UNROLL _Pragma("GCC unroll 16")
#endif

#if defined(__AVX512DQ__) && defined(__AVX512VL__)
#define TED4_VEC_BYTES 64
#elif defined(__AVX2__)
#define TED4_VEC_BYTES 32
#else
#define TED4_VEC_BYTES 16
#endif

enum {
    TED4_LANE_GROUP = 16,
    TED4_VEC = TED4_VEC_BYTES / 4,         /* floats per register */
    TED4_VECS = TED4_LANE_GROUP / TED4_VEC /* registers per lane group */
};

typedef float ted4_vf __attribute__((vector_size(TED4_VEC_BYTES)));
typedef int32_t ted4_vi __attribute__((
    vector_size(TED4_VEC_BYTES))); /* masks are -1 or 0 in each lane, as comparisons give them */
typedef uint32_t ted4_vu __attribute__((vector_size(TED4_VEC_BYTES)));

/* A vector of the lanes of two vectors of floats, a and b, with these numbers, as
 * __builtin_shufflevector gives it. gcc has that one from version 12 on; its older function gives
 * no vector that is shorter than a, but lanes that have no number are the first of a, and not
 * taken. */
#if defined(__clang__) || __GNUC__ >= 12
#define TED4_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define TED4_SHUFFLE(a, b, ...)                                                         \
    __extension__({                                                                     \
        typedef int32_t numbers_ __attribute__((vector_size(sizeof(a))));               \
        typedef float shorter_                                                          \
            __attribute__((vector_size(sizeof((const int32_t[]) { __VA_ARGS__ }))));    \
        const __typeof__(a) all_ = __builtin_shuffle(a, b, (numbers_) { __VA_ARGS__ }); \
        shorter_ some_;                                                                 \
                                                                                        \
        memcpy(&some_, &all_, sizeof some_);                                            \
        some_;                                                                          \
    })
#endif

/* Returns x in every lane. */
TED4_INLINE ted4_vf ted4_vf_all(float x)
{
    return x - (ted4_vf) { 0 };
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

/* These load or store only the first n values, or all if n >= TED4_VEC. Lanes without a value are
 * loaded as 0, and are not stored. */
TED4_INLINE ted4_vf ted4_vf_load_n(const float *p, size_t n)
{
    ted4_vf v = { 0 };

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

/* These return a b + c and c - a b, with a single rounding on levels that have fused
 * multiply-add. */
TED4_INLINE ted4_vf ted4_vf_fma(ted4_vf a, ted4_vf b, ted4_vf c)
{
#if TED4_VEC_BYTES == 64
    return (ted4_vf)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif TED4_VEC_BYTES == 32
    return (ted4_vf)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#elif defined(__aarch64__)
    return (ted4_vf)vfmaq_f32((float32x4_t)c, (float32x4_t)a, (float32x4_t)b);
#elif TED4_FUSED
    for (int i = 0; i < TED4_VEC; i++)
        c[i] = ted4_fma(a[i], b[i], c[i]);
    return c;
#else
    return a * b + c;
#endif
}

TED4_INLINE ted4_vf ted4_vf_fnma(ted4_vf a, ted4_vf b, ted4_vf c)
{
#if TED4_VEC_BYTES == 64
    return (ted4_vf)_mm512_fnmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif TED4_VEC_BYTES == 32
    return (ted4_vf)_mm256_fnmadd_ps((__m256)a, (__m256)b, (__m256)c);
#elif defined(__aarch64__)
    return (ted4_vf)vfmsq_f32((float32x4_t)c, (float32x4_t)a, (float32x4_t)b);
#else
    return ted4_vf_fma(-a, b, c);
#endif
}

/* These return m ? a : 0 and m ? a : b in each lane. */
TED4_INLINE ted4_vf ted4_vf_keep(ted4_vi m, ted4_vf a)
{
    return (ted4_vf)(m & (ted4_vi)a);
}

TED4_INLINE ted4_vf ted4_vf_select(ted4_vi m, ted4_vf a, ted4_vf b)
{
#if TED4_VEC_BYTES == 32
    return (ted4_vf)_mm256_blendv_ps((__m256)b, (__m256)a, (__m256)m);
#else
    return (ted4_vf)((m & (ted4_vi)a) | (~m & (ted4_vi)b));
#endif
}

/* These return the minimum and the maximum of a and b in each lane, and b if either is NaN. */
TED4_INLINE ted4_vf ted4_vf_min(ted4_vf a, ted4_vf b)
{
#if TED4_VEC_BYTES == 64
    return (ted4_vf)_mm512_min_ps((__m512)a, (__m512)b);
#elif TED4_VEC_BYTES == 32
    return (ted4_vf)_mm256_min_ps((__m256)a, (__m256)b);
#elif defined(__x86_64__)
    return (ted4_vf)_mm_min_ps((__m128)a, (__m128)b);
#else
    return ted4_vf_select(a < b, a, b);
#endif
}

TED4_INLINE ted4_vf ted4_vf_max(ted4_vf a, ted4_vf b)
{
#if TED4_VEC_BYTES == 64
    return (ted4_vf)_mm512_max_ps((__m512)a, (__m512)b);
#elif TED4_VEC_BYTES == 32
    return (ted4_vf)_mm256_max_ps((__m256)a, (__m256)b);
#elif defined(__x86_64__)
    return (ted4_vf)_mm_max_ps((__m128)a, (__m128)b);
#else
    return ted4_vf_select(a > b, a, b);
#endif
}

TED4_INLINE ted4_vf ted4_vf_sqrt(ted4_vf x)
{
#if TED4_VEC_BYTES == 64
    return (ted4_vf)_mm512_sqrt_ps((__m512)x);
#elif TED4_VEC_BYTES == 32
    return (ted4_vf)_mm256_sqrt_ps((__m256)x);
#elif defined(__x86_64__)
    return (ted4_vf)_mm_sqrt_ps((__m128)x);
#elif defined(__aarch64__)
    return (ted4_vf)vsqrtq_f32((float32x4_t)x);
#else
    for (int i = 0; i < TED4_VEC; i++)
        x[i] = sqrtf(x[i]);
    return x;
#endif
}

/* Returns a mask as bits: bit i is lane i. */
TED4_INLINE uint32_t ted4_vi_bits(ted4_vi m)
{
#if TED4_VEC_BYTES == 64
    return (uint32_t)_mm512_movepi32_mask((__m512i)m);
#elif TED4_VEC_BYTES == 32
    return (uint32_t)_mm256_movemask_ps((__m256)m);
#elif defined(__x86_64__)
    return (uint32_t)_mm_movemask_ps((__m128)m);
#else
    return (uint32_t)(-m[0] | -m[1] << 1 | -m[2] << 2 | -m[3] << 3);
#endif
}

/* Returns 2^x for x in [-126, 127], with a relative error of 5e-7 (measured on [-8, 0.2]); outside
 * that range the result is meaningless. The polynomial is the minimax polynomial on [-1/2, 1/2]
 * with value 1 at 0, computed for this file by Remez exchange. */
TED4_INLINE ted4_vf ted4_vf_exp2(ted4_vf x)
{
    const float magic = 12582912.0f; /* 1.5 * 2^23: adding it leaves round(x) in the low bits */
    const ted4_vf t = x + magic;
    const ted4_vf f = x - (t - magic);
    ted4_vf y = ted4_vf_fma(f, ted4_vf_all(0.00111255073f), ted4_vf_all(0.00966628268f));

    y = ted4_vf_fma(y, f, ted4_vf_all(0.0555740036f));
    y = ted4_vf_fma(y, f, ted4_vf_all(0.240223512f));
    y = ted4_vf_fma(y, f, ted4_vf_all(0.693142831f));
    y = ted4_vf_fma(y, f, ted4_vf_all(1.0f));
    return (ted4_vf)((ted4_vu)y + ((ted4_vu)t << 23));
}

/* Returns log2(x) for normal x > 0, with an absolute error of 4e-7 on [1/255, 1]; for any other x
 * the result is meaningless. x = m 2^e with m in [sqrt(1/2), sqrt(2)), and log2(m) = 2 / ln(2)
 * artanh((m - 1) / (m + 1)) is computed from its power series. */
TED4_INLINE ted4_vf ted4_vf_log2(ted4_vf x)
{
    const uint32_t half = 0x3f3504f3u; /* bits of sqrt(1/2) */
    const ted4_vu d = (ted4_vu)x - half;
    const ted4_vi e = (ted4_vi)d >> 23;
    const ted4_vf m = (ted4_vf)((d & 0x7fffffu) + half);
    const ted4_vf s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
    const ted4_vf unit = ted4_vf_all((float)(2.0 / 1 / 0.6931471805599453));
    ted4_vf y = ted4_vf_fma(s2, unit * (1.0f / 9.0f), unit * (1.0f / 7.0f));

    y = ted4_vf_fma(y, s2, unit * (1.0f / 5.0f));
    y = ted4_vf_fma(y, s2, unit * (1.0f / 3.0f));
    y = ted4_vf_fma(y, s2, unit);
    return ted4_vf_fma(y, s, __builtin_convertvector(e, ted4_vf));
}

#endif
