/* monitor_state.h - what is kept to notice a training that goes wrong: the usual size of each
 * gradient, of the loss and of what is drawn, the last good state, and what was found.
 * monitor/monitor.h and monitor/rollback.h work with it. Depends on norm/syntax.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MONITOR_STATE_H
#define TED4_MONITOR_STATE_H

#include <stdint.h>

#include "norm/syntax.h"
#include "snapshot.h"

/* What gradients are told apart by. The first ones are values of anchors, by attribute:
 * TED4_FEATURE to TED4_TAU. */
typedef enum {
    TED4_TERM_MASK = TED4_TYPES, /* logits of both masks */
    TED4_TERM_CENTRE, /* centres of Gaussians in space; positions of anchors themselves are not
                         learnt */
    TED4_TERM_HEADS,
    TED4_TERM_MOTION, /* networks: opacity, covariance, colour; F_project, F_deform */
    TED4_TERM_BANK,
    TED4_TERM_PRIOR,  /* the networks of the entropy model */
    TED4_TERM_STEP,   /* step sizes: those weights of the hyperprior that make them, a part of PRIOR
                       */
    TED4_TERM_COLOUR, /* colour map of the picture's camera */
    TED4_TERMS
} ted4_term;

enum { TED4_BLOCK_TERMS = TED4_TYPES + 1 };

/* The usual size of a positive number that comes once a step: near its median, as one step moves it
 * by a bounded factor, however far off the number is. */
typedef struct {
    double level; /* log2 of it */
    double peak;  /* largest number so far, as a multiple of the usual size before it: since the
                     log's last line */
    uint64_t n;   /* numbers seen */
} ted4_scale;

/* The part that checkpoints keep. */
typedef struct {
    double factor;      /* of all learning rates: 1, halved by each rollback */
    uint64_t rollbacks; /* so far */
    uint64_t phase;     /* of training; another one begins with new scales */
    uint64_t bad_loss,
        bad_screen; /* steps up to now in which the loss was too high, too little was on screen */
    double usual_loss, lost; /* loss before that row of little on screen, share of the row's mean
                                loss that is summed up */
    ted4_scale gradient[TED4_TERMS], loss, screen;
} ted4_monitor_state;

/* What went wrong. */
typedef struct {
    const char *cause; /* "not finite", "exploded", "diverged" or "collapsed" */
    char term[64];     /* e.g. "gradient of offset", "value of feature", "loss", "opacity" */
    int64_t anchor;    /* -1: it is none's */
    uint64_t step;     /* steps done before the one that failed */
} ted4_anomaly;

typedef struct {
    ted4_monitor_state state;
    double norm[TED4_TERMS]; /* of this step's gradients; 0: not learnt */
    double drawn;            /* Gaussians on screen in this step, less those without extent */
    ted4_snapshot good;      /* the last good state, without a good state of its own */
    uint64_t good_at;        /* its step */
    int pinned;              /* it is not replaced: a probe goes back to its own beginning */
    int found;               /* anomaly is of a failure that nothing has been done about */
    ted4_anomaly anomaly;    /* the last one */
} ted4_monitor;

#endif
