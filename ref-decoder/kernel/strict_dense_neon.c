/* strict_dense_neon.c - spec 12.2: computes a dense layer over 32 anchors with 128-bit vectors, two
 * outputs at a time.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/strict_dense.h"

#if defined(__AARCH64EL__)

#define VECTOR 16
enum { TILE = 2 };
#include "kernel/strict_tile.h"

void ted4_strict_dense_neon(const ted4_strict_layer *l, const float *x, float *y)
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
