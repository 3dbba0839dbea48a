/* lab_facts.h - what lab_facts.c, which prints, and the files that measure share: one decoded file,
 * its scene, and what the lab wants to know of them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LAB_FACTS_H
#define TED4_LAB_FACTS_H

#include "data/dataset.h"
#include "render/view.h"

typedef struct {
    ted4_scene *scene; /* owned, as all below */
    ted4_recon *recon;
    ted4_dataset data; /* empty where no scene was named */
    ted4_info info;
    size_t bytes; /* of the file */
} lab_session;

/* Prints a line; TED4_EXIT_TOOL. All that follow give an exit code, after a line where it is not
 * TED4_EXIT_FINE. */
int lab_failed(const char *what, const char *why);

/* ---- held-out pictures: lab_views.c ---- */

typedef struct {
    size_t views;   /* held-out pictures; 0: the numbers below say nothing */
    size_t exact;   /* of them, how many are equal to the truth */
    size_t refused; /* how many the decoder refuses to reconstruct, as not finite: these count in no
                       number below */
    double mean, worst; /* PSNR, dB. A picture equal to the truth counts as if one of its values
                           were wrong by one, so that means stay finite */
    uint32_t worst_frame, worst_camera;
} lab_views;

/* strip: NULL, or a PNG of truth, ours, error (5 times) of the worst picture. */
int lab_measure_views(lab_session *s, const char *strip, lab_views *v);

/* ---- anchors in time: lab_tracks.c makes the tracks, lab_anchors.c judges them ---- */

/* The cameras that train at a time. */
typedef struct {
    const ted4_camera **camera;
    size_t n;
} lab_rig;

/* At every time of the scene, 0 .. n_times - 1. An anchor's centre is the mean of those of its kept
 * Gaussians: it moves as the anchor does. */
typedef struct {
    size_t n, n_times; /* anchors, times */
    float *centre;     /* [n_times][n][3] world; owned, as all below */
    uint8_t *drawn; /* [n_times][n] 1: one of its Gaussians is as opaque as the rasteriser asks of
                       what it draws */
    lab_rig *rig;   /* [n_times]; cameras are the dataset's */
    double near_z;  /* what is not deeper is not drawn; world units */
    double size;    /* of the scene: the longest side of the box between the 1st and the 99th
                       percentile of its initial points; world units */
} lab_tracks;

/* Of all Gaussians and times, counts. */
typedef struct {
    size_t gaussians, refused; /* records of a query; times that the decoder refuses as not finite:
                                  such a time has no cameras and nothing drawn */
    size_t dead;               /* Gaussians whose opacity is 0 at all times */
    size_t full;               /* whose opacity reaches 1 */
    size_t thin;               /* with a scale that is 0 or below 2^-20 of the file's unit */
    size_t huge; /* with a scale above the file's unit, which is half the side of its space */
} lab_gaussians;

int lab_make_tracks(lab_session *s, lab_tracks *t, lab_gaussians *g);
void lab_free_tracks(lab_tracks *t);

/* Anchors that are drawn at a time at which something trains. Thrown out: drawn at such a time
 * while its centre lies in the picture of none of that time's cameras, although at another such
 * time its centre lies where one of these same cameras sees it: so it is the anchor that moved, not
 * the camera. In a picture: deeper than near_z, and projected to 0 <= x < width, 0 <= y < height.
 * displacement: of these anchors, how far the centre gets, while drawn, from where it was when
 * first drawn, in sizes of the scene: the largest, and the 99th percentile. */
typedef struct {
    size_t drawn, out;
    double displacement, displacement_99;
} lab_anchors;

/* 0, or -1: no memory. */
int lab_judge_anchors(const lab_tracks *t, lab_anchors *a);

/* ---- coded numbers: lab_symbols.c ---- */

/* Counts, and of how many. Rails are the ends of a range that the decoder clamps to, or that it
 * ends at. */
typedef struct {
    uint64_t symbols, escapes;       /* spec 9.4 */
    uint64_t symbol_ends;            /* +-32767 */
    uint64_t sigma_ends;             /* spec 10.1, of symbols */
    uint64_t steps, step_ends;       /* spec 10.1: step indices 0 or 255 */
    uint64_t contexts, context_ends; /* spec 10.3 */
    uint64_t widths, width_ends;     /* spec 11.4: durations at their floor */
} lab_symbols;

int lab_count_symbols(const lab_session *s, lab_symbols *y);

/* ---- the training's log: lab_log.c ---- */

typedef struct {
    size_t lines,
        bad; /* that tell a step; that are no JSON, as those with a number that is not finite */
    double loss_first, loss_last; /* distortion, running means over about 100 steps: of the first
                                     line and of the last */
    double gradient, peak; /* the largest norm of a term's gradient; the largest multiple of the
                              term's usual norm; -1: the log tells none */
    char gradient_term[32], peak_term[32]; /* which terms these are */
    uint64_t rollbacks;                    /* of the monitor, so far */
    uint64_t skipped, saturated; /* of the last line: Gaussians that were not finite, so far; values
                                  of anchors at an end of their range */
} lab_log;

int lab_read_log(const char *path, lab_log *l);

#endif
