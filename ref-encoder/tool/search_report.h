/* search_report.h - what was decided about how much model a scene needs, as text for people: the
 * lines of META that `ted4info --why` prints.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SEARCH_REPORT_H
#define TED4_SEARCH_REPORT_H

#include "train/state/trainer.h"

/* Lines key=value, keys beginning with "capacity", to be freed. No times, no names. NULL: no
 * memory. */
char *ted4_search_report(const ted4_trainer *t);

#endif
