/* flicker.h - does the light of a scene change with every picture? Source: ours.
 * Depends on dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FLICKER_H
#define TED4_FLICKER_H

#include "data/dataset.h"

/* A bank with a row for every second time says what lies half-way between two rows: enough for what
 * moves, not for a lamp that is brighter, then darker, then brighter. So: how far the mean level of
 * a picture lies from the middle of the ones before and after it of the same camera, in levels of
 * 255; the median over all training pictures that have both, so that things that pop in or out do
 * not count, nor light that only goes up or down. 0 where no picture has both. After
 * ted4_dataset_verify. NAN: no memory. */
double ted4_dataset_flicker(const ted4_dataset *d);

/* Light that flickers by at least so many levels wants a row of the bank for every time. */
#define TED4_FLICKER_SEEN 3.0

#endif
