/* dense.h - float dense layers over blocks of 32 anchors: the trainer's matrix kernels. A block is
 * [channel][32], one row of 32 lanes per channel, 64-byte aligned. The kernels are not normative:
 * they sum over lanes in an order of their own, which is the same at every level
 * (render/leveled.h) and for any number of threads.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DENSE_H
#define TED4_DENSE_H

#include <stddef.h>

#include "render/leveled.h"

enum { TED4_LANES = 32 };

/* The weights of one layer, laid out for the kernels of the level in use. They are packed once per
 * iteration, after they have changed. */
typedef struct {
    int in, out;
    float *fwd; /* owned: copy of W [out][in] and b in kernel order */
    float *bwd; /* owned: the transpose of W, with biases of 0 */
} ted4_dense;

/* Returns 0, or -1 if there is no memory. */
int ted4_dense_init(ted4_dense *d, int in, int out);
void ted4_dense_finish(ted4_dense *d);
/* Packs w [out][in] and b [out] into d. */
TED4_EACH_LEVEL(void, ted4_dense_pack, ted4_dense *d, const float *w, const float *b);

/* Computes y[out][32] = W x[in][32] + b, and with relu y = max(0, y). */
TED4_EACH_LEVEL(void, ted4_dense_forward, const ted4_dense *d, const float *x, float *y, int relu);
/* Computes dx[in][32] = W^T dy[out][32], or with add dx += W^T dy. */
TED4_EACH_LEVEL(void, ted4_dense_backward_x, const ted4_dense *d, const float *dy, float *dx,
                int add);
/* Adds the sums over all lanes of dy x to dw[out][in], and those of dy to db[out]. x and dy have
 * n_blocks blocks, which are summed in order; each block is contiguous, and the strides are the
 * distances of successive blocks in floats. */
TED4_EACH_LEVEL(void, ted4_dense_backward_w, int in, int out, const float *x, size_t x_stride,
                const float *dy, size_t dy_stride, size_t n_blocks, float *dw, float *db);

#endif
