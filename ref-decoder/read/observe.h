/* observe.h - walks the tiles of a decoded scene once more, with a coder that codes nothing and
 * only observes the values that the walk passes to it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_OBSERVE_H
#define TED4_OBSERVE_H

#include "norm/coder.h"
#include "norm/prior.h"

/* The functions that the walk of a tile calls; none of them changes a value. bit and gauss are
 * NULL: an observer makes a copy, in which it sets these two and any others that it needs. */
extern const ted4_coder_ops ted4_observe_ops;

/* The arguments of ted4_walk_tile. */
typedef struct {
    ted4_scene scene; /* shares the arrays of the given scene: an observer may replace an array by
                         another, but must not write to one */
    ted4_prior prior;
    ted4_arena arena;
    void *work;
} ted4_observation;

/* given is a decoded scene, borrowed until ted4_observe_finish. o may be NULL. Returns TED4_OK or
 * TED4_E_LIMIT_MEMORY; ted4_observe_finish must be called in either case. */
ted4_status ted4_observe_init(ted4_observation *l, const ted4_scene *given, const ted4_options *o);
void ted4_observe_finish(ted4_observation *l);

#endif
