/* feature_pca.h - rotates the feature space so that the first components matter most and the last
 * ones least, without changing the Gaussians. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FEATURE_PCA_H
#define TED4_FEATURE_PCA_H

#include "train/state/trainer.h"

/* Replaces the features by their principal components as the heads see them: centred, in decreasing
 * order, and scaled so that one step of each component has, on average, the same visible effect as
 * one step of the old features. The networks that read or produce features are adapted, so
 * rendering does not change except for rounding. Must be called before stage 2 initialises the
 * prior, which would assume the old features. Returns 0, or -1 with t->message filled. */
int ted4_feature_pca(ted4_trainer *t);

#endif
