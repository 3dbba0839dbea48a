/* header_from_options.h - makes the header of the file from the training options (spec 6). Depends
 * on options.h and data/dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_HEADER_FROM_OPTIONS_H
#define TED4_HEADER_FROM_OPTIONS_H

#include "data/dataset.h"
#include "norm/syntax.h"
#include "options.h"

/* Sets those options that depend on the pictures and that the user left to the program: the number
 * of rows of the bank if the light flickers. Call after ted4_dataset_verify. Returns 0, or -1 if
 * memory ran out. */
int ted4_header_settle(ted4_train_options *o, const ted4_dataset *d);
/* Fills everything except n_anchors. Scalings are logarithmic until stage 2 begins, whatever the
 * options say. */
void ted4_header_make(ted4_header *h, const ted4_train_options *o, const ted4_dataset *d);
/* Fills the fields that stage 1 does not use: offset mask, prior, slices, step sizes. */
void ted4_header_stage2(ted4_header *h, const ted4_train_options *o);
/* Removes motion, and everything that only motion needs. */
void ted4_header_without_motion(ted4_header *h);

/* header_check.c: checks whether a file could hold this header, by the walk of norm/ at the level
 * without bounds. It ignores n_anchors, which a trainer keeps elsewhere. Returns NULL, or the name
 * of the first element whose value no file may hold. */
const char *ted4_header_wrong(const ted4_header *h);
/* Returns whether both headers are valid in the format and equal. */
int ted4_header_same(const ted4_header *a, const ted4_header *b);

#endif
