/* step.c - one training step: a picture, its Gaussians forward and back, and the update. See
 * trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/search/model_search.h"
#include "grad_norm.h"
#include "train/math/random.h"
#include "train/model/normalise.h"
#include "train/state/trainer.h"

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

/* The pictures after this one may be decoded meanwhile; what comes after the next shuffle is not
 * known yet. */
static void announce(const ted4_trainer *t)
{
    const ted4_order *o = &t->order;

    for (uint32_t i = o->next; i < o->n && i < o->next + TED4_DATASET_AHEAD; i++)
        ted4_dataset_ahead(t->data, o->item[i]);
}

/* Room for the gradients of n splats. */
static int reserve_splats(ted4_trainer *t, size_t n)
{
    ted4_splat_grads *g = &t->splat_gradient;
    float *at;

    if (n > t->splat_capacity) {
        const size_t size = n + n / 2;

        free(t->splat_storage);
        free(t->splat_visible);
        t->splat_storage = aligned_alloc(64, (size * 15 * sizeof(float) + 63) / 64 * 64);
        t->splat_visible = malloc(size);
        t->splat_capacity = size;
        if (t->splat_storage == NULL || t->splat_visible == NULL) {
            t->splat_capacity = 0;
            return ted4_trainer_fail(t, "no memory for %zu Gaussians", n);
        }
    }
    at = t->splat_storage;
    for (int j = 0; j < 3; j++, at += t->splat_capacity)
        g->mean[j] = at;
    for (int j = 0; j < 3; j++, at += t->splat_capacity)
        g->scale[j] = at;
    for (int j = 0; j < 4; j++, at += t->splat_capacity)
        g->rot[j] = at;
    for (int j = 0; j < 3; j++, at += t->splat_capacity)
        g->colour[j] = at;
    g->opacity = at;
    g->mean2d = at + t->splat_capacity;
    g->visible = t->splat_visible;
    return 0;
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

/* Forward pass of one picture over t->slots; the image is in t->image. */
static int render(ted4_trainer *t, const ted4_picture *pic, int training, ted4_view *v,
                  ted4_generate_input *in, ted4_splats *s)
{
    memset(in, 0, sizeof *in);
    ted4_space_view(&t->layout.head, &pic->camera, v, in->camera);
    if (ted4_slots_fill(t, v) != 0)
        return -1;
    in->layout = &t->layout;
    in->net = t->net;
    in->n_slots = t->slots.n;
    in->attr = t->slots.used;
    in->position = t->slots.position;
    in->lanes = t->slots.lanes;
    in->num = t->data->n_frames > 1 && !t->clock_stopped ? pic->frame : 0;
    in->den = t->data->n_frames > 1 ? t->data->n_frames - 1 : 1;
    in->activation = t->layout.head.activation && !t->clock_stopped;
    ted4_slots_quantise(t, training && !t->integer ? TED4_QUANT_NOISE : TED4_QUANT_ROUND);
    ted4_generator_pack(t->generator, t->net);
    if (ted4_generate(t->generator, in, t->parallel, s) != 0 ||
        ted4_raster_forward(t->raster, s, v, t->parallel, training, t->image) != 0)
        return ted4_trainer_fail(t, "no memory to render");
    return 0;
}

static int backward(ted4_trainer *t, const ted4_view *v, const ted4_generate_input *in,
                    const ted4_splats *s, size_t *on_screen)
{
    if (reserve_splats(t, s->n) != 0)
        return -1;
    if (ted4_raster_backward(t->raster, s, v, t->parallel, t->d_image, &t->splat_gradient) != 0)
        return ted4_trainer_fail(t, "no memory for gradients");
    *on_screen = ted4_update_volume(t, s);
    memset(t->net_gradient, 0, t->layout.n_net * sizeof *t->net_gradient);
    if (ted4_generate_backward(t->generator, in, &t->splat_gradient, t->parallel, t->slots.gradient,
                               t->net_gradient) != 0)
        return ted4_trainer_fail(t, "no memory for gradients");
    ted4_update_bank(t);
    return 0;
}

int ted4_trainer_draw(ted4_trainer *t, const ted4_picture *pic, ted4_view *v, float centre[3])
{
    ted4_generate_input in;
    ted4_splats s;

    if (render(t, pic, 0, v, &in, &s) != 0)
        return -1;
    memcpy(centre, in.camera, sizeof in.camera);
    return 0;
}

/* Are colours of this picture's camera corrected by now? Where nothing is known about them, the
 * scene first learns what most cameras agree about. */
static int is_corrected(const ted4_trainer *t, const ted4_picture *pic)
{
    return ted4_colour_has(&t->colour, pic->camera_id) &&
           (t->colour.matched || t->stage2 ||
            (double)t->iteration >= t->opt.colour_start * (double)t->opt.stage1);
}

/* t->image with the colours of the picture's camera. */
static const float *shown(ted4_trainer *t, const ted4_picture *pic)
{
    const size_t pixels = (size_t)pic->camera.width * (size_t)pic->camera.height;

    return is_corrected(t, pic)
               ? ted4_colour_apply(&t->colour, pic->camera_id, t->image, pixels, t->parallel)
               : t->image;
}

const uint8_t *ted4_trainer_seen(ted4_trainer *t, size_t item)
{
    const ted4_picture *pic = &t->data->pictures[item];
    const size_t pixels = (size_t)pic->camera.width * (size_t)pic->camera.height;
    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);

    return truth != NULL && is_corrected(t, pic)
               ? ted4_colour_undo(&t->colour, pic->camera_id, truth, pixels, t->parallel)
               : truth;
}

