/* metrics.h - quality of one 8-bit RGB picture against another, by the definitions the literature
 * of dynamic scenes uses.
 * Depends on base/parallel.h. The differentiable loss of the trainer is
 * train/loss/loss.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_METRICS_H
#define TED4_METRICS_H

#include <stdint.h>
#include "base/parallel.h"

enum { TED4_MS_SSIM_SCALES = 5, TED4_SSIM_WINDOW = 11, TED4_SSIM2_WINDOW = 7 };

typedef struct {
    double psnr;    /* dB, from the mean square over all pixels and channels; INFINITY for
                     * equal pictures */
    double ssim;    /* "SSIM_1": 11 x 11 Gaussian of sigma 1.5, zero padding, data range 1,
                     * mean over all pixels and channels */
    double ssim2;   /* "SSIM_2": scikit-image with floats in [0, 1] and its default range 2:
                     * 7 x 7 mean, sample covariance, border of 3 cropped */
    double ms_ssim; /* 11 x 11 Gaussian without padding, range 1; 2 x 2 average between scales,
                     * where an odd side gets one zero in front; product by channel, then
                     * mean; negative factors count as 0 */
    double l1;      /* mean absolute difference over all pixels and channels, range 1 */
    int scales;     /* of ms_ssim: 5, or as many as keep both sides at 11 pixels or more; then
                     * the weights are divided by their sum */
} ted4_metrics;

/* a, b: interleaved [height][width][3]; the result is symmetric in them. A metric whose window is
 * larger than the picture is NAN.
 * Same bits for any number of threads. 0, or -1: no memory. */
int ted4_metrics_compare(const uint8_t *a, const uint8_t *b, int width, int height,
                         const ted4_parallel *p, ted4_metrics *m);

#endif
