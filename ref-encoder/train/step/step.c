/* step.c - does one training step: see step.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "step.h"

#include <math.h>
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
#include "view_results.h"

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

/* The state of a step: its views, what was found out about each, and means over them. */
typedef struct {
    ted4_view_batch b;
    ted4_view_result result[TED4_MAX_VIEWS];
    double loss, l1, ssim;
    double on_screen, pixels; /* Gaussians; of the pictures */
} pass;

static const ted4_picture *picture_of(const ted4_trainer *t, const pass *p, size_t i)
{
    return &t->data->pictures[p->b.item[i]];
}

/* Does the forward pass of view i, and computes the gradient of its loss in t->work.d_image.
 * Returns 0, or -1 with t->message filled. */
static int forward(ted4_trainer *t, pass *p, size_t i)
{
    const uint32_t item = p->b.item[i];
    ted4_view_result *r = &p->result[i];
    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);
    int bad;

    if (truth == NULL)
        return -1;
    bad = ted4_batch_render(t, &p->b, i) != 0;
    if (!bad) {
        r->loss = ted4_trainer_loss(t, picture_of(t, p, i), truth, r->map, &r->l1, &r->ssim);
        if (isfinite(r->loss) && r->loss < 0)
            bad = ted4_trainer_fail(t, "no memory for the loss");
    }
    ted4_dataset_release(t->data, item);
    return bad ? -1 : 0;
}

static void pose_gradient(ted4_trainer *t, pass *p, size_t i)
{
    ted4_pose_gradient(t, picture_of(t, p, i), &p->b.v[i], &p->b.s, p->result[i].pose);
}

/* Backpropagates view i from its image to its Gaussians. Returns 0, or -1 with t->message
 * filled. */
static int backward(ted4_trainer *t, pass *p, size_t i)
{
    ted4_view_result *r = &p->result[i];

    if (ted4_batch_render_backward(t, &p->b, i) != 0)
        return -1;
    r->on_screen = (double)ted4_update_volume(t, &p->b.s);
    r->centre = t->monitor.norm[TED4_TERM_CENTRE];
    r->drawn = t->monitor.drawn;
    if (!t->phase.stage2 && p->b.n == 1)
        ted4_densify_gather(t, &p->b.in, &p->b.s);
    if (!t->phase.stage2 && p->b.n > 1)
        ted4_densify_view(t, &p->b.in, &p->b.s, ted4_batch_other(t, &p->b));
    ted4_batch_add(t, &p->b);
    if (p->b.n > 1)
        pose_gradient(t, p, i);
    return 0;
}

/* Draws those views that are this process's, there and back, up to one whose loss is not finite.
 * Returns 0, or -1 with t->message filled. */
static int draw_views(ted4_trainer *t, pass *p)
{
    for (size_t i = p->b.first; i < p->b.end; i++) {
        if (forward(t, p, i) != 0)
            return -1;
        if (!isfinite(p->result[i].loss))
            return 0;
        if (backward(t, p, i) != 0)
            return -1;
    }
    return 0;
}

/* Collects the results of all views, and computes means. Returns 0, or -1 with t->message filled;
 * that includes a loss that is not finite. */
static int collect(ted4_trainer *t, pass *p)
{
    const double share = 1.0 / (double)p->b.n;
    double centre = 0, drawn = 0;

    if (ted4_view_results_gather(t, p->result, p->b.n) != 0)
        return -1;
    for (size_t i = 0; i < p->b.n; i++) {
        const ted4_view_result *r = &p->result[i];

        if (ted4_monitor_loss(t, r->loss) != 0)
            return -1;
        p->loss += share * r->loss;
        p->l1 += share * r->l1;
        p->ssim += share * r->ssim;
        p->on_screen += share * r->on_screen;
        p->pixels += share * (double)p->b.v[i].width * (double)p->b.v[i].height;
        centre += share * r->centre;
        drawn += share * r->drawn;
    }
    t->monitor.norm[TED4_TERM_CENTRE] = centre;
    t->monitor.drawn = drawn;
    return 0;
}

/* Backpropagates from the Gaussians to the values of anchors and networks, and adds the gradients
 * of the other terms of the loss. Returns 0, or -1 with t->message filled. */
static int finish_backward(ted4_trainer *t, pass *p, uint64_t key)
{
    memset(t->net.gradient, 0, t->layout.n_net * sizeof *t->net.gradient);
    if (ted4_batch_backward(t, &p->b) != 0)
        return -1;
    if (p->b.n == 1)
        pose_gradient(t, p, 0);
    if (!t->phase.stage2 && p->b.n > 1)
        ted4_densify_add(t, p->b.other);
    ted4_update_bank(t);
    return t->phase.stage2 ? ted4_update_rate(t, key) : 0;
}

static void apply(ted4_trainer *t, pass *p)
{
    ted4_update_parameters(t, p->b.n);
    for (size_t i = 0; i < p->b.n; i++)
        ted4_pose_add(t, picture_of(t, p, i), p->result[i].pose);
    ted4_update_poses(t);
    t->monitor.norm[TED4_TERM_COLOUR] = 0;
    for (size_t i = 0; i < p->b.n; i++) {
        const ted4_picture *pic = picture_of(t, p, i);
        const float *map = p->result[i].map;

        if (!ted4_trainer_corrected(t, pic))
            continue;
        t->monitor.norm[TED4_TERM_COLOUR] += ted4_gradients_norm(map, TED4_COLOUR_VALUES) /
                                             (double)p->b.n;
        ted4_colour_update(&t->colour, pic->camera_id, pic->frame, map,
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
    const size_t per_block = t->phase.stage2 ? 0 : ted4_densify_per_block(t);

    if (ted4_next_pictures(t, &item, &n) != 0 ||
        ted4_batch_begin(t, &p.b, item, n, per_block) != 0 || draw_views(t, &p) != 0 ||
        collect(t, &p) != 0 || finish_backward(t, &p, key) != 0)
        return -1;
    apply(t, &p);
    if (ted4_monitor_look(t, p.loss, &p.b.all, &p.b.s) != 0)
        return -1;
    follow(&t->progress, p.loss, p.l1, p.ssim, p.on_screen, p.pixels, t->iteration == 0);
    t->iteration++;
    return 0;
}

/* Goes back to the last good state. If no step lies between it and the failure, smaller learning
 * rates change nothing; therefore those pictures are skipped. */
static int recover(ted4_trainer *t)
{
    const uint64_t failed = t->iteration;
    const uint32_t *item;
    size_t n;

    if (ted4_monitor_recover(t) != 0)
        return -1;
    return t->iteration == failed ? ted4_next_pictures(t, &item, &n) : 0;
}

int ted4_gradient_step(ted4_trainer *t)
{
    return one_step(t) == 0 ? ted4_trainer_report(t, 1) : recover(t);
}
