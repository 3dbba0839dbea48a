/* undistort.h - lens model of the input pictures, and the way from a decoded file to the pixels
 * a pinhole would have seen.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_UNDISTORT_H
#define TED4_UNDISTORT_H

#include <stdint.h>

/* Intrinsics of a picture of width x height pixels, centres at + 0.5, and the radial (k1 k2 k3) and
 * tangential (p1 p2) terms common to COLMAP's SIMPLE_RADIAL, RADIAL, OPENCV, to OpenCV and to
 * Nerfies. skew: pixels to the right for each unit down of the image plane at depth 1. These six
 * zero: a pinhole. */
typedef struct {
    int width, height;
    double fx, fy, cx, cy;
    double k1, k2, p1, p2, k3;
    double skew;
} ted4_lens;

int ted4_lens_is_pinhole(const ted4_lens *l);

/* in, out: RGB [height][width][3] of the lens's size, not overlapping. Bilinear; beyond the
 * border the nearest border pixel. */
void ted4_undistort(const ted4_lens *l, const uint8_t *in, uint8_t *out);

/* Area average over n x n blocks, rounded; rows and columns that do not fill a block are dropped.
 * in: RGB width x height; out: floor(width / n) x floor(height / n). in == out is fine. */
void ted4_downscale(const uint8_t *in, int width, int height, int n, uint8_t *out);

#endif
