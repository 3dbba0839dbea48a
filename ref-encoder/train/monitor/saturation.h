/* saturation.h - counts the values of anchors that are saturated, for the log. If many are, the
 * range is too narrow or training goes wrong. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SATURATION_H
#define TED4_SATURATION_H

#include "train/state/trainer.h"

/* Returns the number of values that are clamped where they are used: scalings at the ends of the
 * range of spec 11.1, durations at the floor of spec 11.4 and, as soon as there are step sizes,
 * values that no symbol can represent (spec 9.4). */
size_t ted4_saturated_values(const ted4_trainer *t);

#endif
