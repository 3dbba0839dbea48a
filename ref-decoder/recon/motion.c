/* motion.c - computes the position and feature of moving anchors at a given time (spec 11.2, 11.3).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "recon/recon.h"

static void interpolate_bank(ted4_recon *r, uint32_t num, uint32_t den)
{
    const uint64_t last = r->head.bank_rows - 1;
    const uint64_t g = num * last, i = g / den;
    const size_t dim = r->head.bank_dim;
    const float *z = r->bank + i * dim;

    if (i >= last) {
        memcpy(r->time_in, r->bank + last * dim, dim * sizeof *z);
        return;
    }
    const float w = (float)(g % den) / (float)den;

    for (size_t c = 0; c < dim; c++)
        r->time_in[c] = z[c] + w * (z[dim + c] - z[c]);
}

void ted4_recon_set_time(ted4_recon *r, uint32_t num, uint32_t den)
{
    if (r->head.motion == TED4_MOTION_INR) {
        const int32_t x = (int32_t)(((uint64_t)num << 24) / den);

        ted4_recon_encode(&x, 1, r->time_in);
    } else if (r->head.motion != TED4_MOTION_NONE)
        interpolate_bank(r, num, den);
}

/* Computes the input of F_deform. */
static void deform_input(const ted4_recon *r, size_t block, ted4_recon_scratch *w)
{
    const unsigned n = r->n_motion_rows;
    const float *own = r->motion + (block - r->n_static_blocks) * n * TED4_ROW;

    if (r->head.motion == TED4_MOTION_BANK) {
        ted4_recon_network(r, TED4_NET_PROJECT, own, w, w->deform_in);
        for (size_t i = 0; i < r->head.bank_dim; i++)
            for (int j = 0; j < TED4_ROW; j++)
                w->deform_in[i * TED4_ROW + j] *= r->time_in[i];
        return;
    }
    const size_t n_time = r->net[TED4_NET_DEFORM].dim[0] - n;

    memcpy(w->deform_in, own, n * TED4_ROW * sizeof *own);
    for (size_t i = 0; i < n_time; i++)
        for (int j = 0; j < TED4_ROW; j++)
            w->deform_in[(n + i) * TED4_ROW + j] = r->time_in[i];
}

void ted4_recon_move(const ted4_recon *r, size_t block, ted4_recon_scratch *w)
{
    const float *p = ted4_recon_row(r, block, r->rows.position);
    const float *f = ted4_recon_row(r, block, r->rows.feature);
    const float *y_feature = w->y + 3 * TED4_ROW;

    deform_input(r, block, w);
    ted4_recon_network(r, TED4_NET_DEFORM, w->deform_in, w, w->y);
    for (size_t i = 0; i < 3 * TED4_ROW; i++)
        w->point[i] = p[i] + w->y[i];
    for (size_t i = 0; i < (size_t)r->head.feature_dim * TED4_ROW; i++)
        w->moved[i] = f[i] + y_feature[i];
}
