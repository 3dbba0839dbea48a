/* adjoint.h - the two stages of raster_bwd.c and what passes between them. Depends on
 * render/raster_state.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_ADJOINT_H
#define TED4_RASTER_ADJOINT_H

#include "raster_bwd.h"
#include "render/raster_state.h"

/* Sums over pixels, with g = dL / d ln(alpha), n1 and n2 the whitened offsets, w the blending
 * weight and D the pixel's dL / d colour: one slot of ted4_raster.sums. The sum of g itself is in
 * ted4_raster.sum0. */
enum { TED4_SUM_N1, TED4_SUM_N2, TED4_SUM_N11, TED4_SUM_N12, TED4_SUM_N22, TED4_SUM_COLOUR };

/* Fills sums and sum0 of every instance. 0, or -1: no memory. */
TED4_EACH_LEVEL(int, ted4_raster_blend_bwd, struct ted4_raster *r, const ted4_view *v,
                const ted4_parallel *p, const float *d_image);
/* Adds each Gaussian's sums up and takes them through the projection. */
TED4_EACH_LEVEL(void, ted4_raster_project_bwd, struct ted4_raster *r, const ted4_splats *s,
                const ted4_view *v, const ted4_parallel *p, const ted4_splat_grads *g);

#endif