/* Distortion of t->image against truth; its gradient is in t->d_image, and the camera's colours
 * have made their step. As ted4_loss. */
static double distortion(ted4_trainer *t, const ted4_picture *pic, const ted4_view *v,
                         const uint8_t *truth, double *l1, double *ssim)
{
    const size_t pixels = (size_t)v->width * (size_t)v->height;
    ted4_colour_map gradient;
    const double loss = ted4_loss(t->loss, shown(t, pic), truth, v->width, v->height,
                                  (float)t->opt.ssim, t->parallel, t->d_image, l1, ssim);

    t->watch.norm[TED4_TERM_COLOUR] = 0;
    if (!is_corrected(t, pic) || !(loss >= 0))
        return loss;
    ted4_colour_backward(&t->colour, pic->camera_id, t->image, pixels, t->parallel, t->d_image,
                         gradient);
    t->watch.norm[TED4_TERM_COLOUR] = ted4_gradients_norm(gradient, TED4_COLOUR_VALUES);
    ted4_colour_update(&t->colour, pic->camera_id, gradient,
                       t->opt.lr_colour * t->watch.state.factor, t->opt.colour_weight);
    return loss;
}

/* Draws training picture item and leaves its gradient in t->d_image; cameras' colours stay as they
 * are. Loss, or negative with t->message. */
static double judge(ted4_trainer *t, size_t item, int keep, ted4_view *v, ted4_splats *s)
{
    const ted4_picture *pic = &t->data->pictures[item];
    const size_t pixels = (size_t)pic->camera.width * (size_t)pic->camera.height;
    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);
    ted4_generate_input in;
    ted4_colour_map gradient;
    double loss = -1, l1, ssim;

    if (truth == NULL)
        return -1;
    if (render(t, pic, keep, v, &in, s) == 0) {
        loss = ted4_loss(t->loss, shown(t, pic), truth, v->width, v->height, (float)t->opt.ssim,
                         t->parallel, t->d_image, &l1, &ssim);
        if (!(loss >= 0))
            ted4_trainer_fail(t, loss < 0 ? "no memory for the loss" : "the loss is not finite");
        else if (keep && is_corrected(t, pic))
            ted4_colour_backward(&t->colour, pic->camera_id, t->image, pixels, t->parallel,
                                 t->d_image, gradient);
    }
    ted4_dataset_release(t->data, item);
    return loss >= 0 ? loss : -1;
}

double ted4_trainer_distortion(ted4_trainer *t, size_t item)
{
    ted4_view v;
    ted4_splats s;

    return judge(t, item, 0, &v, &s);
}

int ted4_trainer_blame(ted4_trainer *t, size_t item, ted4_splats *s)
{
    ted4_view v;

    if (judge(t, item, 1, &v, s) < 0 || reserve_splats(t, s->n) != 0)
        return -1;
    return ted4_raster_backward(t->raster, s, &v, t->parallel, t->d_image, &t->splat_gradient) != 0
               ? ted4_trainer_fail(t, "no memory for gradients")
               : 0;
}

/* The probe begins when the first anchors stand. */
#define PROBE_FROM 0.25

static int probe_due(const ted4_trainer *t)
{
    return !t->probed && t->iteration == (uint64_t)(PROBE_FROM * (double)t->opt.stage1);
}

/* One picture forward: in, s, v and the gradient in t->d_image. Loss, or negative with t->message.
 */
static double forward(ted4_trainer *t, uint32_t item, ted4_view *v, ted4_generate_input *in,
                      ted4_splats *s, double *l1, double *ssim)
{
    const ted4_picture *pic = &t->data->pictures[item];
    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);
    double loss = -1;

    if (truth == NULL)
        return -1;
    announce(t);
    if (render(t, pic, 1, v, in, s) == 0) {
        loss = distortion(t, pic, v, truth, l1, ssim);
        if (ted4_watch_loss(t, loss) != 0)
            loss = -1;
        else if (loss < 0)
            ted4_trainer_fail(t, "no memory for the loss");
    }
    ted4_dataset_release(t->data, item);
    return loss;
}

