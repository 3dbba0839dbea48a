/* grad_norm.h - measures the gradients of a step by term, and finds the anchor or the network that
 * caused an anomaly. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GRAD_NORM_H
#define TED4_GRAD_NORM_H

#include "train/state/trainer.h"

/* Measures one visible block, in one pass over numbers that the optimiser reads next. squares[0 ..
 * TED4_BLOCK_TERMS): sums of squared gradients over the channels with a rate > 0.
 * squares[TED4_BLOCK_TERMS]: 0, or 1 + the first term with a value that is not finite. values,
 * gradient: [n_channels][32]. */
void ted4_gradients_block(const ted4_layout *l, const float *rate, const float *values,
                          const float *gradient, float *squares);

/* Returns the Euclidean norm of n numbers. */
double ted4_gradients_norm(const float *x, size_t n);

/* Fills the norms of values and networks; call after ted4_update_parameters. A norm is not finite
 * if a gradient is not finite or if its square exceeds binary32. */
void ted4_gradients_gather(const ted4_trainer *t, double *norm);
/* Returns the first anchor, in the blocks of the picture, that had a value that was not finite
 * before the update; *term: its term. Returns -1 if there was none. */
int64_t ted4_gradients_bad_seen(const ted4_trainer *t, int *term);

/* Returns the anchor with a gradient that is not finite, or else the one with the largest
 * gradient, or -1 if the term has no anchors. *finite: 1 if all gradients are finite. All ranks
 * have to call it (exchange.h). */
int64_t ted4_gradients_anchor(const ted4_trainer *t, int term, int *finite);
/* Returns the first of all anchors with a value that is not finite, or -1 if there is none. *term:
 * the attribute, TED4_TERM_MASK, or TED4_TERM_CENTRE for the position. */
int64_t ted4_gradients_bad_value(const ted4_trainer *t, int *term);
/* Returns the term of the first network with a weight that is not finite: TED4_TERM_HEADS, MOTION,
 * BANK or PRIOR. */
int ted4_gradients_bad_network(const ted4_trainer *t);

#endif
