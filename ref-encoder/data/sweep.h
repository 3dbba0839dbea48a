/* sweep.h - how far away a pixel's surface is: the depth at which other pictures show what is
 * around it, too, as in plane sweeping, a pixel at a time.
 * Depends on shown.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SWEEP_H
#define TED4_SWEEP_H

#include "data/shown.h"

/* Pictures that a pixel is looked for in, and depths tried. */
enum { TED4_SWEEP_HELPERS = 8, TED4_SWEEP_DEPTHS = 256 };

typedef struct {
    const ted4_shown *shown;
    double nearest, farthest; /* depths, spaced evenly by their inverse */
    double agreed;            /* levels of 255 that patches may be off, in the mean */
    uint8_t helper[TED4_SHOWN_MOST][TED4_SWEEP_HELPERS];
    uint8_t n_helpers[TED4_SHOWN_MOST];
} ted4_sweep;

/* Chooses for each picture the nearest others of its time (where a time has too few, of any), at
 * angles of 0.05 or more as seen from a distance ahead. */
void ted4_sweep_begin(ted4_sweep *w, const ted4_shown *s, double ahead, double nearest,
                      double farthest);

/* A point on the ray of a pixel of picture i, where the better half of the pictures that look
 * there agree with its colour and those of its neighbours; u in [0, 1) chooses among depths that
 * are equally good. 0: there is none, or fewer than two pictures look there. */
int ted4_sweep_pixel(const ted4_sweep *w, size_t i, size_t pixel, double u, double world[3]);

/* Do the better half of the pictures that look there agree about the point with that pixel of
 * picture i which it lies in? 0: no, or fewer than two pictures look there. */
int ted4_sweep_agrees(const ted4_sweep *w, size_t i, size_t pixel, const double world[3]);

/* The point at depth z on the ray of a pixel. */
void ted4_sweep_point(const ted4_camera *c, size_t pixel, double z, double world[3]);

#endif
