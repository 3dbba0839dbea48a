/* lab_facts.h - declarations shared by lab_facts.c, which prints the results of the stability lab,
 * and the files that measure them: one decoded file, its scene, and the results.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LAB_FACTS_H
#define TED4_LAB_FACTS_H

#include "data/dataset.h"
#include "render/view.h"

typedef struct {
    ted4_scene *scene; /* owned, as all below */
    ted4_recon *recon;
    ted4_dataset data; /* empty if no scene was named */
    ted4_info info;
    size_t bytes; /* size of the file */
} lab_session;

/* Prints a line and returns TED4_EXIT_TOOL. All functions below return an exit code, and have
 * printed a line if it is not TED4_EXIT_FINE. */
int lab_failed(const char *what, const char *why);

/* ---- held-out pictures: lab_views.c ---- */

typedef struct {
    size_t views;       /* number of held-out pictures; 0: the values below are unset */
    size_t exact;       /* number of pictures that equal the truth */
    size_t refused;     /* number that the decoder refuses to reconstruct, because values are not
                           finite; they count in no value below */
    double mean, worst; /* PSNR, dB. For a picture that equals the truth, one wrong value is
                           assumed, so that means stay finite */
    uint32_t worst_frame, worst_camera;
} lab_views;

/* strip: NULL, or a PNG file to write with the truth, our picture and the error (5 times) of the
 * worst picture. */
int lab_measure_views(lab_session *s, const char *strip, lab_views *v);

/* ---- anchors over time: lab_tracks.c makes the tracks, lab_anchors.c judges them ---- */

/* The cameras with a training picture at one time. */
typedef struct {
    const ted4_camera **camera;
    size_t n;
} lab_rig;

/* The anchors at every time of the scene, 0 .. n_times - 1. The centre of an anchor is the mean of
 * the centres of its kept Gaussians, so that it moves as the anchor does. */
typedef struct {
    size_t n, n_times; /* number of anchors, and of times */
    float *centre;     /* [n_times][n][3] world; owned, as all below */
    uint8_t *drawn;    /* [n_times][n] 1: the rasteriser draws at least one of its Gaussians */
    lab_rig *rig;      /* [n_times]; the cameras are those of the dataset */
    double near_z;     /* depth up to which nothing is drawn; world units */
    double size; /* size of the scene: the longest side of the box between the 1st and the 99th
                    percentile of its initial points; world units */
} lab_tracks;

/* Counts over all Gaussians and times. */
typedef struct {
    size_t gaussians, refused; /* records of a query; times that the decoder refuses because values
                                  are not finite: such a time has no cameras and draws nothing */
    size_t dead;               /* Gaussians whose opacity is 0 at all times */
    size_t full;               /* Gaussians whose opacity reaches 1 */
    size_t thin; /* Gaussians with a scale that is 0, or below 2^-20 of the file's unit */
    size_t huge; /* Gaussians with a scale above the file's unit, which is half the side of its
                    space */
} lab_gaussians;

int lab_make_tracks(lab_session *s, lab_tracks *t, lab_gaussians *g);
void lab_free_tracks(lab_tracks *t);

/* drawn: anchors that are drawn at a time with training cameras. out: of these, the anchors that
 * their motion throws out: at such a time the anchor is drawn while none of the time's cameras has
 * its centre in the picture, although at another such time its centre lies where one of these same
 * cameras sees it. So the anchor has moved, not the camera. In the picture: deeper than near_z, and
 * projected to 0 <= x < width, 0 <= y < height. displacement: over the same anchors, how far the
 * centre moves, while drawn, from where the anchor was first drawn, in sizes of the scene: the
 * maximum, and the 99th percentile. */
typedef struct {
    size_t drawn, out;
    double displacement, displacement_99;
} lab_anchors;

/* Returns 0, or -1 without memory. */
int lab_judge_anchors(const lab_tracks *t, lab_anchors *a);

/* ---- coded values: lab_symbols.c ---- */

/* Numbers of values, each with the number of those at an end of their range: where the decoder
 * clamps, or where the range ends. */
typedef struct {
    uint64_t symbols, escapes;       /* spec 9.4 */
    uint64_t symbol_ends;            /* +-32767 */
    uint64_t sigma_ends;             /* sigma indices (spec 10.1) of symbols */
    uint64_t steps, step_ends;       /* spec 10.1: step indices, and those that are 0 or 255 */
    uint64_t contexts, context_ends; /* spec 10.3 */
    uint64_t widths, width_ends;     /* spec 11.4: durations, and those at their minimum */
} lab_symbols;

int lab_count_symbols(const lab_session *s, lab_symbols *y);

/* ---- the log of the training: lab_log.c ---- */

typedef struct {
    size_t lines, bad; /* lines that report a step; lines that are not JSON, for example because a
                          number is not finite */
    double loss_first, loss_last; /* distortion, as running means over about 100 steps, in the first
                                     and in the last line */
    double gradient, peak; /* the largest norm of a term's gradient, and the largest ratio of a norm
                              to the usual norm of its term; -1: not in the log */
    char gradient_term[32], peak_term[32]; /* the terms of these two */
    uint64_t rollbacks;                    /* rollbacks of the monitor in total */
    uint64_t skipped, saturated; /* from the last line: total number of Gaussians that were not
                                    finite, and of anchor values at an end of their range */
} lab_log;

int lab_read_log(const char *path, lab_log *l);

#endif
