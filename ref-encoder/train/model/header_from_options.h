/* header_from_options.h - the header of the file to be, from the training options (spec 6). Depends
 * on options.h and data/dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_HEADER_FROM_OPTIONS_H
#define TED4_HEADER_FROM_OPTIONS_H

#include "data/dataset.h"
#include "norm/syntax.h"
#include "options.h"

/* Sets options that follow from the pictures, where they were left to the program: rows of the bank
 * where the light flickers. After ted4_dataset_verify. 0, or -1: no memory. */
int ted4_header_settle(ted4_train_options *o, const ted4_dataset *d);
/* Everything but n_anchors. Scalings are logarithmic until stage 2 begins, whatever the options
 * want. */
void ted4_header_make(ted4_header *h, const ted4_train_options *o, const ted4_dataset *d);
/* The fields that stage 1 does not look at: offset mask, prior, slices, step sizes. */
void ted4_header_stage2(ted4_header *h, const ted4_train_options *o);
/* No motion, and nothing that only motion needs. */
void ted4_header_without_motion(ted4_header *h);

/* header_check.c: what a file would hold of headers, by the walk of norm/ at the level without
 * bounds. n_anchors is not looked at: a trainer keeps it elsewhere. NULL, or the name of the first
 * element that no file may hold so. */
const char *ted4_header_wrong(const ted4_header *h);
/* Are both headers of the format, and the same? */
int ted4_header_same(const ted4_header *a, const ted4_header *b);

#endif
