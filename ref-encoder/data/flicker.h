/* flicker.h - measures whether the light of a scene changes from picture to picture. Source: ours.
 * Depends on dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FLICKER_H
#define TED4_FLICKER_H

#include "data/dataset.h"

/* Returns a measure of flicker, in levels of 255: how far the mean level of a picture is from the
 * midpoint of its predecessor and successor from the same camera, as the median over all training
 * pictures that have both. The median ignores objects that appear or disappear, and light that only
 * increases or only decreases. Returns 0 if no picture has both neighbours, and NAN if memory runs
 * out. Call it after ted4_dataset_verify.
 * A bank with one row for every second time interpolates half-way between two rows. That is enough
 * for motion, but not for a lamp that alternates between brighter and darker. */
double ted4_dataset_flicker(const ted4_dataset *d);

/* From this flicker on, the bank needs a row for every time. */
#define TED4_FLICKER_SEEN 3.0

#endif
