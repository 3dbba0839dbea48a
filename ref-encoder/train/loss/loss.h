/* loss.h - the distortion of one view: (1 - w) L1 + w (1 - SSIM), and its gradient on the rendered
 * image. Depends on base/parallel.h. The metrics on decoded pictures are in eval/metrics.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LOSS_H
#define TED4_LOSS_H

#include <stdint.h>
#include "base/parallel.h"

/* SSIM uses an 11 x 11 Gaussian window with sigma 1.5, zero padding, and a data range of 1. */
#define TED4_SSIM_C1 (0.01f * 0.01f)
#define TED4_SSIM_C2 (0.03f * 0.03f)

/* Planes that are reused from view to view; the workspace grows to the largest image seen. */
typedef struct ted4_loss_workspace ted4_loss_workspace;

ted4_loss_workspace *ted4_loss_workspace_new(void);    /* NULL: no memory */
void ted4_loss_workspace_free(ted4_loss_workspace *w); /* w may be NULL */

/* Returns the loss L over all pixels and channels. image: planar [3][height][width], not clamped.
 * truth: interleaved bytes [height][width][3]. d_image: planar, overwritten with dL/d(image). *l1:
 * mean absolute difference; *ssim: mean structural similarity. Results are bit-identical for any
 * number of threads. If memory ran out, returns -1 and writes nothing (L itself is never negative
 * for ssim_weight in [0, 1]). */
double ted4_loss(ted4_loss_workspace *w, const float *image, const uint8_t *truth, int width,
                 int height, float ssim_weight, const ted4_parallel *p, float *d_image, double *l1,
                 double *ssim);

#endif
