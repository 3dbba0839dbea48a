/* useful.h - decides whether the points that came with a scene lie on surfaces that its pictures
 * show. Depends on sweep.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_USEFUL_H
#define TED4_USEFUL_H

#include "data/sweep.h"

/* Do the points of the dataset of w help training? With a plain background, they do if most of them
 * lie where most pictures show foreground. Otherwise, they do if pictures agree at the depths of
 * points more often than at exchanged depths, which are those of other points; points of random
 * depth show no such difference. Returns 1 also if pictures mostly agree at both depths, or hardly
 * at either, since this decides nothing. */
int ted4_points_are_useful(const ted4_sweep *w, uint32_t seed);

#endif
