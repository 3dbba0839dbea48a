/* mv_seed.h - new anchors where several cameras at one time agree about something that the model
 * does not show. Growth splits what is there, so something fast that no initial point stands for
 * never gets an anchor: its error pulls at the background, which is right at every other time. The
 * places are found as in plane sweeping: for pixels with a large error, depths are tried along the
 * ray, and the colour has to be found, with a large error, where other cameras of that time see the
 * point. Where cameras take turns, those of the times around it look, too (turns.h). Not in the
 * paper; needs three training cameras at a time or around it, and activation. Depends on trainer.h,
 * photo_votes.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPROUT_H
#define TED4_SPROUT_H

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

/* How many frames around a frame are searched with it (ted4_turns_reach); -1: there is no
 * activation, or there are not enough cameras. */
int ted4_sprout_reach(const ted4_trainer *t);

/* So many places a sequence may have: each is looked for in all frames, and places times frames are
 * at most 2^27, four bytes each (photo_votes.h). Only long sequences come near. */
static inline size_t ted4_sprout_room(uint32_t n_frames)
{
    return ((size_t)1 << 27) / n_frames;
}

/* Adds places missing at a frame to the list, at most one a cell of the place's size, and of long
 * sequences only the surest, its share of the room or one; in a fixed order. reach: how many frames
 * before and after it have pictures that help. 0, or -1 with t->message. */
int ted4_sprout_search(ted4_trainer *t, uint32_t frame, uint32_t reach, ted4_places *list);

/* All frames are searched, and anchors added at the surest places until max_anchors is reached,
 * each with the activation of the times at which its colour is seen there, and the features of the
 * anchor whose colour comes nearest. 0, or -1 with t->message. */
int ted4_sprout(ted4_trainer *t);

#endif
