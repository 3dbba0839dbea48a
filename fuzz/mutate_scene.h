/* mutate_scene.h - changes of a parsed scene, after which it can be written, if not by a writer of
 * every level.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_MUTATE_SCENE_H
#define TED4_FUZZ_MUTATE_SCENE_H

#include "random_scene.h"

/* Returns a number at or near a bound of an element in the specification, of an integer type, or of
 * binary32. */
uint64_t fuzz_boundary(random_source *r);
/* Changes up to four things of s: weights, symbols, masks, positions, their grid, the profile,
 * header elements that determine no shape. */
void fuzz_change_scene(random_source *r, ted4_scene *s);
/* Returns a scene of either profile with any header and few anchors, or NULL if memory ran out.
 * Free with ted4_scene_free. */
ted4_scene *fuzz_any_scene(random_source *r);

#endif
