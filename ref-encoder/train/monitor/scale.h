/* scale.h - tracks the usual size of a number that is observed once per step. Depends on
 * state/monitor_state.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCALE_H
#define TED4_SCALE_H

#include "train/state/monitor_state.h"

/* Adds one number, x >= 0, to the scale. Returns x as a multiple of the usual size before it, or 0
 * while that is not known yet. x = 0 is ignored, and returns 0. */
double ted4_scale_take(ted4_scale *s, double x);
/* Returns the usual size, or 0 if there were no numbers. */
double ted4_scale_usual(const ted4_scale *s);

#endif
