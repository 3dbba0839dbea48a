/* stages.h - the changes between phases: the starts of activation, of stage 2 (compression) and of
 * the integer stage. Source: paper ("Progressive 3D-to-4D Anchor Transformation", "Training
 * Objectives"), annex D.1, D.2. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STAGES_H
#define TED4_STAGES_H

#include "train/state/trainer.h"

/* All functions that return int return 0, or -1 with t->message filled. */
int ted4_activation_begin(ted4_trainer *t);
int ted4_stage2_begin(ted4_trainer *t);
int ted4_integer_begin(ted4_trainer *t);

/* A dead anchor is one whose opacity is below prune_opacity even when its activation is highest, so
 * that no picture needs it. ted4_stage_live lists the numbers of all other anchors, live[n], in
 * order. ted4_stage_drop_dead removes dead anchors, so that stage 2 spends no bits on them; it is
 * an error if all are dead. */
int ted4_stage_live(ted4_trainer *t, uint32_t *live, size_t *n);
int ted4_stage_drop_dead(ted4_trainer *t);
/* In the integer stage, computes the step sizes of all anchors, and their bits [TED4_TYPES] by the
 * float formula on rounded symbols (NULL: step sizes only). */
int ted4_integer_rate(ted4_trainer *t, double *bits);
/* Converts the model, the optimiser's state and the statistics to the layout of h, which must have
 * the same heads and the same or fewer types of values. Afterwards, prior networks are zero. */
int ted4_stage_relayout(ted4_trainer *t, const ted4_header *h);

#endif
