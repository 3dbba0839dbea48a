/* plane_sweep.h - finds places at which several cameras agree about something that the model fails
 * to render; see mv_seed.h. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PLANE_SWEEP_H
#define TED4_PLANE_SWEEP_H

#include "train/state/trainer.h"

/* A place in normalised space where something is missing. */
typedef struct {
    float point[3];
    uint8_t colour[3];
    uint32_t frame;
    float size;  /* spacing of neighbouring places, normalised space */
    float score; /* agreement of the cameras times the error; higher is more reliable */
} ted4_place;

/* For qsort: sorts by decreasing score. Only places that are equal in every member compare as
 * equal, so that their order does not depend on the qsort implementation. */
int ted4_place_compare(const void *x, const void *y);

typedef struct {
    ted4_place *item; /* owned */
    size_t n, capacity;
} ted4_places;

/* Appends the places that the model misses in one frame to the list, in a fixed order. It adds at
 * most one place per voxel of the place's size. In long sequences it keeps only the most reliable
 * ones, up to the frame's share of ted4_photo_votes_capacity, but at least one. Returns 0, or -1
 * with t->message filled. */
int ted4_mv_seed_search(ted4_trainer *t, uint32_t frame, ted4_places *list);

#endif
