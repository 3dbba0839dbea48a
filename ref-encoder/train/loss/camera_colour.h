/* camera_colour.h - colour correction of training pictures: an affine colour map per physical
 * camera, learnt together with the scene and not stored in the file. The rendered colour c, a row
 * vector, becomes c (I + A) + v before it is compared with the picture. Without it, cameras that
 * disagree about colours make the scene change colour with the viewing direction, which costs bits
 * and is wrong in all other views. Source: paper ("colour correction"), which does not give the
 * form. Depends on data/dataset.h, base/parallel.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_COLOUR_H
#define TED4_CAMERA_COLOUR_H

#include <stddef.h>
#include <stdint.h>

#include "base/parallel.h"
#include "camera_exposure.h"
#include "data/dataset.h"

/* Values of one camera: A by rows (row: input colour, column: output colour), then, from
 * TED4_COLOUR_ROW_V on, v. */
enum { TED4_COLOUR_VALUES = 12, TED4_COLOUR_ROW_V = 9 };

typedef float ted4_colour_map[TED4_COLOUR_VALUES];

/* The colours of the scene and the maps of all cameras could change together without changing any
 * picture, but novel views get no correction. So the maps of the corrected cameras always have the
 * same middle, which is the identity unless the initial points tell otherwise
 * (camera_colour_init.h). The middle of each value is the mean over those cameras that lie between
 * the outer quarters, so that a camera far from the others does not drag the scene along. */
typedef struct {
    size_t n_cameras;   /* cameras of the dataset; 0: nothing is corrected and no memory is held */
    size_t n_corrected; /* corrected cameras: 0, or at least 2 */
    int matched;        /* 1 if cameras differ and their maps were initialised before training
                           (camera_colour_init.h) */
    uint8_t *corrected; /* owned, [n_cameras] 0 or 1 */
    uint64_t *steps;    /* owned, [n_cameras] number of Adam steps */
    ted4_colour_map *value, *m, *v; /* owned, [n_cameras]; m, v: Adam's moments */
    ted4_colour_map middle;         /* the middle that all maps keep */
    ted4_exposure exposure;         /* none unless exposures change (camera_exposure_init.h) */
    double exposure_change;         /* how much they change, as a share; 0: not looked for */
    float *image;  /* owned: the corrected picture, planar, sized for the largest picture */
    uint8_t *seen; /* owned: a true picture in the scene's colours, interleaved */
    double *sums;  /* owned: gradients per band of pixels */
    float *sorted; /* owned, [n_cameras] */
} ted4_colour;

/* Initialises all maps to the identity. A camera is corrected if it took at least two training
 * pictures and another camera did, too: a single picture tells nothing about a camera that the
 * scene could not represent as well. Returns 0, or -1 if memory ran out (ted4_colour_finish is safe
 * even then). */
int ted4_colour_init(ted4_colour *c, const ted4_dataset *d);
void ted4_colour_finish(ted4_colour *c);

/* Moves the middle of all maps back to c->middle. */
void ted4_colour_centre(ted4_colour *c);

/* Changes the gauge: from now on, what the scene shows as colour x is gain times x, per channel;
 * corrected pictures do not change. gain [3]: each above 0. */
void ted4_colour_regauge(ted4_colour *c, const double *gain);

/* Computes (I + A)^-1 of a map, by rows. Returns 0, or -1 if the map is nearly singular, so that
 * noise would dominate. */
int ted4_colour_invert(const float *map, double inverse[9]);

/* Returns whether a camera is corrected. */
int ted4_colour_has(const ted4_colour *c, uint32_t camera);

/* Returns whether all maps are finite. */
int ted4_colour_finite(const ted4_colour *c);

/* Sets map to what a camera makes of colours at a time: its own map, times the gain of each channel
 * (camera_exposure.h). */
void ted4_colour_at(const ted4_colour *c, uint32_t camera, uint32_t frame, ted4_colour_map map);

/* gradient: in: dL/d(map of ted4_colour_at), out: dL/d(the camera's own map). Sets d_gain[3] to
 * dL/d(gains). */
void ted4_colour_split(const ted4_colour *c, uint32_t camera, uint32_t frame,
                       ted4_colour_map gradient, float d_gain[3]);

/* The functions below take a map, [TED4_COLOUR_VALUES], and room of c. */

/* Returns the corrected picture, planar [3][pixels] like image; valid until the next call. */
const float *ted4_colour_apply(ted4_colour *c, const float *map, const float *image, size_t pixels,
                               const ted4_parallel *p);

/* Returns a true picture, interleaved bytes [pixels][3], in the scene's colours: (c - v) (I +
 * A)^-1, clamped to 0..255 and rounded. Returns the picture unchanged if the map is nearly
 * singular. Valid until the next call. */
const uint8_t *ted4_colour_undo(ted4_colour *c, const float *map, const uint8_t *picture,
                                size_t pixels, const ted4_parallel *p);

/* image: as passed to ted4_colour_apply. d_image: planar; in: dL/d(corrected picture), out:
 * dL/d(image). gradient: dL/d(map), overwritten. Results are bit-identical for any number of
 * threads. */
void ted4_colour_backward(ted4_colour *c, const float *map, const float *image, size_t pixels,
                          const ted4_parallel *p, float *d_image, ted4_colour_map gradient);

#endif
