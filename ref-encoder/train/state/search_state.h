/* search_state.h - the results of the model search so far: a part of the trainer's state, kept in
 * checkpoints. The files of search/ fill it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SEARCH_STATE_H
#define TED4_SEARCH_STATE_H

#include <stddef.h>
#include <stdint.h>

/* What has been decided: nothing yet; the size of the model; also the final bits of the prior's
 * weights; also which anchors and Gaussians are kept. */
enum { TED4_DECIDED_NOTHING, TED4_DECIDED_MODEL, TED4_DECIDED_BITS, TED4_DECIDED_ALL };

/* The rate-distortion cost of a model: the distortion of training pictures plus lambda times the
 * bits of the file per value. The number of values per anchor is the one before any decision (see
 * ted4_rate_norm), so that a smaller model does not change the weight of a bit. */
typedef struct {
    double cost, distortion;
    double bytes;
} ted4_cost;

/* What can be reduced, in the order of trials, but that motion and activation may have to wait
 * (model_search.c). The choice of the Gaussians that anchors lose takes a pass over many pictures,
 * so it comes last. */
typedef enum {
    TED4_CANDIDATE_MOTION,
    TED4_CANDIDATE_ACTIVATION,
    TED4_CANDIDATE_HEAD_BITS,
    TED4_CANDIDATE_MOTION_BITS,
    TED4_CANDIDATE_BANK_BITS,
    TED4_CANDIDATE_PRIOR_BITS, /* in the order of ted4_weight_grid */
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

/* One trial. Checkpoints contain this struct as it is in memory. */
struct ted4_trial {
    int64_t candidate;
    /* Sizes before and after; larger after only for bits of the prior's weights. */
    int64_t from, to;
    int64_t steps; /* training steps of either model before the comparison; 0: untrained */
    int64_t taken; /* 1 if the changed model was taken */
    ted4_cost before, after;
};

typedef struct {
    int probed;               /* whether the static test is over (static_test.h) */
    double probe_loss[2];     /* mean losses of that test, with time and without; 0: not measured */
    int decided;              /* the last decision: TED4_DECIDED_... */
    struct ted4_trial *trial; /* owned: all trials so far */
    size_t n_trials;
} ted4_search;

#endif
