/* raster_bwd.c - see raster_bwd.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "adjoint.h"

int ted4_raster_blend_bwd(struct ted4_raster *r, const ted4_view *v, const ted4_parallel *p,
                          const float *d_image)
{
    return TED4_IN_USE(ted4_raster_blend_bwd)(r, v, p, d_image);
}

void ted4_raster_project_bwd(struct ted4_raster *r, const ted4_splats *s, const ted4_view *v,
                             const ted4_parallel *p, const ted4_splat_grads *g)
{
    TED4_IN_USE(ted4_raster_project_bwd)(r, s, v, p, g);
}

int ted4_raster_backward(ted4_raster *r, const ted4_splats *s, const ted4_view *v,
                         const ted4_parallel *p, const float *d_image, const ted4_splat_grads *g)
{
    if (ted4_raster_blend_bwd(r, v, p, d_image) != 0)
        return -1;
    ted4_raster_project_bwd(r, s, v, p, g);
    return 0;
}
