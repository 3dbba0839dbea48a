/* error_view.h - what the searches for missing content need of one training picture: its view, its
 * colours, and the error of the model (mv_seed.h, sv_seed.h). Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ERROR_VIEW_H
#define TED4_ERROR_VIEW_H

#include "train/state/trainer.h"

/* A pixel misses something if its error, averaged over the channels, is at least this, of 255. A
 * pixel that confirms it needs at least half of that. */
#define TED4_MISSING      24
/* Distance of the tested pixels, as a share of the picture's width. */
#define TED4_VIEW_SPACING (1.0f / 120.0f)

typedef struct {
    ted4_view view;
    float centre[3];         /* of the camera, normalised space */
    float nearest, farthest; /* range of the tested depths, normalised space */
    uint8_t *rgb, *error;    /* owned: [pixels][3], [pixels]; 0 to 255 */
} ted4_error_view;

/* Loads training picture item and renders the model's view of it, both in the scene's colours.
 * Leaves the rendered picture in t->work.image. Returns 0, or -1 with t->message filled; close it
 * in either case. *e must be zero. */
int ted4_error_view_open(ted4_trainer *t, size_t item, ted4_error_view *e);
void ted4_error_view_close(ted4_error_view *e);

/* Returns the distance of the tested pixels of a picture, in pixels, at least 1. */
int ted4_view_spacing(int width);

#endif
