/* view.h - a picture of a decoded scene: query, rasterise, round to 8 bits. Informative (annex I).
 * Depends on ted4.h, raster.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_H
#define TED4_VIEW_H

#include "raster.h"
#include "ted4.h"

/* Nearest depth that is drawn, in units of normalised space (spec 11.1). */
#define TED4_VIEW_NEAR 0.02

/* Raster workspace and image, reused from view to view. */
typedef struct ted4_viewer ted4_viewer;

ted4_viewer *ted4_viewer_new(void);    /* NULL: no memory */
void ted4_viewer_free(ted4_viewer *v); /* NULL is fine */

/* Time num / den through camera; its near_z and background are not looked at: they follow from
 * info. rgb: [height][width][3], colours
 * clamped to [0, 1] and rounded. TED4_OK, what ted4_recon_query says, or TED4_E_LIMIT_MEMORY.
 * The same in two steps, for pictures of changed Gaussians: query, as ted4_recon_query answers it
 * for that camera's centre, and drawing. */
ted4_status ted4_render_query(ted4_viewer *v, ted4_recon *r, const ted4_info *info, uint32_t num,
                              uint32_t den, const ted4_view *camera, const ted4_parallel *p,
                              uint8_t *rgb);
ted4_status ted4_query_for_view(ted4_recon *r, uint32_t num, uint32_t den, const ted4_view *camera,
                                const ted4_parallel *p, ted4_gaussians *g);
ted4_status ted4_render_gaussians(ted4_viewer *v, const ted4_gaussians *g, const ted4_info *info,
                                  const ted4_view *camera, const ted4_parallel *p, uint8_t *rgb);

#endif
