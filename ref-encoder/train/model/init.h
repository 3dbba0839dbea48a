/* init.h - initialisation: anchors from the initial points, networks from small random numbers.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INIT_H
#define TED4_INIT_H

#include "anchors.h"
#include "data/dataset.h"
#include "options.h"

/* Places anchors on the voxel grid of the points, at most `most` of them, which is 1 or more (the
 * voxel grows until they fit). cell: the voxel's edge length in scene units, 0: the points' typical
 * distance. *voxel is set to the edge length in the end, in normalised space. Returns 0, or -1 if
 * memory ran out. Source: paper, "Preliminary: ScaffoldGS". */
int ted4_init_anchors(ted4_anchors *a, const ted4_layout *l, const ted4_dataset *d, size_t most,
                      double cell, double *voxel);

/* Initialises the networks: weights uniform in +-1/sqrt(inputs), the last layer of F_deform zero,
 * and the bank N(0, 0.1), so that neither phi nor the bank starts at a saddle point (annex D.1,
 * traps). Every Gaussian starts with an opacity above zero where features are zero. NETE is left to
 * ted4_init_prior. */
void ted4_init_networks(float *net, const ted4_layout *l, uint32_t seed);

/* Initialises NETE: hidden layers are random; the last layer has small weights, and its biases are
 * the mean and the spread of each component over the anchors. */
void ted4_init_prior(float *net, const ted4_layout *l, const ted4_anchors *a, uint32_t seed);
/* Resets the hyperprior's outputs for one type of values: weights zero; biases give the mean and
 * spread of each component, and a step size of Q0. */
void ted4_init_prior_type(float *net, const ted4_layout *l, const ted4_anchors *a, int type);

#endif
