/* raster_bwd.h - adjoint of ref-decoder/render/raster.h. Source: the formulas of annex I.2 and I.3,
 * differentiated.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_BWD_H
#define TED4_RASTER_BWD_H

#include "render/raster.h"

/* Gradients, structure of arrays [n]; overwritten (0 for Gaussians that were culled). */
typedef struct {
    float *mean[3], *scale[3], *rot[4], *opacity, *colour[3];
    float *mean2d; /* |dL/d(centre)| in pixels times (width/2, height/2) per axis: the densification
                      signal; at most 1.8e19 */
    uint8_t *visible; /* 1 where the Gaussian reached at least one tile */
} ted4_splat_grads;

/* After ted4_raster_forward(keep_state = 1) with the same s and v. d_image: planar, as image. Sums
 * in fixed order: same bits for any number of threads. 0, or -1 when memory ran out. */
int ted4_raster_backward(ted4_raster *r, const ted4_splats *s, const ted4_view *v,
                         const ted4_parallel *p, const float *d_image, const ted4_splat_grads *g);

#endif
