/* monitor_state.h - state of the monitor: the usual size of each gradient, of the loss and of the
 * number of Gaussians on screen, the last good state, and the anomaly found. Used by
 * monitor/monitor.h and monitor/rollback.h. Depends on norm/syntax.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MONITOR_STATE_H
#define TED4_MONITOR_STATE_H

#include <stdint.h>

#include "norm/syntax.h"
#include "snapshot.h"

/* Terms: the parameter groups whose gradients are monitored separately. The first ones are the
 * attributes of anchors, TED4_FEATURE to TED4_TAU. */
typedef enum {
    TED4_TERM_MASK = TED4_TYPES, /* logits of both masks */
    /* Centres of Gaussians in space; the positions of anchors themselves are not learnt. */
    TED4_TERM_CENTRE,
    TED4_TERM_HEADS,
    /* Networks: HEADS are opacity, covariance and colour; MOTION is F_project and F_deform. */
    TED4_TERM_MOTION,
    TED4_TERM_BANK,
    TED4_TERM_PRIOR, /* the networks of the entropy model */
    /* Step sizes: the weights of the hyperprior that produce them, a part of PRIOR. */
    TED4_TERM_STEP,
    TED4_TERM_COLOUR, /* colour map of the picture's camera */
    TED4_TERM_POSE,   /* motion of the picture's pose */
    TED4_TERMS
} ted4_term;

enum { TED4_BLOCK_TERMS = TED4_TYPES + 1 };

/* The usual size of a positive number that occurs once per step. It stays near the median of the
 * number, as one step moves it by a bounded factor only, however large an outlier is. */
typedef struct {
    double level; /* log2 of the usual size */
    /* Largest number since the last line of the log, as a multiple of the usual size before it. */
    double peak;
    uint64_t n; /* numbers seen */
} ted4_scale;

/* The part of the monitor that checkpoints contain. */
typedef struct {
    double factor;      /* factor of all learning rates: 1, halved by each rollback */
    uint64_t rollbacks; /* number of rollbacks so far */
    uint64_t phase;     /* phase of training; a new phase begins with new scales */
    /* Length of the current run of steps in which the loss was too high, and of that in which too
     * few Gaussians were on screen. */
    uint64_t bad_loss, bad_screen;
    /* The usual loss before that run of steps with too few Gaussians on screen, and the part of its
     * mean loss that is summed up so far. */
    double usual_loss, lost;
    ted4_scale gradient[TED4_TERMS], loss, screen;
} ted4_monitor_state;

/* A description of what went wrong. */
typedef struct {
    const char *cause; /* "not finite", "exploded", "diverged" or "collapsed" */
    char term[64];     /* for example "gradient of offset", "value of feature", "loss", "opacity" */
    int64_t anchor;    /* -1: the term does not belong to an anchor */
    uint64_t step;     /* steps done before the step that failed */
} ted4_anomaly;

typedef struct {
    ted4_monitor_state state;
    /* Norms of this step's gradients; 0: the term is not learnt. */
    double norm[TED4_TERMS];
    double drawn; /* Gaussians on screen in this step, without those that have no extent */
    /* The last good state; it does not contain a good state of its own. */
    ted4_snapshot good;
    uint64_t good_at; /* step of that state */
    /* The good state is not replaced: a probe rolls back to its own beginning. */
    int pinned;
    /* anomaly describes a failure that has not been handled. */
    int found;
    ted4_anomaly anomaly; /* the last anomaly */
} ted4_monitor;

#endif
