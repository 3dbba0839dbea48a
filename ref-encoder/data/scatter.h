/* scatter.h - places initial points on what the pictures show, for scenes without points or with
 * points that lie mostly in empty space. Depends on dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCATTER_H
#define TED4_SCATTER_H

#include "data/dataset.h"

typedef struct {
    uint32_t seed;
    int bounded;
    float low[3], high[3]; /* if bounded: box in world coordinates that contains all points */
} ted4_scatter_options;

/* Result of ted4_dataset_scatter. */
typedef struct {
    size_t given;     /* points of the scene that were replaced */
    size_t scattered; /* new points, which replace those of the scene or random ones */
    size_t outside;   /* points of the scene that lie outside the bounds */
} ted4_scattered;

/* Gives a verified dataset better initial points. Points that are random, or not useful (useful.h),
 * are replaced by points on the rays of foreground pixels, placed where most of the other pictures
 * that see them show foreground too. Points outside the bounds are removed. If pictures without
 * transparency have a plain background, it becomes the background of the scene. Held-out pictures
 * are not used. The result depends only on the scene and the options, not on the number of threads.
 * Returns 0, or -1 with *m filled if memory runs out, a picture cannot be read, or no point lies
 * inside the bounds. */
int ted4_dataset_scatter(ted4_dataset *d, const ted4_scatter_options *o, const ted4_parallel *p,
                         ted4_scattered *what, ted4_message *m);

#endif
