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
#include "train/state/picture.h"

static uint32_t next_picture(ted4_order *o)
{
    if (o->next >= o->n) {
        for (uint32_t i = o->n; i > 1; i--) {
            const uint32_t j = ted4_below(o->key, o->round << 32 | i, i);
            const uint32_t x = o->item[i - 1];

            o->item[i - 1] = o->item[j];
            o->item[j] = x;
        }
        o->round++;
        o->next = 0;
    }
    return o->item[o->next++];
}

/* Announces the next pictures, so that they can be decoded in the meantime. Those after the next
 * shuffle are not known yet. */
static void announce(const ted4_trainer *t)
{
    const ted4_order *o = &t->order;

    for (uint32_t i = o->next; i < o->n && i < o->next + TED4_DATASET_AHEAD; i++)
        ted4_dataset_ahead(t->data, o->item[i]);
}

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

/* The state of one picture during a step. */
typedef struct {
    const ted4_picture *pic;
    ted4_view v;
    ted4_generate_input in;
    ted4_splats s;
    double loss, l1, ssim;
    size_t on_screen; /* number of Gaussians */
    int corrected;    /* map is the gradient of its camera's colours */
    ted4_colour_map map;
} pass;

/* Does the forward pass of the next picture, and computes the gradient of its loss in
 * t->work.d_image. Returns 0, or -1 with t->message filled. */
static int forward(ted4_trainer *t, pass *p)
{
    const uint32_t item = next_picture(&t->order);
    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);
    int bad;

    if (truth == NULL)
        return -1;
    announce(t);
    p->pic = &t->data->pictures[item];
    p->corrected = ted4_trainer_corrected(t, p->pic);
    bad = ted4_trainer_render(t, p->pic, TED4_PASS_STEP, &p->v, &p->in, &p->s) != 0;
    if (!bad) {
        p->loss = ted4_trainer_loss(t, p->pic, truth, p->map, &p->l1, &p->ssim);
        bad = ted4_monitor_loss(t, p->loss) != 0;
        if (!bad && p->loss < 0)
            bad = ted4_trainer_fail(t, "no memory for the loss");
    }
    ted4_dataset_release(t->data, item);
    return bad ? -1 : 0;
}

/* Backpropagates from the image to the values of anchors and networks, and adds the gradients of
 * the other terms of the loss. Returns 0, or -1 with t->message filled. */
static int backward(ted4_trainer *t, pass *p, uint64_t key)
{
    if (ted4_trainer_render_backward(t, &p->v, &p->s) != 0)
        return -1;
    p->on_screen = ted4_update_volume(t, &p->s);
    memset(t->net.gradient, 0, t->layout.n_net * sizeof *t->net.gradient);
    if (ted4_generate_backward(t->work.generator, &p->in, &t->work.splat_gradient, t->parallel,
                               t->visible_blocks.gradient, t->net.gradient) != 0)
        return ted4_trainer_fail(t, "no memory for gradients");
    ted4_pose_gather(t, p->pic, &p->v, &p->s);
    ted4_update_bank(t);
    if (!t->phase.stage2) {
        ted4_densify_gather(t, &p->in, &p->s);
        return 0;
    }
    return ted4_update_rate(t, key);
}

static void apply(ted4_trainer *t, const pass *p)
{
    ted4_update_parameters(t);
    ted4_update_poses(t);
    t->monitor.norm[TED4_TERM_COLOUR] = 0;
    if (!p->corrected)
        return;
    t->monitor.norm[TED4_TERM_COLOUR] = ted4_gradients_norm(p->map, TED4_COLOUR_VALUES);
    ted4_colour_update(&t->colour, p->pic->camera_id, p->map,
                       t->opt.lr_colour * t->monitor.state.factor, t->opt.colour_weight);
}

static int one_step(ted4_trainer *t)
{
    pass p;

    if (ted4_monitor_begin(t) != 0 || ted4_schedule_event(t) != 0)
        return -1;

    const uint64_t key = ted4_random(t->opt.seed, t->iteration);

    if (forward(t, &p) != 0 || backward(t, &p, key) != 0)
        return -1;
    apply(t, &p);
    if (ted4_monitor_look(t, p.loss, &p.in, &p.s) != 0)
        return -1;
    follow(&t->progress, p.loss, p.l1, p.ssim, (double)p.on_screen,
           (double)p.v.width * (double)p.v.height, t->iteration == 0);
    t->iteration++;
    return 0;
}

int ted4_gradient_step(ted4_trainer *t)
{
    return one_step(t) == 0 ? ted4_trainer_report(t, 1) : ted4_monitor_recover(t);
}
