/* splat_grads.h - gradients on Gaussians: the rasteriser's adjoint writes them, and the adjoint of
 * the generator reads them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPLAT_GRADS_H
#define TED4_SPLAT_GRADS_H

#include <stdint.h>
#include "render/raster.h"

/* Gradients, structure of arrays [n]; overwritten (0 for Gaussians that were culled). */
typedef struct {
    float *mean[3], *scale[3], *rot[4], *opacity, *colour[3];
    float *mean2d; /* |dL/d(centre)| in pixels times (width/2, height/2) per axis: the densification
                      signal; at most 1.8e19 */
    uint8_t *visible; /* 1 where the Gaussian reached at least one tile */
} ted4_splat_grads;

#endif
