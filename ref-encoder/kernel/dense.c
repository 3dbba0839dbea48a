/* dense.c - allocates the layers of dense.h, and calls the products of the level in use. spec 7.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/dense.h"

#include <stdlib.h>

int ted4_dense_init(ted4_dense *d, int in, int out)
{
    const size_t n_in = (size_t)in, n_out = (size_t)out;

    d->in = in;
    d->out = out;
    d->fwd = malloc(n_out * (n_in + 1) * sizeof *d->fwd);
    d->bwd = malloc(n_in * (n_out + 1) * sizeof *d->bwd);
    if (d->fwd == NULL || d->bwd == NULL) {
        ted4_dense_finish(d);
        return -1;
    }
    return 0;
}

void ted4_dense_finish(ted4_dense *d)
{
    free(d->fwd);
    free(d->bwd);
    d->fwd = NULL;
    d->bwd = NULL;
}

void ted4_dense_pack(ted4_dense *d, const float *w, const float *b)
{
    TED4_IN_USE(ted4_dense_pack)(d, w, b);
}

void ted4_dense_forward(const ted4_dense *d, const float *x, float *y, int relu)
{
    TED4_IN_USE(ted4_dense_forward)(d, x, y, relu);
}

void ted4_dense_backward_x(const ted4_dense *d, const float *dy, float *dx, int add)
{
    TED4_IN_USE(ted4_dense_backward_x)(d, dy, dx, add);
}

void ted4_dense_backward_w(int in, int out, const float *x, size_t x_stride, const float *dy,
                           size_t dy_stride, size_t n_blocks, float *dw, float *db)
{
    TED4_IN_USE(ted4_dense_backward_w)(in, out, x, x_stride, dy, dy_stride, n_blocks, dw, db);
}
