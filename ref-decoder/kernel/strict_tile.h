/* strict_tile.h - spec 12.2: computes n outputs of a dense layer for 32 anchors, with sums kept in
 * registers and without fused operations; a variant of recon/strict_dense.c. The including file
 * defines VECTOR, the size of a vector in bytes, and TILE, the largest n. Depends on
 * kernel/strict_dense.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STRICT_TILE_H
#define TED4_STRICT_TILE_H

#include <stddef.h>
#include <stdint.h>
#include "kernel/strict_dense.h"

typedef float vf __attribute__((vector_size(VECTOR)));
typedef int32_t vi __attribute__((vector_size(VECTOR)));

enum { VECS = 32 * sizeof(float) / VECTOR }; /* vectors per row, which holds one value per anchor */

/* Computes outputs first .. first + n - 1. */
static inline __attribute__((always_inline)) void dense_tile(const ted4_strict_layer *l,
                                                             unsigned first, const int n,
                                                             const vf *restrict x, vf *restrict y)
{
    const float *w = l->w + (size_t)first * l->in;
    vf acc[TILE][VECS];

    for (int o = 0; o < n; o++)
        for (int v = 0; v < VECS; v++)
            acc[o][v] = (vf) { 0 } + l->b[first + o];
    for (unsigned i = 0; i < l->in; i++)
        for (int o = 0; o < n; o++)
            for (int v = 0; v < VECS; v++)
                acc[o][v] = acc[o][v] + w[(size_t)o * l->in + i] * x[i * VECS + v];
    for (int o = 0; o < n; o++)
        for (int v = 0; v < VECS; v++) {
            const vi negative = l->relu ? acc[o][v] < 0.0f : (vi) { 0 };

            y[(first + o) * VECS + v] = (vf)((vi)acc[o][v] & ~negative);
        }
}

#endif
