/* metrics.h - the quality of an 8-bit RGB picture compared with another one, by the definitions
 * that the literature on dynamic scenes uses. Depends on base/parallel.h. The differentiable loss
 * of the trainer is in train/loss/loss.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_METRICS_H
#define TED4_METRICS_H

#include <stdint.h>
#include "base/parallel.h"

enum { TED4_MS_SSIM_SCALES = 5, TED4_SSIM_WINDOW = 11, TED4_SSIM2_WINDOW = 7 };

typedef struct {
    /* In dB, from the mean squared error over all pixels and channels; INFINITY for equal
     * pictures. */
    double psnr;
    /* "SSIM_1": 11 x 11 Gaussian of sigma 1.5, zero padding, data range 1, mean over all pixels and
     * channels. */
    double ssim;
    /* "SSIM_2": scikit-image with floats in [0, 1] and its default range 2: 7 x 7 mean, sample
     * covariance, border of 3 pixels cropped. */
    double ssim2;
    /* MS-SSIM: 11 x 11 Gaussian without padding, range 1. Between scales, 2 x 2 pixels are
     * averaged, and an odd side gets one zero in front. The factors are multiplied per channel,
     * then the channels are averaged; negative factors count as 0. */
    double ms_ssim;
    double l1; /* mean absolute difference over all pixels and channels, range 1 */
    /* The number of scales of ms_ssim: 5, or as many as keep both sides at 11 pixels or more. With
     * fewer than 5, the weights are divided by their sum. */
    int scales;
} ted4_metrics;

/* Compares a and b, interleaved [height][width][3]; the result is symmetric in them. A metric whose
 * window is larger than the picture is NAN. The result has the same bits for any number of threads.
 * Returns 0, or -1 if there is no memory. */
int ted4_metrics_compare(const uint8_t *a, const uint8_t *b, int width, int height,
                         const ted4_parallel *p, ted4_metrics *m);

#endif
