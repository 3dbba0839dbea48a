/* saturation.h - how many values of anchors stand at an end of their range, for the log: where many
 * do, the range is too narrow or training goes wrong. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SATURATION_H
#define TED4_SATURATION_H

#include "train/state/trainer.h"

/* Values that are held where they are used: sizes at the ends of spec 11.1, durations at the floor
 * of spec 11.4 and, once there are step sizes, what no symbol holds (spec 9.4). */
size_t ted4_saturated_values(const ted4_trainer *t);

#endif
