/* eval_result.h - what ted4eval measures, and how it prints it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EVAL_RESULT_H
#define TED4_EVAL_RESULT_H

#include <stddef.h>

#include "moving_pixels.h"
#include "ted4.h"

/* Sums over pictures, which are divided by their number when they are printed. PSNR is in dB. */
typedef struct {
    double psnr, ssim, ssim2, ms_ssim, l1;
    double render_s;        /* seconds */
    double given, aligned;  /* PSNR of the half that --align judges, before and after the fit */
    double raw, fitted;     /* PSNR of the fitted_views that --colours judges, before and after */
    ted4_moving_sum moving; /* of --moving */
    size_t views, fitted_views;
    double decode_ms; /* of the file, as are bytes */
    size_t bytes;
} ted4_eval_sums;

typedef struct {
    const char *split;                /* "test" or "train" */
    int json, align, colours, moving; /* as one JSON object; with the results of these options */
} ted4_eval_style;

/* Prints the result on standard output. t->views must be above 0. */
void ted4_eval_print(const ted4_eval_sums *t, const ted4_info *info, const ted4_eval_style *style);

#endif
