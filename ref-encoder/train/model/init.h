/* init.h - where training starts: anchors from the initial points, networks from small random
 * numbers.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INIT_H
#define TED4_INIT_H

#include "anchors.h"
#include "data/dataset.h"
#include "options.h"

/* Anchors on the voxel grid of the points, at most init_anchors of them (the voxel grows until they
 * fit); *voxel: its edge, in normalised space. 0, or -1: no memory. Source: paper, "Preliminary:
 * ScaffoldGS". */
int ted4_init_anchors(ted4_anchors *a, const ted4_layout *l, const ted4_dataset *d,
                      const ted4_train_options *o, double *voxel);

/* Weights uniform in +-1/sqrt(inputs), the last layer of F_deform zero, the bank N(0, 0.1), so that
 * neither of phi and bank is a saddle (annex D.1, traps). Every Gaussian begins with an opacity
 * above zero where features are zero. NETE is left to ted4_init_prior. */
void ted4_init_networks(float *net, const ted4_layout *l, uint32_t seed);

/* NETE: hidden layers random; the last layer's weights small, its biases the mean and the spread of
 * each component over the anchors. */
void ted4_init_prior(float *net, const ted4_layout *l, const ted4_anchors *a, uint32_t seed);
/* The hyperprior's outputs for one type of values, without weights: mean and spread of each
 * component, and a step of Q0. */
void ted4_init_prior_type(float *net, const ted4_layout *l, const ted4_anchors *a, int type);

#endif
