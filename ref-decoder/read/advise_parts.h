/* advise_parts.h - the searches that advise.c starts: through ancillary chunks and through coded
 * symbols.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ADVISE_PARTS_H
#define TED4_ADVISE_PARTS_H

#include "base/arena.h"
#include "norm/syntax.h"
#include "read/container.h"
#include "read/finding.h"

/* advise_meta.c: an ancillary chunk. */
void ted4_advise_ancillary(ted4_findings *f, const ted4_chunk_place *p, ted4_arena *a);
/* advise_symbols.c: what is coded in tiles. s is the decoded scene. */
void ted4_advise_symbols(ted4_findings *f, const ted4_scene *s, const ted4_options *o);

#endif
