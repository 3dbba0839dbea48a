/* check_report.h - what ted4enc --check says of a scene.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CHECK_REPORT_H
#define TED4_CHECK_REPORT_H

#include "data/dataset.h"
#include "train/model/options.h"

/* Prints to stdout what the scene holds: as lines, or with json as one JSON object. error: the one
 * thing that is wrong, in place of the lines; or NULL. d is NULL if the scene could not be loaded.
 * options: those of the training. */
void ted4_check_report(const ted4_dataset *d, const ted4_train_options *options, const char *error,
                       int json);

#endif
