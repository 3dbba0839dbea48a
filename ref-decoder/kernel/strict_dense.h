/* strict_dense.h - spec 7.1, 12.2: faster, bit-exact variants of ted4_strict_dense_plain
 * (recon/strict.h), one dense layer over a block of 32 anchors, and the selection of one of them.
 * Depends on nothing.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STRICT_DENSE_H
#define TED4_STRICT_DENSE_H

/* A dense layer. w: [out][in] and b: [out], both borrowed. relu: not 0 if y = max(0, y) follows. */
typedef struct {
    unsigned in, out;
    const float *w, *b;
    int relu;
} ted4_strict_layer;

/* Computes y[out][32] = W x[in][32] + b, in the order of spec 12.2. x and y are aligned to 64 bytes
 * and do not overlap. All variants give the same bits. */
typedef void (*ted4_strict_dense_fn)(const ted4_strict_layer *l, const float *x, float *y);

#if defined(__x86_64__)
void ted4_strict_dense_avx2(const ted4_strict_layer *l, const float *x, float *y);
void ted4_strict_dense_avx512(const ted4_strict_layer *l, const float *x, float *y);
#elif defined(__AARCH64EL__)
void ted4_strict_dense_neon(const ted4_strict_layer *l, const float *x, float *y);
#endif

/* Returns the variant for the wanted level (base/level.h), or NULL if that is the plain one. */
ted4_strict_dense_fn ted4_select_strict_dense(void);

#endif
