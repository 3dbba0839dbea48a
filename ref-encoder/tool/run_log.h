/* run_log.h - log of a training run: a file of JSON lines. Also measures the training time.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RUN_LOG_H
#define TED4_RUN_LOG_H

#include <sys/types.h>

#include "preview.h"
#include "teller.h"
#include "train/state/trainer.h"

typedef struct {
    const char *path; /* borrowed; NULL: no log file */
    int file;         /* descriptor, -1: no log file */
    off_t trial;      /* where the lines of this trial of --target-size begin; 0: there is none */
    ted4_teller *teller; /* borrowed; is told about trials. NULL: not used */
    double wall, cpu;    /* wall clock and CPU clock at the last tick, seconds */
    double cpu_seconds;  /* CPU time of all threads during training, since the log began */
    /* Step, trainer->seconds and cpu_seconds of the last line. The ms and cpu_ms of the next line
     * count from there. */
    uint64_t last_step;
    double last_seconds, last_cpu;
    ted4_preview preview; /* preview of the file for the next line */
    double left;          /* estimated remaining seconds for the next line; negative: not known */
    double ms; /* milliseconds per step in the last line; negative: no line was written */
} ted4_run_log;

/* Returns "1", "2", or "2i" (stage 2 with the integer model). */
const char *ted4_run_log_stage(const ted4_trainer *t);

/* Opens a log. path: borrowed; NULL: no log file. keep: an existing log is continued; lines of
 * later steps or rollbacks than those of t are cut off. Otherwise the file is emptied. Returns 0,
 * or -1 with why filled; that includes an existing file which is not a log, if keep is set. */
int ted4_run_log_open(ted4_run_log *l, const char *path, const ted4_trainer *t, int keep,
                      ted4_teller *teller, char *why, size_t why_size);

/* Counts the time since the last tick or skip as training time, and adds it to t->seconds. */
void ted4_run_log_tick(ted4_run_log *l, ted4_trainer *t);
/* Does not count the time since the last tick or skip. */
void ted4_run_log_skip(ted4_run_log *l);
/* Tells the log that the trainer was moved to another step: the ms of the next line count from
 * there. */
void ted4_run_log_rewind(ted4_run_log *l, const ted4_trainer *t);
/* Like ted4_run_log_rewind; the lines so far belong to earlier trials, and stay. */
void ted4_run_log_begin_trial(ted4_run_log *l, const ted4_trainer *t);
/* Like ted4_run_log_rewind, and also cuts this trial's lines of later steps or rollbacks off the
 * file. Returns 0, or -1 with why filled; a file that is not a log is left unchanged. */
int ted4_run_log_cut(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size);

/* Writes one line about the current step. Call it right after a tick or skip. Numbers that are not
 * finite are null. The members are:
 *   step stage             number of steps done; stage as in ted4_run_log_stage
 *   lambda                 of this run, or of this trial of --target-size
 *   loss l1 ssim           running means over about 100 steps
 *   psnr split             mean PSNR in dB over an evenly spread sample of pictures, in stage 2 as
 *                          if drawn from the file; "test", or "train" if nothing is held out
 *   anchors moving splats  numbers of anchors, of anchors that the file would mark as dynamic, and
 *                          of Gaussians on screen
 *   bytes bytes_by_type    size of the file if it were written now, 0 in stage 1; its parts:
 *                          positions, masks, the five attributes, networks, and frame (the rest)
 *   bits                   bits per anchor of each of the five attributes
 *   ms cpu_ms              milliseconds per step since the previous line
 *   gaussian_pixels_per_s  speed of the rasteriser
 *   seconds                training time since step 0, over all runs, including training that was
 *                          discarded (by a restart or a rollback)
 *   cpu_seconds            CPU time of all threads for training, since this log began
 *   left                   estimated seconds until the file is written; negative: not known
 *   skipped                number of Gaussians that this process has not drawn so far because they
 *                          were not finite (ted4_raster_skipped)
 *   clamped                number of anchor values at an end of their range (saturation.h)
 *   gradients              usual norm (near the median of about 100 steps) of the gradient of each
 *                          term: anchor values by attribute, masks, centres of Gaussians (the
 *                          positions of anchors are not trained), networks (heads, motion, prior),
 *                          bank, steps (quantisation steps), colour, pose; 0: not trained
 *   peaks                  largest norm of each term since the previous line, as a multiple of its
 *                          usual norm; 0: not known yet
 *   rollbacks              number of rollbacks so far
 * Returns 0, or -1 with why filled; the file then ends with the previous line. */
int ted4_run_log_step(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size);
/* Writes one line about an anomaly that the monitor has found (monitor.h):
 *   step                   the step at which training continues, or has ended
 *   event                  "rollback", or "failure" if training has ended
 *   rollbacks              number of rollbacks, including this one
 *   failed                 number of steps done before the one that failed
 *   cause term anchor      anchor is null if the anomaly concerns no single anchor
 *   factor                 factor of the learning rates from now on
 * Returns the same as ted4_run_log_step. */
int ted4_run_log_event(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size);
/* Writes one line about each finished trial of a smaller model (train/search/model_search.h), from
 * trial number first on:
 *   step                   the step at which training continues
 *   event                  "capacity"
 *   rollbacks              number of rollbacks so far
 *   what from to           the quantity that was reduced, its old and its new value
 *   trained                steps of each side before the comparison; 0: untrained
 *   taken                  true: the smaller model is kept
 *   cost distortion bytes  [current model, smaller model]; cost: distortion plus weighted rate
 * Returns the same as ted4_run_log_step. */
int ted4_run_log_trials(ted4_run_log *l, const ted4_trainer *t, size_t first, char *why,
                        size_t why_size);
/* Writes one line about the decision on poses of training cameras (train/step/pose_step.h):
 *   step                   the step at which training continues
 *   event                  "poses"
 *   rollbacks              number of rollbacks so far
 *   moved                  pixels by which refinement has moved what is seen
 *   refined                true: refinement goes on; false: the given poses are put back
 * Returns the same as ted4_run_log_step. */
int ted4_run_log_poses(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size);
/* Writes one line about the closing of still anchors (train/densify/still_anchors.h):
 *   step                   the step at which training continues
 *   event                  "closing"
 *   rollbacks              number of rollbacks so far
 *   anchors moving closed  numbers of anchors; of those that moved; of those that no longer do
 * Returns the same as ted4_run_log_step. */
int ted4_run_log_closing(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size);
/* Closes the file. Returns 0, or -1 with why filled. */
int ted4_run_log_close(ted4_run_log *l, char *why, size_t why_size);

#endif
