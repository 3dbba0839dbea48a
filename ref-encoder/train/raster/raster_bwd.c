/* raster_bwd.c - adjoint of the rasteriser: runs its two stages. See raster_bwd.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "adjoint.h"

#include <stdlib.h>

ted4_adjoint *ted4_adjoint_new(void)
{
    return calloc(1, sizeof(ted4_adjoint));
}

void ted4_adjoint_free(ted4_adjoint *a)
{
    if (a == NULL)
        return;
    ted4_growing_free(&a->sums);
    ted4_growing_free(&a->sum0);
    for (int i = 0; i < TED4_BWD_JOBS; i++)
        ted4_growing_free(&a->scratch[i]);
    free(a);
}

int ted4_raster_blend_bwd(ted4_adjoint *a, const ted4_raster *r, const ted4_view *v,
                          const ted4_parallel *p, const float *d_image)
{
    return TED4_IN_USE(ted4_raster_blend_bwd)(a, r, v, p, d_image);
}

void ted4_raster_project_bwd(const ted4_adjoint *a, const ted4_raster *r, const ted4_splats *s,
                             const ted4_view *v, const ted4_parallel *p, const ted4_splat_grads *g)
{
    TED4_IN_USE(ted4_raster_project_bwd)(a, r, s, v, p, g);
}

int ted4_raster_backward(ted4_adjoint *a, const ted4_raster *r, const ted4_splats *s,
                         const ted4_view *v, const ted4_parallel *p, const float *d_image,
                         const ted4_splat_grads *g)
{
    if (ted4_raster_blend_bwd(a, r, v, p, d_image) != 0)
        return -1;
    ted4_raster_project_bwd(a, r, s, v, p, g);
    return 0;
}
