/* tiles.h - prepares a scene for being written or counted: chooses its probabilities, sets up its
 * prior, and walks its tiles in parallel.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TILES_H
#define TED4_TILES_H

#include "norm/coder.h"
#include "norm/prior.h"
#include "norm/scene.h"

typedef struct {
    /* A copy that shares the arrays of the original, except prob and the deflated bytes. */
    ted4_scene s;
    ted4_arena arena; /* owns the arrays that are not shared */
    ted4_prior prior; /* not loaded yet */
} ted4_draft;

/* Prepares a draft of s, whose header must have passed ted4_walk_header. Returns TED4_OK,
 * TED4_E_LIMIT_MEMORY, or TED4_E_SYN_HASH if the masks contradict the header. */
ted4_status ted4_draft_init(ted4_draft *d, const ted4_scene *s);
void ted4_draft_finish(ted4_draft *d);

/* Walks every tile with a coder of its own. coders: n_tiles structures, stride bytes apart, each of
 * which begins with its ted4_coder. Returns the first failure in tile order. */
ted4_error ted4_draft_tiles(ted4_draft *d, void *coders, size_t stride, const ted4_parallel *p);

#endif
