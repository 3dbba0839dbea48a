/* camera_colour.h - colour correction of training pictures: an affine map of colours for each
 * physical camera, learnt beside the scene and left out of the file. The rendered colour c, a row,
 * becomes c (I + A) + v before it is compared with the picture. Cameras that disagree about colours
 * otherwise teach the scene to change colour with the direction of view, which costs bits and is
 * wrong from everywhere else. Source: paper ("colour correction"), which does not say the form.
 * Depends on data/dataset.h, base/parallel.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_COLOUR_H
#define TED4_CAMERA_COLOUR_H

#include <stddef.h>
#include <stdint.h>

#include "base/parallel.h"
#include "data/dataset.h"

/* Values of one camera: A by rows (row: colour that goes in, column: colour that comes out), then
 * v. */
enum { TED4_COLOUR_VALUES = 12 };

typedef float ted4_colour_map[TED4_COLOUR_VALUES];

/* A scene's colours and all cameras' maps could change together without changing any picture; a
 * view from elsewhere gets no correction. So the maps of the corrected cameras always have the same
 * middle, which is the identity unless initial points know better (camera_colour_init.h): of each
 * value the mean of that half of the cameras that lies between the outer quarters, so that a camera
 * far off the others does not pull the scene along. */
typedef struct {
    size_t n_cameras;   /* of the dataset; 0: nothing is corrected, and no memory held */
    size_t n_corrected; /* cameras with a correction: 0, or at least 2 */
    int matched; /* cameras differ, and how was known before training (camera_colour_init.h) */
    uint8_t *corrected;             /* owned, [n_cameras] 0 or 1 */
    uint64_t *steps;                /* owned, [n_cameras] steps of Adam */
    ted4_colour_map *value, *m, *v; /* owned, [n_cameras]; m, v: Adam's moments */
    ted4_colour_map middle;         /* of all maps, always */
    float *image;  /* owned: the corrected picture, planar, of the largest picture */
    uint8_t *seen; /* owned: a picture in the scene's colours, interleaved */
    double *sums;  /* owned: gradients by bands of pixels */
    float *sorted; /* owned, [n_cameras] */
} ted4_colour;

/* All maps the identity. A camera is corrected when it took at least two training pictures and
 * another did, too: a single picture says nothing about a camera that the scene could not say as
 * well. 0, or -1: no memory (ted4_colour_finish is still safe). */
int ted4_colour_init(ted4_colour *c, const ted4_dataset *d);
void ted4_colour_finish(ted4_colour *c);

/* Brings the middle of all maps back to c->middle. */
void ted4_colour_centre(ted4_colour *c);

/* What the scene shows as colour x is gain times x, by channel, from now on; pictures of corrected
 * cameras stay as they are. gain [3]: above 0. */
void ted4_colour_regauge(ted4_colour *c, const double *gain);

/* (I + A)^-1 of a map, by rows. -1: it can hardly be turned round, and noise would take over. */
int ted4_colour_invert(const float *map, double inverse[9]);

/* Is this camera corrected? */
int ted4_colour_has(const ted4_colour *c, uint32_t camera);

/* Are all maps, and their middle? */
int ted4_colour_finite(const ted4_colour *c);

/* The corrected picture, planar [3][pixels] as image; valid until the next call. */
const float *ted4_colour_apply(ted4_colour *c, uint32_t camera, const float *image, size_t pixels,
                               const ted4_parallel *p);

/* A true picture, interleaved bytes [pixels][3], in the scene's colours: (c - v) (I + A)^-1,
 * limited to 0..255 and rounded; as it is where the map can hardly be turned round. Valid until the
 * next call. */
const uint8_t *ted4_colour_undo(ted4_colour *c, uint32_t camera, const uint8_t *picture,
                                size_t pixels, const ted4_parallel *p);

/* image: as given to ted4_colour_apply. d_image: planar, in: dL/d(corrected picture), out:
 * dL/d(image). gradient: dL/d(map), overwritten. Same bits for any number of threads. */
void ted4_colour_backward(ted4_colour *c, uint32_t camera, const float *image, size_t pixels,
                          const ted4_parallel *p, float *d_image, ted4_colour_map gradient);

#endif
