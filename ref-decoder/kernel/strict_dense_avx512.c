/* strict_dense_avx512.c - spec 12.2: computes a dense layer over 32 anchors with 512-bit vectors,
 * up to 8 outputs at a time. SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/strict_dense.h"

#if defined(__x86_64__)

#define VECTOR 64
enum { TILE = 8 };
#include "kernel/strict_tile.h"

void ted4_strict_dense_avx512(const ted4_strict_layer *l, const float *x, float *y)
{
    const vf *in = (const vf *)(const void *)x;
    vf *out = (vf *)(void *)y;
    unsigned o = 0;

    for (; o + 8 <= l->out; o += 8)
        dense_tile(l, o, 8, in, out);
    if (l->out & 4) {
        dense_tile(l, o, 4, in, out);
        o += 4;
    }
    if (l->out & 2) {
        dense_tile(l, o, 2, in, out);
        o += 2;
    }
    if (l->out & 1)
        dense_tile(l, o, 1, in, out);
}

#endif
