/* step.c - does one training step: see step.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "step.h"

#include <string.h>

#include "apply_gradients.h"
#include "events.h"
#include "train/monitor/grad_norm.h"
#include "loss_terms.h"
#include "pose_step.h"
#include "train/monitor/monitor.h"
#include "train/monitor/rollback.h"
#include "train/densify/densify.h"
#include "train/math/random.h"
#include "picture_order.h"
#include "train/state/picture.h"
#include "train/state/view_batch.h"

static void follow(ted4_progress *p, double loss, double l1, double ssim, double splats,
                   double pixels, int first)
{
    const double w = first ? 1.0 : 0.01;

    p->last_loss = loss;
    p->loss += w * (loss - p->loss);
    p->l1 += w * (l1 - p->l1);
    p->ssim += w * (ssim - p->ssim);
    p->splats += w * (splats - p->splats);
    p->splat_pixels += w * (splats * pixels - p->splat_pixels);
}

/* The state of a step: its views, and means over them. */
typedef struct {
    ted4_view_batch b;
    double loss, l1, ssim;
    double on_screen, pixels;      /* Gaussians; of the pictures */
    double centre, drawn;          /* what ted4_update_volume reports */
    int corrected[TED4_MAX_VIEWS]; /* map is the gradient of the colours of its camera */
    ted4_colour_map map[TED4_MAX_VIEWS];
} pass;

/* Does the forward pass of view i, and computes the gradient of its loss in t->work.d_image.
 * Returns 0, or -1 with t->message filled. */
static int forward(ted4_trainer *t, pass *p, size_t i)
{
    const uint32_t item = p->b.item[i];
    const ted4_picture *pic = &t->data->pictures[item];
    const double share = 1.0 / (double)p->b.n;
    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);
    double loss = 0, l1, ssim;
    int bad;

    if (truth == NULL)
        return -1;
    p->corrected[i] = ted4_trainer_corrected(t, pic);
    bad = ted4_batch_render(t, &p->b, i) != 0;
    if (!bad) {
        loss = ted4_trainer_loss(t, pic, truth, p->map[i], &l1, &ssim);
        bad = ted4_monitor_loss(t, loss) != 0;
        if (!bad && loss < 0)
            bad = ted4_trainer_fail(t, "no memory for the loss");
    }
    ted4_dataset_release(t->data, item);
    if (bad)
        return -1;
    p->loss += share * loss;
    p->l1 += share * l1;
    p->ssim += share * ssim;
    return 0;
}

static void gather_pose(ted4_trainer *t, const pass *p, size_t i)
{
    ted4_pose_gather(t, &t->data->pictures[p->b.item[i]], &p->b.v[i], &p->b.s);
}

/* Backpropagates view i from its image to its Gaussians. Returns 0, or -1 with t->message
 * filled. */
static int backward(ted4_trainer *t, pass *p, size_t i)
{
    const double share = 1.0 / (double)p->b.n;

    if (ted4_batch_render_backward(t, &p->b, i) != 0)
        return -1;
    p->on_screen += share * (double)ted4_update_volume(t, &p->b.s);
    p->pixels += share * (double)p->b.v[i].width * (double)p->b.v[i].height;
    p->centre += share * t->monitor.norm[TED4_TERM_CENTRE];
    p->drawn += share * t->monitor.drawn;
    if (!t->phase.stage2)
        ted4_densify_gather(t, &p->b.in, &p->b.s);
    ted4_batch_add(t, &p->b);
    if (p->b.n > 1)
        gather_pose(t, p, i);
    return 0;
}

/* Backpropagates from the Gaussians to the values of anchors and networks, and adds the gradients
 * of the other terms of the loss. Returns 0, or -1 with t->message filled. */
static int finish_backward(ted4_trainer *t, pass *p, uint64_t key)
{
    t->monitor.norm[TED4_TERM_CENTRE] = p->centre;
    t->monitor.drawn = p->drawn;
    memset(t->net.gradient, 0, t->layout.n_net * sizeof *t->net.gradient);
    if (ted4_batch_backward(t, &p->b) != 0)
        return -1;
    if (p->b.n == 1)
        gather_pose(t, p, 0);
    ted4_update_bank(t);
    return t->phase.stage2 ? ted4_update_rate(t, key) : 0;
}

static void apply(ted4_trainer *t, pass *p)
{
    ted4_update_parameters(t, p->b.n);
    ted4_update_poses(t);
    t->monitor.norm[TED4_TERM_COLOUR] = 0;
    for (size_t i = 0; i < p->b.n; i++) {
        if (!p->corrected[i])
            continue;
        t->monitor.norm[TED4_TERM_COLOUR] += ted4_gradients_norm(p->map[i], TED4_COLOUR_VALUES) /
                                             (double)p->b.n;
        ted4_colour_update(&t->colour, t->data->pictures[p->b.item[i]].camera_id, p->map[i],
                           t->opt.lr_colour * t->monitor.state.factor, t->opt.colour_weight);
    }
}

static int one_step(ted4_trainer *t)
{
    pass p = { .loss = 0 };
    const uint32_t *item;
    size_t n;

    if (ted4_monitor_begin(t) != 0 || ted4_schedule_event(t) != 0)
        return -1;

    const uint64_t key = ted4_random(t->opt.seed, t->iteration);

    if (ted4_next_pictures(t, &item, &n) != 0 || ted4_batch_begin(t, &p.b, item, n) != 0)
        return -1;
    for (size_t i = 0; i < n; i++)
        if (forward(t, &p, i) != 0 || backward(t, &p, i) != 0)
            return -1;
    if (finish_backward(t, &p, key) != 0)
        return -1;
    apply(t, &p);
    if (ted4_monitor_look(t, p.loss, &p.b.all, &p.b.s) != 0)
        return -1;
    follow(&t->progress, p.loss, p.l1, p.ssim, p.on_screen, p.pixels, t->iteration == 0);
    t->iteration++;
    return 0;
}

int ted4_gradient_step(ted4_trainer *t)
{
    return one_step(t) == 0 ? ted4_trainer_report(t, 1) : ted4_monitor_recover(t);
}
