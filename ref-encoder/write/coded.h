/* coded.h - what a writer of profile Compact chooses: the mode of a blob whose values are coded as
 * integers (spec 7.6), and the grid of positions (8.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CODED_H
#define TED4_CODED_H

#include "norm/syntax.h"

/* Sets b, a blob of s, to mode TED4_BLOB_CODED if all of its values are integers below 2^31 times
 * the power of two of their unit, and if its bytes behind mode are then fewer than most. arena:
 * owns the exponents. Returns 1 if it did, else 0: then b is as before. */
int ted4_blob_code(const ted4_scene *s, ted4_blob *b, ted4_arena *arena, size_t most);

/* Returns the coarsest grid on which all positions [n][3] lie, and in whose order they are: a
 * number of bits, 16 if there is no other. */
unsigned ted4_coarsest_grid(const uint16_t *position, size_t n);

#endif
