/* run_log.h - what a training run says while it runs: a progress line on a terminal, JSON lines in a file.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RUN_LOG_H
#define TED4_RUN_LOG_H

#include <stdio.h>

#include "train/trainer.h"

typedef struct {
    FILE  *json;                /* owned; NULL: no log file */
    int    terminal;            /* progress line wanted */
    int    verbose;             /* plain progress lines wanted */
    double start, last_time;    /* seconds; step at that time below */
    uint64_t last_step;
    double psnr;                /* held-out preview */
} ted4_run_log;

double ted4_seconds(void);
/* path NULL: no log file. Appends when resuming. 0, or -1 with why filled. */
int  ted4_run_log_open(ted4_run_log *l, const char *path, int append, int quiet, int verbose,
                       char *why, size_t why_size);
/* After a step that is worth reporting. */
void ted4_run_log_step(ted4_run_log *l, const ted4_trainer *t);
void ted4_run_log_close(ted4_run_log *l);

/* Bytes that the file would have now, from the rate of the anchors seen lately. */
double ted4_estimated_bytes(const ted4_trainer *t);

#endif
