/* align.h - fits the pose of a camera to its picture, so that a scene can be judged apart from how
 * well that pose is known. The picture is a checkerboard of tiles of TED4_ALIGN_TILE pixels: the
 * pose is fitted on the tiles of one colour, and the scene is judged on those of the other one,
 * which the fit has not seen. Nothing else changes. Depends on data/dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ALIGN_H
#define TED4_ALIGN_H

#include "data/dataset.h"

enum { TED4_ALIGN_TILE = 8 };

/* Draws the scene as camera sees it: rgb, [height][width][3]. Returns 0, or else a number above 0
 * that ends the fit. */
typedef int (*ted4_align_draw)(void *user, const ted4_camera *camera, uint8_t *rgb);

/* Fits the pose by least squares, from the given one on. distance, above 0: roughly, of what is
 * seen; a translation by it counts as a turn by one radian. truth: [height][width][3]. *aligned:
 * the given camera at the fitted pose. Returns 0, -1 if memory ran out, or what draw returned if
 * that was not 0. */
int ted4_align(const ted4_camera *given, double distance, const uint8_t *truth,
               ted4_align_draw draw, void *user, ted4_camera *aligned);

/* Returns the PSNR of ours in the half that is judged, in dB; INFINITY if it equals the truth. */
double ted4_align_psnr(const uint8_t *truth, const uint8_t *ours, int width, int height);

#endif
