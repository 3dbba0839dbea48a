/* search_state.h - what the search for a smaller model has come to: a part of the trainer's state,
 * kept in checkpoints. search/model_search.h makes it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SEARCH_STATE_H
#define TED4_SEARCH_STATE_H

#include <stddef.h>
#include <stdint.h>

/* Nothing yet; how much model there is; how coarse its weights are in the end; which anchors pay,
 * too. */
enum { TED4_DECIDED_NOTHING, TED4_DECIDED_MODEL, TED4_DECIDED_BITS, TED4_DECIDED_ALL };

/* What a model costs: distortion of training pictures plus lambda times the bits of the file, these
 * in units of the values of all anchors as they were before anything was decided, so that a bit
 * weighs the same in every trial. */
typedef struct {
    double cost, distortion;
    double bytes;
} ted4_cost;

/* What may become less, in the order of trials: which Gaussians an anchor has fewer of takes a look
 * at many pictures, so that comes last. */
typedef enum {
    TED4_CANDIDATE_MOTION,
    TED4_CANDIDATE_ACTIVATION,
    TED4_CANDIDATE_HEAD_BITS,
    TED4_CANDIDATE_MOTION_BITS,
    TED4_CANDIDATE_BANK_BITS,
    TED4_CANDIDATE_PRIOR_BITS, /* as ted4_weight_grid */
    TED4_CANDIDATE_HYPER,
    TED4_CANDIDATE_DEFORM,
    TED4_CANDIDATE_AR,
    TED4_CANDIDATE_HEADS,
    TED4_CANDIDATE_BANK,
    TED4_CANDIDATE_FEATURE,
    TED4_CANDIDATE_SLICES,
    TED4_CANDIDATE_OCTAVES,
    TED4_CANDIDATE_VIEW,
    TED4_CANDIDATE_ROWS,
    TED4_CANDIDATE_PHI,
    TED4_CANDIDATE_SCALE,
    TED4_CANDIDATE_OFFSETS,
    TED4_CANDIDATE_ANCHORS,
    TED4_CANDIDATES
} ted4_candidate;

/* One trial; kept in checkpoints as it stands in memory. */
struct ted4_trial {
    int64_t candidate, from,
        to; /* what was tried: from so many to so many; more only of bits of the prior's weights */
    int64_t steps; /* training of either side before they were compared; 0: compared untrained */
    int64_t taken; /* 1: the smaller model stays */
    ted4_cost before, after;
};

typedef struct {
    int probed; /* it is settled whether the scene needs time at all (static_test.h) */
    double
        probe_loss[2]; /* mean losses that settled it: with time, without; 0: nothing was tried */
    int decided;       /* how much of what the search settles has been: TED4_DECIDED_... */
    struct ted4_trial *trial; /* owned: what settled it */
    size_t n_trials;
} ted4_search;

#endif