static int one_step(ted4_trainer *t)
{
    ted4_view v;
    ted4_generate_input in;
    ted4_splats s;
    double l1, ssim;
    size_t on_screen = 0;

    if (ted4_watch_begin(t) != 0 || ted4_schedule_event(t) != 0)
        return -1;

    const uint64_t key = ted4_random(t->opt.seed, t->iteration);
    const double loss = forward(t, next_picture(&t->order), &v, &in, &s, &l1, &ssim);

    if (loss < 0 || backward(t, &v, &in, &s, &on_screen) != 0)
        return -1;
    if (!t->stage2)
        ted4_densify_gather(t, &in, &s);
    if (t->stage2 && ted4_update_rate(t, key) != 0)
        return -1;
    ted4_update_parameters(t);
    if (ted4_watch_look(t, loss, &in, &s) != 0)
        return -1;
    follow(&t->progress, loss, l1, ssim, (double)on_screen, (double)v.width * (double)v.height,
           t->iteration == 0);
    t->iteration++;
    return 0;
}

/* What is due now of deciding how much model there is; NULL: nothing. *budget: training steps that
 * it takes at most. */
static int (*decision(const ted4_trainer *t, double *budget))(ted4_trainer *)
{
    const double end = ted4_capacity_refine_steps(t) + ted4_capacity_prune_steps(t);

    if (t->decided == TED4_DECIDED_NOTHING && t->stage2 && !t->integer &&
        t->iteration == ted4_capacity_step(t)) {
        *budget = ted4_capacity_budget(t) - end;
        return ted4_capacity_decide;
    }
    if (t->decided == TED4_DECIDED_MODEL && ted4_integer_due(t)) {
        *budget = ted4_capacity_refine_steps(t);
        return ted4_capacity_refine;
    }
    *budget = ted4_capacity_prune_steps(t);
    return t->decided == TED4_DECIDED_BITS && t->integer ? ted4_capacity_prune : NULL;
}

static int decide(ted4_trainer *t)
{
    double budget;
    int (*const settle)(ted4_trainer *) = decision(t, &budget);

    if (settle == NULL)
        return 0;
    ted4_trainer_busy(t, TED4_BUSY_TRIALS, budget);

    const int bad = settle(t);

    ted4_trainer_busy(t, TED4_BUSY_TRAINING, 0);
    return bad;
}

int ted4_trainer_long_step(const ted4_trainer *t)
{
    double budget;

    return (probe_due(t) && ted4_probe_steps(t) > 0) ||
           (decision(t, &budget) != NULL && budget > 0);
}

int ted4_trainer_step(ted4_trainer *t)
{
    if (probe_due(t) && ted4_probe_time(t) != 0)
        return -1;
    if (decide(t) != 0)
        return -1;
    return one_step(t) == 0 ? ted4_trainer_told(t, 1) : ted4_watch_recover(t);
}

/* PSNR of the model as it is on one picture. Negative: failed, with t->message. */
static double preview(ted4_trainer *t, size_t item)
{
    const ted4_picture *pic = &t->data->pictures[item];
    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);
    ted4_view v;
    ted4_generate_input in;
    ted4_splats s;
    double square = 0;

    if (truth == NULL)
        return -1;

    const int bad = render(t, pic, 0, &v, &in, &s) != 0;
    const size_t pixels = bad ? 0 : (size_t)v.width * (size_t)v.height;

    for (int c = 0; c < 3; c++)
        for (size_t k = 0; k < pixels; k++) {
            const float x = t->image[(size_t)c * pixels + k];
            const float e = (x < 0 ? 0 : x > 1 ? 1 : x) - (float)truth[3 * k + (size_t)c] / 255.0f;

            square += (double)(e * e);
        }
    ted4_dataset_release(t->data, item);
    return bad ? -1 : -10.0 * log10(fmax(square / (3.0 * (double)pixels), 1e-10));
}

double ted4_trainer_preview(ted4_trainer *t, int n)
{
    size_t tests = 0, seen = 0, done = 0;
    double sum = 0;

    for (size_t i = 0; i < t->data->n_pictures; i++)
        tests += t->data->pictures[i].is_test;

    const size_t from = tests > 0 ? tests : t->data->n_pictures,
                 most = (size_t)n < from ? (size_t)n : from;

    for (size_t i = 0; i < t->data->n_pictures && done < most; i++) {
        if ((tests > 0 && !t->data->pictures[i].is_test) || seen++ != done * from / most)
            continue;

        const double psnr = preview(t, i);

        if (psnr < 0)
            return -1;
        sum += psnr;
        done++;
    }
    return done > 0 ? sum / (double)done : 0;
}
