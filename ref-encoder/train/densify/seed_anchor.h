/* seed_anchor.h - the first values of anchors that seeding adds (mv_seed.h, sv_seed.h). Depends on
 * trainer.h, photo_votes.h, plane_sweep.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SEED_ANCHOR_H
#define TED4_SEED_ANCHOR_H

#include "photo_votes.h"
#include "plane_sweep.h"

/* The anchors before seeding, the parents, with their appearance (ted4_anchor_appearance), and what
 * is known of the anchors that follow them. */
typedef struct {
    float *rgb, *opacity; /* owned: [n_parents][3], [n_parents] */
    size_t n_parents;
    uint32_t *frame; /* owned: [n_added] in which the place of anchor n_parents + i was found */
    size_t n_added, room;
} ted4_seeding;

/* Measures the parents. Returns 0, or -1 with t->message filled; finish in either case. */
int ted4_seeding_begin(ted4_trainer *t, ted4_seeding *s);
void ted4_seeding_finish(ted4_seeding *s);

/* Adds an anchor at a place, behind all others. It is active during the span. It takes its features
 * from the opaque parent with the most similar colour, and its motion from the nearest parent.
 * Returns 0, or -1 with t->message filled. */
int ted4_seeding_add(ted4_trainer *t, ted4_seeding *s, const ted4_place *p, const ted4_span *span);

/* Moves all added anchors so that they are shown at their places in the frames of these, which must
 * be in order: the motion that they took moves them elsewhere, before one camera by more than their
 * size as a rule, where they would learn to vanish. Where the motion itself depends on the position
 * (TED4_MOTION_INR), it is that of the place. The mask of motion of an anchor that would have to
 * leave the cube is closed instead. Returns 0, or -1 with t->message filled. */
int ted4_seeding_settle(ted4_trainer *t, const ted4_seeding *s);

#endif
