/* scale.h - the usual size of a number that comes once a step. Depends on state/monitor_state.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCALE_H
#define TED4_SCALE_H

#include "train/state/monitor_state.h"

/* x > 0: of the scale's numbers. Returns x as a multiple of the usual size before it; 0 while that
 * is not known yet, and for x = 0, which is passed over. */
double ted4_scale_take(ted4_scale *s, double x);
/* 0 where there were no numbers. */
double ted4_scale_usual(const ted4_scale *s);

#endif
