/* view_results.h - what a step finds out about each of its views, apart from the gradients that are
 * summed over them (state/view_sums.h). Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_RESULTS_H
#define TED4_VIEW_RESULTS_H

#include "train/state/trainer.h"

typedef struct {
    double loss, l1, ssim;
    double on_screen;      /* Gaussians */
    double centre, drawn;  /* what ted4_update_volume reports */
    ted4_colour_map map;   /* gradient of the colours of its camera, if these are learnt */
    ted4_pose_motion pose; /* gradient of its pose, 0 unless it is learnt */
} ted4_view_result;

/* Completes r[n], the results of the views of a step, by those of the views that other processes
 * have drawn. Returns 0, or -1 with t->message: the processes are not at the same point of the same
 * training. */
int ted4_view_results_gather(ted4_trainer *t, ted4_view_result *r, size_t n);

#endif
