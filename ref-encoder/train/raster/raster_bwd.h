/* raster_bwd.h - adjoint of ref-decoder/render/raster.h. Source: the formulas of annex I.2 and I.3,
 * differentiated.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_BWD_H
#define TED4_RASTER_BWD_H

#include "train/model/splat_grads.h"

/* The workspace of the adjoint: memory that is reused from call to call. */
typedef struct ted4_adjoint ted4_adjoint;

ted4_adjoint *ted4_adjoint_new(void); /* NULL: no memory */
void ted4_adjoint_free(ted4_adjoint *a);

/* Call after ted4_raster_forward(r, keep_state = 1) with the same s and v. d_image: planar, like
 * image. Sums have a fixed order, so results are bit-identical for any number of threads. Returns
 * 0, or -1 if memory ran out. */
int ted4_raster_backward(ted4_adjoint *a, const ted4_raster *r, const ted4_splats *s,
                         const ted4_view *v, const ted4_parallel *p, const float *d_image,
                         const ted4_splat_grads *g);

#endif
