/* stages.h - what changes between phases: activation starts, compression starts, the integer model
 * takes over. Source: paper ("Progressive 3D-to-4D Anchor Transformation", "Training Objectives"),
 * annex D.1, D.2. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STAGES_H
#define TED4_STAGES_H

#include "train/state/trainer.h"

/* All that return int return 0, or -1 with t->message. */
int ted4_activation_begin(ted4_trainer *t);
int ted4_stage2_begin(ted4_trainer *t);
int ted4_integer_begin(ted4_trainer *t);

/* Live anchors: the numbers of those that are not dead, live[n], in order. The opacity of a dead
 * one is below prune_opacity even when it is there most, so that no picture would miss it. And:
 * dead anchors are dropped, before stage 2, which would pay for them; it is an error if all are. */
int ted4_stage_live(ted4_trainer *t, uint32_t *live, size_t *n);
int ted4_stage_drop_dead(ted4_trainer *t);
/* Once the integer stage has begun: steps of all anchors, and their bits [TED4_TYPES] by the float
 * formula on rounded symbols (NULL: steps only). */
int ted4_integer_rate(ted4_trainer *t, double *bits);
/* The model in the layout of h, which has the same heads and the same or fewer types of values;
 * optimiser and statistics go along. Prior networks are zero afterwards. */
int ted4_stage_relayout(ted4_trainer *t, const ted4_header *h);

#endif
