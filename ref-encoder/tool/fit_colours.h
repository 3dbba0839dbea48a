/* fit_colours.h - fits a colour map (train/loss/camera_colour.h) for each camera, from what the
 * decoded file shows to what the camera's training pictures show. A file has one look, which is
 * that of no single camera if cameras differ in colour; held-out pictures of a camera that are
 * compared through its map are judged apart from that. Depends on data/dataset.h,
 * train/loss/camera_colour.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FIT_COLOURS_H
#define TED4_FIT_COLOURS_H

#include "data/dataset.h"
#include "train/loss/camera_colour.h"

/* A map is fitted to at most this many training pictures, spread evenly over all of the camera. */
enum { TED4_FIT_PICTURES = 16 };

typedef struct {
    ted4_colour_map map;
    size_t pictures; /* training pictures that it was fitted to; 0: the camera has none, no map */
} ted4_fitted_colours;

/* Draws picture i of the dataset as the file shows it: rgb, [height][width][3]. Returns 0, or else
 * a number above 0 that ends the fit. */
typedef int (*ted4_fit_draw)(void *user, size_t i, uint8_t *rgb);

/* Fits the maps of all cameras that have a picture with this is_test. of: [d->n_cameras]. Returns
 * 0; or -1 with *m filled if a picture cannot be read or memory ran out; or what draw returned if
 * that was not 0. */
int ted4_fit_colours(ted4_dataset *d, int is_test, ted4_fit_draw draw, void *user,
                     ted4_fitted_colours *of, ted4_message *m);

/* Returns the PSNR of ours, seen through the map and clamped to 0 .. 255, in dB; INFINITY if it
 * equals the truth. truth, ours: [pixels][3]. */
double ted4_fitted_psnr(const ted4_colour_map map, const uint8_t *truth, const uint8_t *ours,
                        size_t pixels);

#endif
