/* sensitivity.c - measures how much the pictures depend on each Gaussian: see sensitivity.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "sensitivity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/state/picture.h"
#include "train/state/view_subset.h"

/* SHARE: share of all training steps whose time is spent on sampling pictures. FEWEST and A_FRAME:
 * the minimum number of pictures in all, and per frame. STEPS_A_PICTURE: time of one picture in
 * training steps, as a picture takes the forward and most of the backward pass. */
#define SHARE 0.02
enum { FEWEST = 32, A_FRAME = 2 };
#define STEPS_A_PICTURE (2.0 / 3.0)

static size_t pictures(const ted4_trainer *t)
{
    const double least = fmax(FEWEST, A_FRAME * (double)ted4_view_subset_frames(t));
    const double n = fmax(SHARE / STEPS_A_PICTURE * (double)ted4_trainer_total(t), least);

    return n < (double)t->order.n ? (size_t)n : t->order.n;
}

double ted4_opacity_sensitivity_steps(const ted4_trainer *t)
{
    return STEPS_A_PICTURE * (double)pictures(t);
}

/* Adds the sensitivities of one picture. */
static void gather(const ted4_trainer *t, const ted4_splats *s, float weight, float *use)
{
    const size_t K = t->layout.head.n_offsets;

    for (size_t i = 0; i < t->visible_blocks.awake; i++)
        for (size_t k = 0; k < K; k++)
            for (size_t j = 0; j < TED4_LANES; j++) {
                const size_t at = (i * K + k) * TED4_LANES + j;
                const size_t anchor = t->visible_blocks.block[i] * (size_t)TED4_LANES + j;

                if (!(t->visible_blocks.lanes[i] >> j & 1))
                    continue;

                use[anchor * K + k] += weight *
                                       fabsf(s->opacity[at] * t->work.splat_gradient.opacity[at]);
            }
}

/* Marks Gaussians that no picture showed, unless all pictures were sampled. */
static void mark_unseen(const ted4_trainer *t, size_t n, float *use)
{
    for (size_t i = 0; n < t->order.n && i < t->anchors.n * t->layout.head.n_offsets; i++)
        if (!(use[i] > 0))
            use[i] = TED4_UNSEEN;
}

int ted4_opacity_sensitivity(ted4_trainer *t, float *use)
{
    const size_t n = pictures(t);
    uint32_t *item = malloc(n * sizeof *item);
    int bad = item == NULL;

    if (bad)
        ted4_trainer_fail(t, "no memory to look at Gaussians");
    bad = bad || ted4_view_subset_choose(t, t->opt.seed ^ 0x7573616765u, n, item) != 0;
    memset(use, 0, t->anchors.n * t->layout.head.n_offsets * sizeof *use);
    for (size_t i = 0; !bad && i < n; i++) {
        ted4_splats s;

        bad = ted4_distortion_gradient(t, item[i], &s) != 0;
        if (!bad)
            gather(t, &s, 1.0f / (float)n, use);
    }
    free(item);
    if (!bad)
        mark_unseen(t, n, use);
    return bad || ted4_trainer_report(t, ted4_opacity_sensitivity_steps(t)) != 0 ? -1 : 0;
}
