/* observe.h - the tiles of a decoded scene walked once more, by a coder that codes nothing: it only
 * sees what the walk hands over.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_OBSERVE_H
#define TED4_OBSERVE_H

#include "norm/coder.h"
#include "norm/prior.h"

/* What the walk of a tile calls; every value stays as it is. bit and gauss are NULL: an observer
 * sets them, and what else it observes, in a copy. */
extern const ted4_coder_ops ted4_observe_ops;

/* What ted4_walk_tile needs. */
typedef struct {
    ted4_scene scene; /* its arrays are the given scene's: an observer may put others in their
                         place, but changes none */
    ted4_prior prior;
    ted4_arena arena;
    void *work;
} ted4_observation;

/* given: a decoded scene, borrowed until the end. o may be NULL. TED4_OK or TED4_E_LIMIT_MEMORY;
 * finish in any case. */
ted4_status ted4_observe_init(ted4_observation *l, const ted4_scene *given, const ted4_options *o);
void ted4_observe_finish(ted4_observation *l);

#endif
