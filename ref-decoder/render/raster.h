/* raster.h - the tile rasteriser for 3D Gaussians: the forward pass, which decoder and trainer
 * share (annex I, informative). Depends on base/parallel.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_H
#define TED4_RASTER_H

#include <stddef.h>
#include <stdint.h>
#include "base/parallel.h"

/* Constants of the image model (3D Gaussian splatting with EWA projection), shared by the forward
 * and backward passes. */
#define TED4_RASTER_BLUR      0.3f /* added to both variances of the 2D covariance, pixels^2 */
#define TED4_RASTER_ALPHA_MAX 0.99f
#define TED4_RASTER_ALPHA_MIN (1.0f / 255.0f)
#define TED4_RASTER_T_MIN     1e-4f          /* transmittance below which a pixel is finished */
#define TED4_RASTER_GUARD     1.3f           /* frustum factor of the Jacobian clamp */
#define TED4_RASTER_BOX       (1.0f / 12.0f) /* variance of a pixel's square, pixels^2 */

/* A pinhole view. The camera axes are right, down, forward; x_cam = R x + t. The pixel in column i
 * and row j has its centre at (i + 0.5, j + 0.5). */
typedef struct {
    int width, height;
    float fx, fy, cx, cy;
    float R[9], t[3];
    float near_z; /* Gaussians at or before this depth are culled */
    float background[3];
    float pixel; /* width of a pixel, in pixels of the pictures of which the scene was learnt (annex
                    I.4). 0 stands for 1, the only value for which there is an adjoint */
} ted4_view;

/* n Gaussians as a structure of arrays; borrowed. Scales are linear, rotations are unit quaternions
 * w x y z, opacities are in [0, 1]. A Gaussian whose opacity is below TED4_RASTER_ALPHA_MIN, or
 * negative, is skipped. */
typedef struct {
    size_t n;
    const float *mean[3], *scale[3], *rot[4], *opacity, *colour[3];
} ted4_splats;

/* A workspace, reused from view to view, that grows as needed. It is opaque; render/raster_state.h
 * defines it for the adjoint. */
typedef struct ted4_raster ted4_raster;

ted4_raster *ted4_raster_new(void);    /* owned by the caller; NULL: out of memory */
void ted4_raster_free(ted4_raster *r); /* r may be NULL */

/* Renders into image, planar [3][height][width], not clamped. The result has the same bits for any
 * number of threads. Ties in depth are broken by index. keep_state: nonzero keeps the state that
 * the adjoint needs. Returns 0, or -1 with image undefined if out of memory, or if the picture is
 * wider or higher than 1,048,560 pixels or has more than about 1.07e9 of them. */
int ted4_raster_forward(ted4_raster *r, const ted4_splats *s, const ted4_view *v,
                        const ted4_parallel *p, int keep_state, float *image);

/* Returns the number of Gaussians that all forward passes of r have left out because binary32
 * cannot represent them, though they are neither behind the camera nor too faint: a mean, scale,
 * rotation or opacity is infinite or NaN, or the footprint exceeds about 4e9 pixels in both
 * directions. */
uint64_t ted4_raster_skipped(const ted4_raster *r);

#endif
