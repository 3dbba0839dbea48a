/* advise_parts.h - the parts of advise.c that have files of their own: the checks of ancillary
 * chunks and of coded symbols.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ADVISE_PARTS_H
#define TED4_ADVISE_PARTS_H

#include "base/arena.h"
#include "norm/syntax.h"
#include "read/container.h"
#include "read/finding.h"

/* advise_meta.c: reports what is doubtful in an ancillary chunk. a is for temporary memory. Returns
 * the minor version that registered the chunk's type (spec 16.3), or 0 for other types. */
int ted4_advise_ancillary(ted4_findings *f, const ted4_chunk_place *p, ted4_arena *a);
/* advise_symbols.c: reports what is doubtful in the coded symbols of the tiles. s is the decoded
 * scene. */
void ted4_advise_symbols(ted4_findings *f, const ted4_scene *s, const ted4_options *o);

#endif
