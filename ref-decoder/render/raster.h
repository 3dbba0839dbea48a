/* raster.h - annex I (informative): tile rasteriser for 3D Gaussians, the forward pass that decoder
 * and trainer share. Depends on base/parallel.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_H
#define TED4_RASTER_H

#include <stddef.h>
#include <stdint.h>
#include "base/parallel.h"

/* Constants of the image model, shared by forward and backward (algorithm: 3D Gaussian splatting,
 * EWA). */
#define TED4_RASTER_BLUR      0.3f /* added to both variances of the 2D covariance, pixels^2 */
#define TED4_RASTER_ALPHA_MAX 0.99f
#define TED4_RASTER_ALPHA_MIN (1.0f / 255.0f)
#define TED4_RASTER_T_MIN     1e-4f /* transmittance under which a pixel is finished */
#define TED4_RASTER_GUARD     1.3f  /* frustum factor of the Jacobian clamp */

/* A pinhole view. Camera axes right, down, forward; x_cam = R x + t; pixel (i, j) of column i has
 * its centre at (i + 0.5, j + 0.5). */
typedef struct {
    int width, height;
    float fx, fy, cx, cy;
    float R[9], t[3];
    float near_z; /* Gaussians at or before it are culled */
    float background[3];
} ted4_view;

/* n Gaussians as structure of arrays; borrowed. Scales are linear, rotations unit quaternions w x y
 * z, opacity in [0, 1]: one below TED4_RASTER_ALPHA_MIN (negative included) is skipped. */
typedef struct {
    size_t n;
    const float *mean[3], *scale[3], *rot[4], *opacity, *colour[3];
} ted4_splats;

/* Workspace reused from view to view; grows as needed. Opaque: render/raster_state.h for the
 * adjoint. */
typedef struct ted4_raster ted4_raster;

ted4_raster *ted4_raster_new(void);    /* NULL: no memory */
void ted4_raster_free(ted4_raster *r); /* NULL is fine */

/* Renders into image, planar [3][height][width], not clamped. Same bits for any number of threads.
 * Ties in depth are broken by index. 0, or -1 when memory ran out (image then undefined).
 * keep_state: nonzero keeps what the adjoint needs. */
int ted4_raster_forward(ted4_raster *r, const ted4_splats *s, const ted4_view *v,
                        const ted4_parallel *p, int keep_state, float *image);

/* How many Gaussians all forward passes of r left out because binary32 cannot hold them, though
 * they are neither behind the camera nor too faint: with a mean, size, rotation or opacity that is
 * infinite or NaN, or a footprint of more than some 4e9 pixels in both directions. */
uint64_t ted4_raster_skipped(const ted4_raster *r);

#endif
