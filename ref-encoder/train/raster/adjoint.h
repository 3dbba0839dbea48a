/* adjoint.h - the two stages of raster_bwd.c and the data passed between them. Depends on
 * render/raster_state.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_ADJOINT_H
#define TED4_RASTER_ADJOINT_H

#include "raster_bwd.h"
#include "render/raster_state.h"

/* Indices into ted4_adjoint.sums: one instance's sums over pixels, with g = dL / d ln(alpha), n1
 * and n2 the whitened offsets, w the blending weight, and D the pixel's dL / d colour. The sum of g
 * itself is in ted4_adjoint.sum0. */
enum { TED4_SUM_N1, TED4_SUM_N2, TED4_SUM_N11, TED4_SUM_N12, TED4_SUM_N22, TED4_SUM_COLOUR };

enum {
    TED4_GRAD_SUMS = 8, /* sums per instance that form a vector; one more is kept separately */
    TED4_BWD_JOBS = 64  /* jobs that share the tiles: the most threads that the adjoint can use */
};

struct ted4_adjoint {
    /* per instance, indexed by instance */
    ted4_growing sums; /* float [TED4_GRAD_SUMS] */
    ted4_growing sum0; /* float */
    ted4_growing scratch[TED4_BWD_JOBS];
};

/* Fills sums and sum0 of every instance. Returns 0, or -1 if memory ran out. */
TED4_EACH_LEVEL(int, ted4_raster_blend_bwd, ted4_adjoint *a, const ted4_raster *r,
                const ted4_view *v, const ted4_parallel *p, const float *d_image);
/* Adds up each Gaussian's sums and backpropagates them through the projection. */
TED4_EACH_LEVEL(void, ted4_raster_project_bwd, const ted4_adjoint *a, const ted4_raster *r,
                const ted4_splats *s, const ted4_view *v, const ted4_parallel *p,
                const ted4_splat_grads *g);

#endif
