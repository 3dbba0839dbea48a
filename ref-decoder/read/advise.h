/* advise.h - reports what is doubtful in a valid file.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ADVISE_H
#define TED4_ADVISE_H

#include "norm/syntax.h"
#include "read/finding.h"

/* s is the scene of the file. If memory runs out, some findings are left out and f->starved is set.
 */
void ted4_advise(ted4_findings *f, const ted4_scene *s, const ted4_options *o);

#endif
