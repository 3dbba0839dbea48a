/* run_log.h - what a training run writes down while it runs: JSON lines in a file. Keeps the time
 * that training took, too.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RUN_LOG_H
#define TED4_RUN_LOG_H

#include "preview.h"
#include "teller.h"
#include "train/state/trainer.h"

typedef struct {
    const char *path;    /* borrowed; NULL: no log file */
    int file;            /* descriptor, -1: no log file */
    ted4_teller *teller; /* borrowed; hears of trials. NULL: nobody does */
    double wall, cpu;    /* clocks at the last tick, seconds */
    double cpu_seconds;  /* that all threads worked between ticks, since the log began */
    uint64_t last_step; /* the last line's step, trainer->seconds and cpu_seconds: the next one's ms
                           count from there */
    double last_seconds, last_cpu;
    ted4_preview preview; /* what the next line tells of the file */
    double left; /* seconds of work that the next line tells to be left; negative: not known */
    double ms;   /* a step, by the last line; negative: there was none */
} ted4_run_log;

/* "1", "2", "2i" (integer model) */
const char *ted4_run_log_stage(const ted4_trainer *t);

/* path NULL: no log file. keep: a log that is there is cut after the lines of steps and rollbacks
 * up to those of t, and goes on; else it begins anew. 0, or -1 with why filled: also when keep is
 * asked for and the file is no log. */
int ted4_run_log_open(ted4_run_log *l, const char *path, const ted4_trainer *t, int keep,
                      ted4_teller *teller, char *why, size_t why_size);

/* Time since the last tick was training: adds it to t->seconds. Or was not. */
void ted4_run_log_tick(ted4_run_log *l, ted4_trainer *t);
void ted4_run_log_skip(ted4_run_log *l);
/* The trainer has been moved to another step: milliseconds count from there. */
void ted4_run_log_rewind(ted4_run_log *l, const ted4_trainer *t);
/* The same, and lines of later steps or rollbacks go from the file. 0, or -1 with why filled: a
 * file that is no log stays as it is. */
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
