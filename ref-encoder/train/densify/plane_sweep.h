/* plane_sweep.h - places at which several cameras agree about something that the model does not
 * show: see mv_seed.h. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PLANE_SWEEP_H
#define TED4_PLANE_SWEEP_H

#include "train/state/trainer.h"

/* A place in normalised space where something is missing. */
typedef struct {
    float point[3];
    uint8_t colour[3];
    uint32_t frame;
    float size;  /* distance of neighbouring places, normalised space */
    float score; /* agreement of the cameras times the error; larger is surer */
} ted4_place;

/* For qsort: by falling score; only places that are equal in everything compare as equal, so that
 * their order does not depend on how qsort works. */
int ted4_place_compare(const void *x, const void *y);

typedef struct {
    ted4_place *item; /* owned */
    size_t n, capacity;
} ted4_places;

/* So many places a sequence may have: each is looked for in all frames, and places times frames are
 * at most 2^27, four bytes each (photo_votes.h). Only long sequences come near. */
static inline size_t ted4_mv_seed_capacity(uint32_t n_frames)
{
    return ((size_t)1 << 27) / n_frames;
}

/* Adds places missing at a frame to the list, at most one a voxel of the place's size, and of long
 * sequences only the surest, its share of that number or one; in a fixed order. reach: how many
 * frames before and after it have pictures that help. 0, or -1 with t->message. */
int ted4_mv_seed_search(ted4_trainer *t, uint32_t frame, uint32_t reach, ted4_places *list);

#endif
