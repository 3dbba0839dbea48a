/* loss_state.h - one evaluation of a loss, as its passes see it. Private to loss.c and
 * loss_passes.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LOSS_STATE_H
#define TED4_LOSS_STATE_H

#include <stddef.h>

#include "loss.h"
#include "render/leveled.h"

/* A job is SPLIT rows in the first pass, BAND rows of a tile's width in the others: few enough that
 * a small picture keeps 32 cores busy. */
enum { TED4_LOSS_SPLIT = 4, TED4_LOSS_BAND = 32, TED4_LOSS_TILE = 128, TED4_LOSS_CHANNELS = 3 };

/* Planes have so many zero columns on the left, and zeros from the width to the end of the row, so
 * that a filter may read over the sides. */
enum { TED4_LOSS_SIDE = 16 };

typedef struct {
    const float *image;
    const uint8_t *truth;
    float *d_image;
    float *u, *v, *d[3];
    double *sum; /* [jobs of a pass] */
    int width, height, n_splits, n_bands, n_tiles;
    size_t stride, plane;     /* floats from row to row, channel to channel */
    float l1_step, ssim_step; /* dL/d|v|, -dL/dSSIM of one value */
} ted4_loss_job;

/* The passes: a ted4_loss_job's rows, pieces, pieces. */
TED4_EACH_LEVEL(void, ted4_loss_split, void *job, size_t i);
TED4_EACH_LEVEL(void, ted4_loss_similarity, void *job, size_t i);
TED4_EACH_LEVEL(void, ted4_loss_gradient, void *job, size_t i);

#endif
