/* sweep.h - plane sweeping for single pixels: finds the depth at which other pictures show the same
 * colours as the neighbourhood of the pixel. Depends on shown.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SWEEP_H
#define TED4_SWEEP_H

#include "data/shown.h"

/* At most so many other pictures are compared with a pixel, at so many depths. */
enum { TED4_SWEEP_HELPERS = 8, TED4_SWEEP_DEPTHS = 256 };

typedef struct {
    const ted4_shown *shown;
    double nearest, farthest; /* range of depths; samples are uniform in inverse depth */
    /* agreed: patches agree if their mean absolute difference is at most this, in levels of 255 */
    double agreed;
    uint8_t helper[TED4_SHOWN_MOST][TED4_SWEEP_HELPERS];
    uint8_t n_helpers[TED4_SHOWN_MOST];
} ted4_sweep;

/* Prepares a sweep of the pictures of *s between the depths nearest and farthest. The helpers of a
 * picture are the nearest other cameras of its frame, or of any frame if its own has fewer than
 * two. Cameras nearer than 0.05 * ahead are not used: seen from the distance ahead, their rays
 * would be less than about 0.05 radians apart. The caller sets w->agreed. */
void ted4_sweep_begin(ted4_sweep *w, const ted4_shown *s, double ahead, double nearest,
                      double farthest);

/* Finds a point on the ray of a pixel of picture i at which the better half of the helpers that see
 * the point agree with the pixel and its four neighbours. u in [0, 1) chooses among depths that are
 * about equally good. Returns 1, or 0 if there is no such point or fewer than two helpers see
 * it. */
int ted4_sweep_pixel(const ted4_sweep *w, size_t i, size_t pixel, double u, double world[3]);

/* Does the better half of the helpers that see a point agree with the given pixel of picture i,
 * into which the point projects? Returns 0 also if fewer than two helpers see the point. */
int ted4_sweep_agrees(const ted4_sweep *w, size_t i, size_t pixel, const double world[3]);

/* Gives the point at depth z on the ray of a pixel, in world coordinates. */
void ted4_sweep_point(const ted4_camera *c, size_t pixel, double z, double world[3]);

#endif
