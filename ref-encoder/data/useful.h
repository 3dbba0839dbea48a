/* useful.h - whether the points that came with a scene lie on what its pictures show, or anywhere.
 * Depends on sweep.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_USEFUL_H
#define TED4_USEFUL_H

#include "data/sweep.h"

/* Do the points of the dataset that w looks at help training? Before a plain background: when most
 * of them lie where most pictures show something. Elsewhere: when pictures agree at the depths of
 * points more often than at the depths of other points in their place, as they do not where depths
 * are random. 1 where pictures agree at both or at neither, which tells nothing. */
int ted4_points_are_useful(const ted4_sweep *w, uint32_t seed);

#endif
