/* search_report.h - decisions of the model search as human-readable text: the lines of META that
 * `ted4info --why` prints.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SEARCH_REPORT_H
#define TED4_SEARCH_REPORT_H

#include "train/state/trainer.h"

/* Returns lines "key=value" whose keys begin with "capacity", for the caller to free, or NULL if
 * out of memory. The text contains no times and no file names. */
char *ted4_search_report(const ted4_trainer *t);

#endif
