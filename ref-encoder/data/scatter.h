/* scatter.h - initial points where pictures show something, for scenes that came without points, or
 * with points of which most lie in empty space.
 * Depends on dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCATTER_H
#define TED4_SCATTER_H

#include "data/dataset.h"

typedef struct {
    uint32_t seed;
    int bounded;
    float low[3], high[3]; /* of a box of the world that has all points, if bounded */
} ted4_scatter_options;

/* What came of it. */
typedef struct {
    size_t given;     /* points that came with the scene and were replaced */
    size_t scattered; /* points in their place, or in place of random ones */
    size_t outside;   /* points that came with the scene and lie outside the bounds */
} ted4_scattered;

/* Of a verified dataset. A plain background of pictures without transparency becomes that of the
 * scene. Where points are random, or those given are of no use (useful.h), others take their place:
 * on the rays of pixels that show something, where most other pictures that look there show
 * something too. Held-out pictures are not looked at. Points outside the
 * bounds go. Same scene and options, same points, whatever the threads. 0, or -1 with *m filled:
 * no memory, a picture that cannot be read, or no point inside the bounds. */
int ted4_dataset_scatter(ted4_dataset *d, const ted4_scatter_options *o, const ted4_parallel *p,
                         ted4_scattered *what, ted4_message *m);

#endif
