/* feature_pca.h - other axes for the feature: the same Gaussians from values of which the first say
 * most and the last least. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FEATURE_PCA_H
#define TED4_FEATURE_PCA_H

#include "train/state/trainer.h"

/* Features become their principal components as the heads see them, centred, in falling order, and
 * so scaled that a step of each is seen as much on average as a step of the features was before.
 * Networks that read or make features go along: what is drawn stays the same, but for roundings.
 * Without a prior, which would know other features: before stage 2 initialises it. 0, or -1 with
 * t->message. */
int ted4_feature_pca(ted4_trainer *t);

#endif
