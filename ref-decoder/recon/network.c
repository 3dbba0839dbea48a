/* network.c - evaluates a network of Tier R on a block of 32 anchors (spec 7.1, 7.4).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "recon/recon.h"

void ted4_recon_network(const ted4_recon *r, int net, const float *x, ted4_recon_scratch *w,
                        float *y)
{
    const ted4_net_shape *n = &r->net[net];
    const float *value = r->netr + n->first;

    for (unsigned i = 0; i < n->n_layers; i++) {
        const int last = i + 1 == n->n_layers;
        const size_t n_weights = (size_t)n->dim[i] * n->dim[i + 1];
        const ted4_strict_layer l = { n->dim[i], n->dim[i + 1], value, value + n_weights, !last };
        float *to = last ? y : w->hidden[i % 2];

        r->dense(&l, x, to);
        x = to;
        value += n_weights + n->dim[i + 1];
    }
}
