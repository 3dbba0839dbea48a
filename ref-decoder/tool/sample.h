/* sample.h - the Gaussians at one time, ready for export: nearly transparent ones are dropped, and
 * spherical harmonics approximate the view-dependent heads (spec 11.5).
 * Depends on ted4.h, export.h, turn.h, widen.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SAMPLE_H
#define TED4_SAMPLE_H

#include "camera_list.h"
#include "export.h"
#include "ted4.h"
#include "turn.h"

typedef struct {
    ted4_recon *recon;
    const ted4_info *info;
    const ted4_parallel *parallel;
    float camera[3]; /* camera centre in the scene, used for everything except fitted colours */
    int sh_degree;   /* -1: no spherical harmonics */
    const ted4_turn *turn;         /* rotation of the result; NULL: none */
    const ted4_camera_list *widen; /* for these cameras (widen.h); NULL: scales as decoded */
    int keep_all;                  /* 0: Gaussians whose opacity is below 1/255 are dropped */
} ted4_sampler;

typedef struct {
    ted4_frame frame;
    double sh_rms; /* error of the fit; 0 if colours do not depend on the view */
    float *block;  /* owned: the arrays of frame */
    size_t *kept;  /* owned: [frame.n] record of each Gaussian */
} ted4_sample;

/* Samples the scene at the time num / den. out->frame.comment is not set. Returns TED4_OK, or
 * another status; then *out owns nothing. */
ted4_status ted4_sample_make(const ted4_sampler *s, uint32_t num, uint32_t den, ted4_sample *out);
void ted4_sample_finish(ted4_sample *s);

#endif
