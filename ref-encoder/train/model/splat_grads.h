/* splat_grads.h - gradients with respect to Gaussians: written by the adjoint of the rasteriser,
 * read by the adjoint of the generator.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPLAT_GRADS_H
#define TED4_SPLAT_GRADS_H

#include <stdint.h>
#include "render/raster.h"

/* Gradients as a structure of arrays, each [n]. They are overwritten, with 0 for Gaussians that
 * were culled. */
typedef struct {
    float *mean[3], *scale[3], *rot[4], *opacity, *colour[3];
    float *mean2d; /* |dL/d(centre)| in pixels times (width/2, height/2) per axis: the densification
                      signal; at most 1.8e19 */
    uint8_t *visible; /* 1 if the Gaussian reached at least one tile */
} ted4_splat_grads;

#endif
