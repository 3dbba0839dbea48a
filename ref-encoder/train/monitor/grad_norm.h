/* grad_norm.h - the sizes of a step's gradients by term, and whose fault one is.
 * Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GRAD_NORM_H
#define TED4_GRAD_NORM_H

#include "train/state/trainer.h"

/* Of one visible block, in one pass over numbers that the optimiser reads next:
 * squares[TED4_BLOCK_TERMS] sums of squared gradients over the channels with a rate > 0, then 0, or
 * 1 + the first term with a value that is not finite. values, gradient: [n_channels][32]. */
void ted4_gradients_block(const ted4_layout *l, const float *rate, const float *values,
                          const float *gradient, float *squares);

/* Norm of n numbers. */
double ted4_gradients_norm(const float *x, size_t n);

/* Fills the norms of values and networks, after ted4_update_parameters; not finite where a gradient
 * is not, or its square is beyond binary32. */
void ted4_gradients_gather(const ted4_trainer *t, double *norm);
/* Of the blocks in the picture, the first anchor that had a value that was not finite before the
 * update, and its term. -1: there was none. */
int64_t ted4_gradients_bad_seen(const ted4_trainer *t, int *term);

/* The anchor with a gradient that is not finite, or else the largest one; -1: the term has no
 * anchors. *finite: is there none? */
int64_t ted4_gradients_anchor(const ted4_trainer *t, int term, int *finite);
/* Of all anchors the first with a value that is not finite, and its attribute, TED4_TERM_MASK, or
 * TED4_TERM_CENTRE for its position. -1: there is none. */
int64_t ted4_gradients_bad_value(const ted4_trainer *t, int *term);
/* The first network with a weight that is not finite: TED4_TERM_HEADS, MOTION, BANK or PRIOR. */
int ted4_gradients_bad_network(const ted4_trainer *t);

#endif
