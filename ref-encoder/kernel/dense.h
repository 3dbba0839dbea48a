/* dense.h - float dense layers over blocks of 32 anchors: the trainer's matrix kernels.
 * A block is [channel][32]: one row of 32 lanes per channel, 64-byte aligned. Not normative: sums
 * over lanes have an order of their own, the same at every level (render/leveled.h) and for any
 * number of threads.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DENSE_H
#define TED4_DENSE_H

#include <stddef.h>

#include "render/leveled.h"

enum { TED4_LANES = 32 };

/* Weights of one layer laid out for the kernels of the level in use; packed once an iteration, when
 * they have changed. */
typedef struct {
    int in, out;
    float *fwd; /* owned: copy of W [out][in] and b in kernel order */
    float *bwd; /* owned: the same transposed */
} ted4_dense;

/* 0, or -1: no memory. */
int ted4_dense_init(ted4_dense *d, int in, int out);
void ted4_dense_finish(ted4_dense *d);
/* w: [out][in], b: [out]. */
TED4_EACH_LEVEL(void, ted4_dense_pack, ted4_dense *d, const float *w, const float *b);

/* y[out][32] = W x[in][32] + b; relu: y = max(0, y). */
TED4_EACH_LEVEL(void, ted4_dense_forward, const ted4_dense *d, const float *x, float *y, int relu);
/* dx[in][32] = W^T dy[out][32]; add: += instead. */
TED4_EACH_LEVEL(void, ted4_dense_backward_x, const ted4_dense *d, const float *dy, float *dx,
                int add);
/* dw[out][in] += sum over lanes dy x; db[out] += sum over lanes dy. n_blocks blocks, x and dy
 * contiguous block by block with strides in floats, summed in order. */
TED4_EACH_LEVEL(void, ted4_dense_backward_w, int in, int out, const float *x, size_t x_stride,
                const float *dy, size_t dy_stride, size_t n_blocks, float *dw, float *db);

#endif
