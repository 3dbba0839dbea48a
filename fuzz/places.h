/* places.h - positions on the grid of profile Compact (spec 8.2), for changes of a scene.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_PLACES_H
#define TED4_FUZZ_PLACES_H

#include <stddef.h>
#include <stdint.h>

/* A pattern that no legal coordinate has. */
enum { FUZZ_NO_PLACE = 0x7c00 };

/* Makes position[n][3], any patterns, into legal positions on a grid of depth bits (6 .. 12, or
 * 16), all different and in the order of their keys: coordinates go to the nearest place, anchors
 * with an illegal one or a place that is taken go to free places near the middle. Returns 0, with
 * nothing changed, if memory or free places ran out. */
int fuzz_settle(uint16_t *position, size_t n, unsigned depth);

#endif
