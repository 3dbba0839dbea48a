/* training.h - a training run of ted4enc: steps, log lines and checkpoints, up to the bytes of the
 * finished file.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAINING_H
#define TED4_TRAINING_H

#include "estimate.h"
#include "request.h"
#include "run_log.h"
#include "teller.h"
#include "train/step/events.h"
#include "verify.h"

typedef struct {
    const ted4_request *request; /* borrowed */
    ted4_trainer *trainer;       /* borrowed */
    ted4_run_log log;
    const char *checkpoint; /* borrowed; NULL: none is written */
    ted4_teller *teller;    /* borrowed */
    ted4_facts facts;       /* the facts last given to the teller */
    ted4_estimate estimate;
    /* When anchors come, by the last query; seed_share negative: there was none. */
    ted4_growth growth;
    int estimated;  /* 1: the estimated duration of the run has been printed */
    int64_t saved;  /* the step that the checkpoint holds; negative: there is no checkpoint */
    uint64_t again; /* steps that a search for a size has taken and gone back */
    int asked;      /* the signal that asks for the end, as all processes know it; 0: none */
    int stopped;    /* the signal that ended training; 0: none has */
    char why[1024]; /* filled by every function that fails */
} ted4_training;

/* A coded scene. The bytes were decoded again, and the result equals the scene. */
typedef struct {
    uint8_t *bytes; /* owned */
    size_t size;
    double lambda;
    ted4_verified verified;
} ted4_coded;

/* Opens the log, and restores the checkpoint (--resume) or the end of stage 1 (--stage1) if that
 * file exists. From now on a signal to end (stop.h) ends training after the current step, with a
 * last checkpoint. The function under way then returns -1, but this is not an error: t->stopped is
 * set, and t->why says how to continue. After the last step a signal has no effect. Returns 0, or
 * -1 with t->why filled. */
int ted4_training_begin(ted4_training *t, const ted4_request *r, ted4_trainer *trainer,
                        ted4_teller *teller);
/* Closes the log. bad: an earlier call has failed, and its t->why is kept. Returns 0, or not 0 with
 * t->why filled: bad was not 0, or the log could not be closed. */
int ted4_training_end(ted4_training *t, int bad);

/* Trains to the end of stage 1 (stages = 1) or of stage 2 (2). Writes checkpoints, and the --stage1
 * file at the end of stage 1. Returns 0, or -1 with t->why filled. */
int ted4_training_go(ted4_training *t, int stages);
/* Codes the current scene and verifies the result. Returns 0, or -1 with t->why filled. */
int ted4_training_code(ted4_training *t, ted4_coded *c);
void ted4_coded_free(ted4_coded *c);

/* Repeats stage 2 with different values of lambda, in search of the largest file that does not
 * exceed request->target_size. *c is that file, or the smallest one if all exceed it. The search is
 * the same for the same scene, options and seed. A lambda at which no Gaussian is left bounds it.
 * It ends early, with a warning, if a trial fails for another reason after one has found a file
 * that fits; of several processes, all fail then. Returns 0, or -1 with t->why filled; *c is then
 * empty, unless a signal has ended a search that has found a file that fits. See target.c. */
int ted4_training_target(ted4_training *t, ted4_coded *c);

/* ---- shared by training.c, target.c and look.c ---- */

/* The trainer's onlooker, called during training: updates the status line and the estimate of the
 * remaining time. Returns, during probes and trials, the signal that asked for the end, or 0. In
 * look.c. */
int ted4_training_look(void *training);
/* Returns the signal that asked a process of this run to end, or 0. All processes call it together
 * and learn the same. In look.c. */
int ted4_training_asked(ted4_training *t);
/* Tells the estimate that training was moved to another step, or interrupted. In look.c. */
void ted4_training_rewound(ted4_training *t);

#endif
