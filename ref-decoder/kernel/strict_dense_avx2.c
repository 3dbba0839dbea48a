/* strict_dense_avx2.c - spec 12.2: the dense layer over 32 anchors with 256-bit vectors; no fused operations.
 * Twin of recon/strict_dense.c. Two outputs at a time keep their sums in registers.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/strict_dense.h"

#if defined(__x86_64__)

typedef float   vf __attribute__((vector_size(32)));
typedef int32_t vi __attribute__((vector_size(32)));

enum { VECS = 4, TILE = 2 };            /* vectors of a row; outputs of a tile */

static inline __attribute__((always_inline)) void
dense_tile(const ted4_strict_layer *l, unsigned first, const int n,
           const vf *restrict x, vf *restrict y)
{
    const float *w = l->w + (size_t)first * l->in;
    vf acc[TILE][VECS];

    for (int o = 0; o < n; o++)
        for (int v = 0; v < VECS; v++)
            acc[o][v] = (vf){ 0 } + l->b[first + o];
    for (unsigned i = 0; i < l->in; i++)
        for (int o = 0; o < n; o++)
            for (int v = 0; v < VECS; v++)
                acc[o][v] = acc[o][v] + w[(size_t)o * l->in + i] * x[i * VECS + v];
    for (int o = 0; o < n; o++)
        for (int v = 0; v < VECS; v++) {
            const vi negative = l->relu ? acc[o][v] < 0.0f : (vi){ 0 };

            y[(first + o) * VECS + v] = (vf)((vi)acc[o][v] & ~negative);
        }
}

void ted4_strict_dense_avx2(const ted4_strict_layer *l, const float *x, float *y)
{
    const vf *in = (const vf *)(const void *)x;
    vf *out = (vf *)(void *)y;
    unsigned o = 0;

    for (; o + 2 <= l->out; o += 2)
        dense_tile(l, o, 2, in, out);
    if (o < l->out)
        dense_tile(l, o, 1, in, out);
}

#endif
