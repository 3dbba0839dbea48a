/* chain.c - the dense layers of a generator's networks, forward and backward. spec 7.4.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "decode_lanes.h"

void ted4_gen_chain_forward(const ted4_gen_chain *c, float *planes)
{
    for (int i = 0; i < c->n; i++)
        TED4_LEVELED(ted4_dense_forward)
    (&c->layer[i].dense, ted4_gen_plane(planes, c->layer[i].x),
     ted4_gen_plane(planes, c->layer[i].y), i + 1 < c->n);
}

void ted4_gen_chain_backward(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                             float *d, float *dx, int add)
{
    for (int i = c->n - 1; i > 0; i--) {
        const ted4_gen_layer *layer = &c->layer[i];
        float *dy = ted4_gen_plane(d, layer->y - g->plane.outputs);
        float *below = ted4_gen_plane(d, layer->x - g->plane.outputs);

        TED4_LEVELED(ted4_dense_backward_x)(&layer->dense, dy, below, 0);
        ted4_relu_backward(ted4_gen_plane(planes, layer->x), (size_t)layer->dense.in * TED4_LANES,
                           below);
    }
    if (dx != NULL)
        TED4_LEVELED(ted4_dense_backward_x)
    (&c->layer[0].dense, ted4_gen_plane(d, c->layer[0].y - g->plane.outputs), dx, add);
}

void ted4_gen_chain_weights(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                            float *d, size_t n, float *grad)
{
    for (int i = 0; i < c->n; i++) {
        const ted4_gen_layer *layer = &c->layer[i];
        const int in = layer->dense.in, out = layer->dense.out;
        float *dw = grad + layer->grad;

        TED4_LEVELED(ted4_dense_backward_w)
        (in, out, ted4_gen_plane(planes, layer->x), ted4_gen_stride(g),
         ted4_gen_plane(d, layer->y - g->plane.outputs), g->d_size, n, dw,
         dw + (size_t)in * (size_t)out);
    }
}
