/* attest.h - the byte strings of annex J.9: defined functions over all their inputs, hashed. The
 * short ones and samples of the others are checked by test_spec_annexes.c, all by `make attest`.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ATTEST_H
#define TED4_ATTEST_H

#include <inttypes.h>
#include <stdio.h>
#define XXH_STATIC_LINKING_ONLY
#include <xxhash.h>
#include "base/bytes.h"
#include "norm/adaptive.h"
#include "norm/gaussian.h"
#include "norm/half.h"
#include "norm/sine.h"
#include "recon/strict.h"

enum { ATTEST_BATCH = 4096 };

typedef struct {
    XXH3_state_t state;
    uint64_t n; /* values so far */
    uint32_t n_batch;
    uint8_t bytes[4 * ATTEST_BATCH];
} attest_string;

static inline void attest_begin(attest_string *a)
{
    XXH3_INITSTATE(&a->state);
    (void)XXH3_128bits_reset(&a->state);
    a->n = a->n_batch = 0;
}

static inline void attest_put(attest_string *a, uint32_t value)
{
    ted4_store32(a->bytes + 4 * a->n_batch, value);
    a->n++;
    if (++a->n_batch == ATTEST_BATCH) {
        (void)XXH3_128bits_update(&a->state, a->bytes, sizeof a->bytes);
        a->n_batch = 0;
    }
}

/* The row of the table in J.9. */
static inline void attest_end(attest_string *a, const char *name, FILE *out)
{
    XXH128_canonical_t c;

    (void)XXH3_128bits_update(&a->state, a->bytes, 4 * (size_t)a->n_batch);
    XXH128_canonicalFromHash(&c, XXH3_128bits_digest(&a->state));
    fprintf(out, "| %s | %" PRIu64 " | `", name, a->n);
    for (int i = 0; i < 16; i++)
        fprintf(out, "%02x", c.digest[i]);
    fprintf(out, "` |\n");
}

/* NaN of any kind as one pattern. */
static inline uint32_t attest_bits(float x)
{
    return x == x ? ted4_float_bits(x) : 0x7fc00000;
}

/* f over the binary32 patterns 0, stride, 2 stride, ... below 2^32. */
static inline void attest_real(float (*f)(float x), uint32_t stride, const char *name, FILE *out)
{
    attest_string a;

    attest_begin(&a);
    for (uint64_t i = 0; i < (uint64_t)1 << 32; i += stride)
        attest_put(&a, attest_bits(f(ted4_bits_float((uint32_t)i))));
    attest_end(&a, name, out);
}

static inline void attest_sine(FILE *out)
{
    attest_string a;

    attest_begin(&a);
    for (uint32_t i = 0; i < 1u << 22; i++)
        attest_put(&a, (uint32_t)(int32_t)ted4_sine(i << 10));
    attest_end(&a, "sine", out);
}

/* For g = 0, g_stride, ... and for fr = 0, fr_stride, ...: all j. */
static inline void attest_cum(unsigned g_stride, int32_t fr_stride, const char *name, FILE *out)
{
    attest_string a;

    attest_begin(&a);
    for (unsigned g = 0; g < TED4_N_SIGMA; g += g_stride)
        for (int32_t fr = 0; fr < 256; fr += fr_stride)
            for (uint32_t j = 0; j <= ted4_gauss_size(g); j++)
                attest_put(&a, ted4_gauss_cum(g, fr, j));
    attest_end(&a, name, out);
}

/* X of every legal pattern of |p| <= 1 in ascending order of the pattern. */
static inline void attest_q24(FILE *out)
{
    attest_string a;

    attest_begin(&a);
    for (uint32_t h = 0; h < 0x10000; h++)
        if ((h & 0x7fff) <= 0x3c00 && h != 0x8000)
            attest_put(&a, (uint32_t)ted4_half_q24((uint16_t)h));
    attest_end(&a, "q24", out);
}

/* Integerised weights: all patterns with mantissas at ties and beside them, for all shifts. */
static inline void attest_rne(FILE *out)
{
    attest_string a;

    attest_begin(&a);
    for (int e = 0; e <= 32; e++)
        for (uint32_t exponent = 96; exponent < 144; exponent++)
            for (uint32_t m = 0; m < 1u << 23; m += 4093) {
                const int64_t x = ted4_rne_scaled(exponent << 23 | m, e);

                attest_put(&a, (uint32_t)x);
                attest_put(&a, (uint32_t)((uint64_t)x >> 32));
            }
    attest_end(&a, "rne_scaled", out);
}

/* The pattern of the coordinate at every place of every grid. */
static inline void attest_coordinate(FILE *out)
{
    attest_string a;

    attest_begin(&a);
    for (unsigned g = 6; g <= 16; g++)
        for (uint32_t place = 0; (g <= 12 || g == 16) && place < 1u << g; place++)
            attest_put(&a, ted4_grid_half(place, g));
    attest_end(&a, "coordinate", out);
}

/* p after each bit, from every p and every number of bits seen. */
static inline void attest_adaptive(FILE *out)
{
    attest_string a;

    attest_begin(&a);
    for (int seen = 0; seen <= 24; seen++)
        for (int p = 32; p <= 65504; p++)
            for (int bit = 0; bit < 2; bit++) {
                ted4_adaptive m = { (uint16_t)p, (uint8_t)seen };

                ted4_adaptive_update(&m, bit);
                attest_put(&a, m.p);
            }
    attest_end(&a, "adaptive", out);
}

/* In seconds. */
static inline void attest_short(FILE *out)
{
    attest_q24(out);
    attest_sine(out);
    attest_rne(out);
    attest_coordinate(out);
    attest_adaptive(out);
    attest_cum(1, 1, "cum", out);
}

/* Samples of the long ones; the strides are primes, so that every exponent is met with many
 * fractions. In seconds. */
static inline void attest_samples(FILE *out)
{
    attest_cum(13, 37, "cum, sampled", out);
    attest_real(ted4_pow2, 4093, "pow2, sampled", out);
    attest_real(ted4_sigmoid, 4093, "sigmoid, sampled", out);
}

#endif
