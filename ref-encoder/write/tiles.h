/* tiles.h - a scene made ready to be written or counted: its prior, its probabilities, and its
 * tiles walked in parallel.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TILES_H
#define TED4_TILES_H

#include "norm/coder.h"
#include "norm/prior.h"
#include "norm/scene.h"

typedef struct {
    ted4_scene s;     /* a copy; arrays are the original's, but prob and deflated bytes its own */
    ted4_arena arena; /* owns what is its own */
    ted4_prior prior; /* not loaded yet */
} ted4_draft;

/* TED4_OK or TED4_E_LIMIT_MEMORY. The header must have passed ted4_walk_header. */
ted4_status ted4_draft_init(ted4_draft *d, const ted4_scene *s);
void ted4_draft_finish(ted4_draft *d);

/* Walks every tile with a coder of its own. coders: n_tiles of them, stride bytes apart, each
 * beginning with its ted4_coder. Gives the first failure in tile order. */
ted4_error ted4_draft_tiles(ted4_draft *d, void *coders, size_t stride, const ted4_parallel *p);

#endif
