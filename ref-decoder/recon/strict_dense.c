/* strict_dense.c - the plain dense layer on 32 anchors (spec 12.2). kernel/strict_dense_*.c are
 * faster implementations with the same results.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "recon/strict.h"

void ted4_strict_dense_plain(const ted4_strict_layer *l, const float *x, float *y)
{
    for (unsigned o = 0; o < l->out; o++) {
        float acc[TED4_ROW];

        for (int j = 0; j < TED4_ROW; j++)
            acc[j] = l->b[o];
        for (unsigned i = 0; i < l->in; i++) {
            const float w = l->w[(size_t)o * l->in + i];

            for (int j = 0; j < TED4_ROW; j++)
                acc[j] = acc[j] + w * x[(size_t)i * TED4_ROW + j];
        }
        for (int j = 0; j < TED4_ROW; j++)
            y[(size_t)o * TED4_ROW + j] = l->relu ? ted4_max(0.0f, acc[j]) : acc[j];
    }
}
