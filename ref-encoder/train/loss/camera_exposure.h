/* camera_exposure.h - how the colours of a camera change over time, as its exposure and white
 * balance do: a gain per channel for each camera, linear between a few knots in time, learnt
 * together with the scene and not stored in the file. It multiplies what the camera's map
 * (camera_colour.h) makes of a colour. Source: ours. Depends on data/dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_EXPOSURE_H
#define TED4_CAMERA_EXPOSURE_H

#include <stddef.h>
#include <stdint.h>

#include "data/dataset.h"

/* A knot for so many training pictures of a camera, and the most knots. */
enum { TED4_EXPOSURE_PICTURES = 4, TED4_EXPOSURE_KNOTS = 17 };

/* A change of colour at a time that all cameras share is one of the scene's light. A change of one
 * camera that others do not see is one of that camera. So the middle of the gains at a knot, over
 * the cameras that have training pictures near it, is always 1 (camera_colour.h says which middle);
 * a camera that is alone at a knot has gain 1 there: nothing could tell its exposure from the
 * light, not even smoothness, since light may change as smoothly. */
typedef struct {
    size_t n_cameras, n_knots; /* 0: exposures are not corrected and no memory is held */
    double knots_per_time;
    uint8_t *near; /* owned, [n_cameras][n_knots] 1: the camera has training pictures there */
    /* owned, [3][n_cameras][n_knots][3]: gain less 1, then Adam's moments */
    float *value, *m, *v; /* m and v lie in value's memory */
    float *gradient;      /* owned, [n_knots][3] */
    uint64_t *steps;      /* owned, [n_cameras] number of Adam steps */
    float *sorted;        /* owned, [n_cameras] */
} ted4_exposure;

/* All gains begin as 1. corrected: [d->n_cameras] 1: the camera takes part. The number of knots
 * follows from the mean number of training pictures of these cameras; it is 0 if that is less than
 * two knots need. Returns 0, or -1 if memory ran out (ted4_exposure_finish is safe even then). */
int ted4_exposure_init(ted4_exposure *e, const ted4_dataset *d, const uint8_t *corrected);
void ted4_exposure_finish(ted4_exposure *e);

/* Sets gain[3] to the gains of a camera at a time, less 1. n_knots must be above 0. */
void ted4_exposure_at(const ted4_exposure *e, uint32_t camera, uint32_t frame, float gain[3]);

/* Overwrites e->gradient with dL/d(value) of a camera, where L is a loss with d_gain[3] = dL/d(gain
 * at frame), plus smoothness times the sum of squared second differences between knots, plus size
 * times the sum of squares. */
void ted4_exposure_backward(ted4_exposure *e, uint32_t camera, uint32_t frame, const float *d_gain,
                            double smoothness, double size);

/* Moves the middle of the gains at each knot back to 1. */
void ted4_exposure_centre(ted4_exposure *e);

/* Returns the weight that a time gives to a knot, 0 to 1; those of all knots sum to 1. */
double ted4_exposure_weight(const ted4_exposure *e, size_t knot, uint32_t frame);

/* Returns whether all gains are finite. */
int ted4_exposure_finite(const ted4_exposure *e);

#endif
