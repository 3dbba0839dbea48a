/* run_log.h - log of a training run: a file of JSON lines. Also measures the training time.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RUN_LOG_H
#define TED4_RUN_LOG_H

#include "preview.h"
#include "teller.h"
#include "train/state/trainer.h"

typedef struct {
    const char *path;    /* borrowed; NULL: no log file */
    int file;            /* descriptor, -1: no log file */
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
/* Like ted4_run_log_rewind, and also cuts lines of later steps or rollbacks off the file. Returns
 * 0, or -1 with why filled; a file that is not a log is left unchanged. */
int ted4_run_log_cut(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size);

/* One line, right after a tick:
 *   step stage             steps done; ted4_run_log_stage
 *   lambda                 of this run, or this trial of --target-size
 *   loss l1 ssim           running means over about 100 steps
 *   psnr split             mean over pictures of a spread, dB, as of the file in stage 2; "test",
 *                          or "train" where nothing is held out
 *   anchors moving splats  how many; those the file would call dynamic; Gaussians on screen
 *   bytes bytes_by_type    of the file as it would be, in stage 2, else 0; positions, masks, the
 *                          five attributes, networks, and the frame around them
 *   bits                   of the five attributes, an anchor
 *   ms cpu_ms              a step, since the line before
 *   gaussian_pixels_per_s  speed
 *   seconds                of training since step 0, whatever runs it took; what was trained and
 *                          thrown away (a new beginning, a rollback) counts
 *   cpu_seconds            the same of all threads, since this log began
 *   left                   seconds until the file is written, as estimated; negative: not known
 *   skipped                Gaussians that this process has left out of pictures so far, as they
 *                          were not finite (ted4_raster_skipped)
 *   clamped                values of anchors at an end of their range (saturation.h)
 *   gradients              usual norm (near the median of about 100 steps) of what each term learns
 *                          from: values of anchors by attribute, masks, centres of Gaussians
 *                          (anchors' positions are not learnt), networks (heads, motion, prior),
 *                          bank, steps (step sizes), colour; 0: not learnt
 *   peaks                  of each term the largest norm since the line before, as a multiple of
 *                          its usual one; 0: not known yet
 *   rollbacks              so far
 * 0, or -1 with why filled; the file then ends with the line before. */
int ted4_run_log_step(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size);
/* One line about what the monitor has found (monitor.h):
 *   step                   where training goes on, or ended
 *   event                  "rollback", or "failure": the end
 *   rollbacks              with this one
 *   failed                 steps done before the one that failed
 *   cause term anchor      anchor is null where it is none's
 *   factor                 of learning rates from here on
 * The same results. */
int ted4_run_log_event(ted4_run_log *l, const ted4_trainer *t, char *why, size_t why_size);
/* One line about each trial of a smaller model (train/search/model_search.h) from number first on,
 * once they are made:
 *   step                   where training goes on
 *   event                  "capacity"
 *   rollbacks              so far
 *   what from to           what was tried: from so many to so many
 *   trained                steps of either side before they were compared; 0: untrained
 *   taken                  does the smaller model stay?
 *   cost distortion bytes  of the model at hand, of the smaller one; cost is distortion plus what
 *                          the bytes weigh
 * The same results. */
int ted4_run_log_trials(ted4_run_log *l, const ted4_trainer *t, size_t first, char *why,
                        size_t why_size);
/* 0, or -1 with why filled. */
int ted4_run_log_close(ted4_run_log *l, char *why, size_t why_size);

#endif
