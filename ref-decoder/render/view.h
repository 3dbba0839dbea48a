/* view.h - renders a view of a decoded scene: runs the query, rasterises the Gaussians and rounds
 * the image to 8 bits. Informative (annex I). Depends on ted4.h, raster.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_H
#define TED4_VIEW_H

#include "raster.h"
#include "ted4.h"

/* The near plane: Gaussians at or before this depth are not drawn. In units of normalised space
 * (spec 11.1). */
#define TED4_VIEW_NEAR 0.02

/* The rasteriser's workspace and an image, reused from view to view. */
typedef struct ted4_viewer ted4_viewer;

ted4_viewer *ted4_viewer_new(void);    /* owned by the caller; NULL: out of memory */
void ted4_viewer_free(ted4_viewer *v); /* v may be NULL */

/* Renders time num / den through camera. near_z and background of the camera are ignored; they
 * follow from info. Returns TED4_OK with rgb filled, as [height][width][3] with colours clamped to
 * [0, 1] and rounded; or an error of ted4_recon_query; or TED4_E_LIMIT_MEMORY. */
ted4_status ted4_render_query(ted4_viewer *v, ted4_recon *r, const ted4_info *info, uint32_t num,
                              uint32_t den, const ted4_view *camera, const ted4_parallel *p,
                              uint8_t *rgb);
/* These two are the steps of ted4_render_query, for callers that change the Gaussians in between:
 * the first runs ted4_recon_query for the centre of the camera, the second renders its result. */
ted4_status ted4_query_for_view(ted4_recon *r, uint32_t num, uint32_t den, const ted4_view *camera,
                                const ted4_parallel *p, ted4_gaussians *g);
ted4_status ted4_render_gaussians(ted4_viewer *v, const ted4_gaussians *g, const ted4_info *info,
                                  const ted4_view *camera, const ted4_parallel *p, uint8_t *rgb);

#endif
