/* collect.h - finds all errors of an invalid file.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COLLECT_H
#define TED4_COLLECT_H

#include "read/finding.h"

/* Reports the errors of a file that the strict decoder has found invalid, except the verdict.
 * Returns TED4_OK or TED4_E_LIMIT_MEMORY. */
ted4_status ted4_collect(ted4_findings *f, const ted4_options *o);

#endif
