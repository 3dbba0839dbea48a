/* stage_judge.h - ends a stage, or the part of it before the next event, when pictures stand still.
 * The judge is held out inside the training split: groups of pictures rest in turns, each for a
 * window of a few rounds, and their loss after that tells what training gains on pictures that it
 * does not see. So no picture is lost to training, and cameras keep their colours and poses.
 * Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STAGE_JUDGE_H
#define TED4_STAGE_JUDGE_H

#include "train/state/trainer.h"

/* Divides the training pictures into groups. Does nothing if the option is 0, or if there are too
 * few pictures. Returns 0, or -1 with t->message. */
int ted4_judge_init(ted4_trainer *t);

/* Call after each step. Between two rounds, if a window is complete, measures the pictures that
 * have rested, decides, and lets the next group rest. If pictures stand still, the steps before the
 * next event of the schedule are left out: t->phase.left_out grows. Does nothing during trials.
 * Returns 0, or -1 with t->message. */
int ted4_judge_round(ted4_trainer *t);

#endif
