/* loss_state.h - the state of one evaluation of the loss, shared by its passes. Private to loss.c
 * and loss_passes.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LOSS_STATE_H
#define TED4_LOSS_STATE_H

#include <stddef.h>

#include "loss.h"
#include "render/leveled.h"

/* A job covers TED4_LOSS_SPLIT rows in the first pass, and TED4_LOSS_BAND rows of one tile's width
 * in the others: small enough that even a small picture keeps 32 cores busy. */
enum { TED4_LOSS_SPLIT = 4, TED4_LOSS_BAND = 32, TED4_LOSS_TILE = 128, TED4_LOSS_CHANNELS = 3 };

/* Zero columns to the left of each plane. Each row is also padded with zeros on the right, so that
 * filters may read beyond both sides. */
enum { TED4_LOSS_SIDE = 16 };

typedef struct {
    const float *image;
    const uint8_t *truth;
    float *d_image;
    float *u, *v, *d[3];
    double *sum; /* [jobs of a pass] */
    int width, height, n_splits, n_bands, n_tiles;
    size_t stride, plane;     /* distance in floats between rows, between channels */
    float l1_step, ssim_step; /* dL/d|v|, -dL/dSSIM of one value */
} ted4_loss_job;

/* The three passes. job is a ted4_loss_job; i is a group of rows in the first pass and a piece of a
 * channel in the others. */
TED4_EACH_LEVEL(void, ted4_loss_split, void *job, size_t i);
TED4_EACH_LEVEL(void, ted4_loss_similarity, void *job, size_t i);
TED4_EACH_LEVEL(void, ted4_loss_gradient, void *job, size_t i);

#endif
