/* undistort.h - lens model of the input pictures, and the resampling from a decoded file to the
 * pixels that a pinhole camera would have seen.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_UNDISTORT_H
#define TED4_UNDISTORT_H

#include <stdint.h>

/* Intrinsics of a picture of width x height pixels with pixel centres at + 0.5, and the radial (k1
 * k2 k3) and tangential (p1 p2) terms that COLMAP's SIMPLE_RADIAL, RADIAL and OPENCV, OpenCV and
 * Nerfies have in common. skew: shift to the right, in pixels, for each unit down in the image
 * plane at depth 1. The lens is a pinhole if these six are zero. */
typedef struct {
    int width, height;
    double fx, fy, cx, cy;
    double k1, k2, p1, p2, k3;
    double skew;
} ted4_lens;

int ted4_lens_is_pinhole(const ted4_lens *l);

/* Undistorts a picture by bilinear interpolation; positions beyond the border take the nearest
 * border pixel. in, out: RGB [height][width][3] at the size of the lens, not overlapping. */
void ted4_undistort(const ted4_lens *l, const uint8_t *in, uint8_t *out);

/* Downscales by the rounded average over n x n blocks; rows and columns that do not fill a block
 * are dropped. in: RGB width x height; out: RGB floor(width / n) x floor(height / n). in may equal
 * out. */
void ted4_downscale(const uint8_t *in, int width, int height, int n, uint8_t *out);

#endif
