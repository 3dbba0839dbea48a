/* header.h - the header of the file to be, from the training options (spec 6). Depends on options.h and data/dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAIN_HEADER_H
#define TED4_TRAIN_HEADER_H

#include "data/dataset.h"
#include "norm/syntax.h"
#include "options.h"

/* Everything but n_anchors. Scalings are logarithmic until stage 2 begins, whatever the options want. */
void ted4_header_make(ted4_header *h, const ted4_train_options *o, const ted4_dataset *d);
/* The fields that stage 1 does not look at: offset mask, prior, slices, step sizes. */
void ted4_header_stage2(ted4_header *h, const ted4_train_options *o);
/* No motion, and nothing that only motion needs. */
void ted4_header_without_motion(ted4_header *h);

#endif
