/* training.h - a training run as ted4enc makes it: steps, log lines and checkpoints, until the
 * file's bytes stand.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAINING_H
#define TED4_TRAINING_H

#include "estimate.h"
#include "request.h"
#include "run_log.h"
#include "teller.h"
#include "verify.h"

typedef struct {
    const ted4_request *request; /* borrowed */
    ted4_trainer *trainer;       /* borrowed */
    ted4_run_log log;
    const char *checkpoint; /* borrowed; NULL: none is written */
    ted4_teller *teller;    /* borrowed */
    ted4_facts facts;       /* what the teller knows */
    ted4_estimate estimate;
    double mv_seed_share; /* share of anchors kept for them, as it was when last asked for */
    int estimated;        /* how long the whole takes has been said */
    int64_t saved;        /* the step that the checkpoint holds; negative: there is none */
    int stopped;          /* the signal that ended training; 0: none has */
    char why[1024];       /* set by whatever fails */
} ted4_training;

/* A coded scene that was decoded again and found equal. */
typedef struct {
    uint8_t *bytes; /* owned */
    size_t size;
    double lambda;
    ted4_verified verified;
} ted4_coded;

/* Opens the log and goes to the checkpoint (--resume) or the end of stage 1 (--stage1) if there is
 * one. From here on a signal to end (stop.h) ends a step, writes a last checkpoint, and is no
 * failure to say more about: stopped is set, and why says how to go on. 0, or -1 with why. */
int ted4_training_begin(ted4_training *t, const ted4_request *r, ted4_trainer *trainer,
                        ted4_teller *teller);
/* Closes the log. bad: something has failed already, and its why stays. 0, or not 0 with why. */
int ted4_training_end(ted4_training *t, int bad);

/* Steps until that many are done; writes the --stage1 file when it passes there, and checkpoints.
 * 0, or -1 with why. */
int ted4_training_go(ted4_training *t, uint64_t steps);
/* Codes the scene as it stands. 0, or -1 with why. */
int ted4_training_code(ted4_training *t, ted4_coded *c);
void ted4_coded_free(ted4_coded *c);

/* Repeats stage 2 with other lambdas, in search of the largest file that is no larger than
 * request->target_size. *c: that file, or the smallest one if all were larger. The same search for
 * the same scene, options and seed. 0, or -1 with why. target.c */
int ted4_training_target(ted4_training *t, ted4_coded *c);

/* ---- between the files ---- */

/* What the teller hears of each step, and how much time is left; the trainer's onlooker. look.c */
int ted4_training_look(void *training);
/* Training stands elsewhere, or was held up. */
void ted4_training_rewound(ted4_training *t);

#endif
