/* break_coded.h - breaks what profile Compact codes: trees of positions and blobs of mode 2.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_BREAK_CODED_H
#define CONF_BREAK_CODED_H

#include "build.h"

/* `do tree GRID X:Y:Z ...`: replaces the payload of POSN by a tree of these positions, patterns in
 * hexadecimal, whose keys increase; with GRID 16 they need not be legal. */
void conf_coded_tree(conf_bytes *payload, const conf_line *l);
/* `do pack REF coded [N]`: replaces a blob of mode 2, whose values have been changed, with the
 * exponents that it had. N: the N-th last bit that is coded is set, which may give the last integer
 * more significant bits than a binary32 has. head: bytes before mode. */
void conf_coded_blob(conf_bytes *payload, size_t head, const ted4_scene *s, ted4_blob *blob,
                     const conf_line *l);

#endif
