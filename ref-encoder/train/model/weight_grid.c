/* weight_grid.c - rounds network weights to coarse grids (weight_grid.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "weight_grid.h"

#include <math.h>

void ted4_weight_grid_full(int *bits)
{
    for (int i = 0; i < TED4_WEIGHT_GRIDS; i++)
        bits[i] = TED4_WEIGHT_GRID_FULL(i);
}

void ted4_weight_grid_round(float *x, size_t n, int bits)
{
    float most = 0;

    for (size_t i = 0; i < n; i++)
        most = fmaxf(most, fabsf(x[i]));
    if (bits >= TED4_WEIGHT_GRID_FULL(TED4_WEIGHT_GRID_HEADS) || !(most > 0x1p-64f))
        return;

    int e;
    const float fraction = frexpf(most, &e); /* in [1/2, 1) */
    const float step = ldexpf(1.0f, (fraction > 0.5f ? e : e - 1) - bits), inverse = 1.0f / step;

    for (size_t i = 0; i < n; i++)
        x[i] = rintf(x[i] * inverse) * step;
}

static void round_network(const ted4_net_shape *net, int bits, float *x)
{
    x += net->first;
    for (int l = 0; l < net->n_layers; l++) {
        const size_t in = net->dim[l], out = net->dim[l + 1];

        for (size_t o = 0; o < out; o++, x += in)
            ted4_weight_grid_round(x, in, bits);
        ted4_weight_grid_round(x, out, bits);
        x += out;
    }
}

void ted4_weight_grid_scene(const ted4_shape *s, const int *bits, float *netr, float *bank)
{
    for (int i = 0; i < TED4_NETS_R; i++)
        round_network(&s->netr[i],
                      bits[i == TED4_NET_PROJECT || i == TED4_NET_DEFORM ? TED4_WEIGHT_GRID_MOTION
                                                                         : TED4_WEIGHT_GRID_HEADS],
                      netr);
    ted4_weight_grid_round(bank, (size_t)s->n_bank, bits[TED4_WEIGHT_GRID_BANK]);
}
