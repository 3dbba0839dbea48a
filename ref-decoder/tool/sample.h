/* sample.h - the Gaussians of one time, ready for a format: those worth keeping, with spherical
 * harmonics that stand for
 * view-dependent heads (spec 11.5).
 * Depends on ted4.h, export.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SAMPLE_H
#define TED4_SAMPLE_H

#include "export.h"
#include "ted4.h"

typedef struct {
    ted4_recon *recon;
    const ted4_info *info;
    const ted4_parallel *parallel;
    float camera[3]; /* centre for everything but fitted colours */
    int sh_degree;   /* -1: no spherical harmonics */
    int keep_all;    /* 0: Gaussians under an opacity of 1/255 are left out */
} ted4_sampler;

typedef struct {
    ted4_frame frame;
    double sh_rms; /* of the fit, 0 when colours do not depend on the view */
    float *block;  /* owned: what frame points to */
    size_t *kept;  /* owned: [frame.n] record of each Gaussian */
} ted4_sample;

/* TED4_OK, or why not; then *out holds nothing. comment is not set. */
ted4_status ted4_sample_make(const ted4_sampler *s, uint32_t num, uint32_t den, ted4_sample *out);
void ted4_sample_finish(ted4_sample *s);

#endif
