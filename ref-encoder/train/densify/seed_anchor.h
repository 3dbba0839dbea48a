/* seed_anchor.h - the first values of an anchor that seeding adds (mv_seed.h, sv_seed.h). Depends
 * on trainer.h, photo_votes.h, plane_sweep.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SEED_ANCHOR_H
#define TED4_SEED_ANCHOR_H

#include "photo_votes.h"
#include "plane_sweep.h"

/* The anchors before seeding, and their appearance (ted4_anchor_appearance). */
typedef struct {
    float *rgb, *opacity; /* owned: [n][3], [n] */
    size_t n;
} ted4_seed_parents;

/* Returns 0, or -1 with t->message filled; free l in either case. */
int ted4_seed_parents_measure(ted4_trainer *t, ted4_seed_parents *l);
void ted4_seed_parents_free(ted4_seed_parents *l);

/* Adds an anchor at a place, behind all others. It is active during the span. It takes its features
 * from the opaque parent with the most similar colour, and its motion from the nearest parent.
 * Returns 0, or -1 with t->message filled. */
int ted4_seed_add(ted4_trainer *t, const ted4_seed_parents *l, const ted4_place *p,
                  const ted4_span *span);

#endif
