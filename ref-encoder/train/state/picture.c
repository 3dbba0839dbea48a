/* picture.c - renders the model and compares it with pictures: see picture.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dropout.h"
#include "visible_blocks.h"

int ted4_trainer_generate(ted4_trainer *t, const ted4_picture *pic, ted4_pass pass,
                          ted4_generate_input *in, ted4_splats *s)
{
    if (pass == TED4_PASS_STEP)
        ted4_dropout(t);
    in->layout = &t->layout;
    in->net = t->net.value;
    in->attr = t->visible_blocks.used;
    in->position = t->visible_blocks.position;
    in->lanes = t->visible_blocks.lanes;
    in->num = t->data->n_frames > 1 && !t->phase.clock_stopped ? pic->frame : 0;
    in->den = t->data->n_frames > 1 ? t->data->n_frames - 1 : 1;
    in->activation = t->layout.head.activation && !t->phase.clock_stopped;
    ted4_visible_blocks_quantise(
        t, pass != TED4_PASS_IMAGE && !t->phase.integer ? TED4_QUANT_NOISE : TED4_QUANT_ROUND);
    ted4_visible_blocks_wake(t, in);
    in->n_visible = t->visible_blocks.awake;
    ted4_generator_pack(t->work.generator, t->net.value);
    return ted4_generate(t->work.generator, in, t->parallel, s) != 0
               ? ted4_trainer_fail(t, "no memory to render")
               : 0;
}

int ted4_trainer_render(ted4_trainer *t, const ted4_picture *pic, ted4_pass pass, ted4_view *v,
                        ted4_generate_input *in, ted4_splats *s)
{
    memset(in, 0, sizeof *in);
    ted4_trainer_view(t, pic, v, in->camera);
    if (ted4_visible_blocks_fill(t, v) != 0 || ted4_trainer_generate(t, pic, pass, in, s) != 0)
        return -1;
    return ted4_raster_forward(t->work.raster, s, v, t->parallel, pass != TED4_PASS_IMAGE,
                               t->work.image) != 0
               ? ted4_trainer_fail(t, "no memory to render")
               : 0;
}

int ted4_trainer_reserve_splats(ted4_trainer *t, size_t n)
{
    ted4_splat_grads *g = &t->work.splat_gradient;
    float *at;

    if (n > t->work.splat_capacity) {
        const size_t size = n + n / 2;

        free(t->work.splat_storage);
        free(t->work.splat_visible);
        t->work.splat_storage = aligned_alloc(64, (size * 15 * sizeof(float) + 63) / 64 * 64);
        t->work.splat_visible = malloc(size);
        t->work.splat_capacity = size;
        if (t->work.splat_storage == NULL || t->work.splat_visible == NULL) {
            t->work.splat_capacity = 0;
            return ted4_trainer_fail(t, "no memory for %zu Gaussians", n);
        }
    }
    at = t->work.splat_storage;
    for (int j = 0; j < 3; j++, at += t->work.splat_capacity)
        g->mean[j] = at;
    for (int j = 0; j < 3; j++, at += t->work.splat_capacity)
        g->scale[j] = at;
    for (int j = 0; j < 4; j++, at += t->work.splat_capacity)
        g->rot[j] = at;
    for (int j = 0; j < 3; j++, at += t->work.splat_capacity)
        g->colour[j] = at;
    g->opacity = at;
    g->mean2d = at + t->work.splat_capacity;
    g->visible = t->work.splat_visible;
    return 0;
}

int ted4_trainer_render_backward(ted4_trainer *t, const ted4_view *v, const ted4_splats *s)
{
    if (ted4_trainer_reserve_splats(t, s->n) != 0)
        return -1;
    return ted4_raster_backward(t->work.adjoint, t->work.raster, s, v, t->parallel, t->work.d_image,
                                &t->work.splat_gradient) != 0
               ? ted4_trainer_fail(t, "no memory for gradients")
               : 0;
}

int ted4_trainer_draw(ted4_trainer *t, const ted4_picture *pic, ted4_view *v, float centre[3])
{
    ted4_generate_input in;
    ted4_splats s;

    if (ted4_trainer_render(t, pic, TED4_PASS_IMAGE, v, &in, &s) != 0)
        return -1;
    memcpy(centre, in.camera, sizeof in.camera);
    return 0;
}

int ted4_trainer_corrected(const ted4_trainer *t, const ted4_picture *pic)
{
    return ted4_colour_has(&t->colour, pic->camera_id) &&
           (t->colour.matched || t->colour.exposure.n_knots > 0 || t->phase.stage2 ||
            (double)ted4_stage_position(t) >= t->opt.colour_start * (double)t->opt.stage1);
}

/* Returns t->work.image in the colours of the picture's camera at its time. */
static const float *shown(ted4_trainer *t, const ted4_picture *pic)
{
    const size_t pixels = (size_t)pic->camera.width * (size_t)pic->camera.height;
    ted4_colour_map map;

    if (!ted4_trainer_corrected(t, pic))
        return t->work.image;
    ted4_colour_at(&t->colour, pic->camera_id, pic->frame, map);
    return ted4_colour_apply(&t->colour, map, t->work.image, pixels, t->parallel);
}

const uint8_t *ted4_trainer_seen(ted4_trainer *t, size_t item)
{
    const ted4_picture *pic = &t->data->pictures[item];
    const size_t pixels = (size_t)pic->camera.width * (size_t)pic->camera.height;
    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);

    ted4_colour_map map;

    if (truth == NULL || !ted4_trainer_corrected(t, pic))
        return truth;
    ted4_colour_at(&t->colour, pic->camera_id, pic->frame, map);
    return ted4_colour_undo(&t->colour, map, truth, pixels, t->parallel);
}

double ted4_trainer_loss(ted4_trainer *t, const ted4_picture *pic, const uint8_t *truth,
                         ted4_colour_map map, double *l1, double *ssim)
{
    const int width = pic->camera.width, height = pic->camera.height;
    const double loss = ted4_loss(t->work.loss, shown(t, pic), truth, width, height,
                                  (float)t->opt.ssim, t->parallel, t->work.d_image, l1, ssim);

    if (map != NULL && ted4_trainer_corrected(t, pic) && loss >= 0) {
        ted4_colour_map at;

        ted4_colour_at(&t->colour, pic->camera_id, pic->frame, at);
        ted4_colour_backward(&t->colour, at, t->work.image, (size_t)width * (size_t)height,
                             t->parallel, t->work.d_image, map);
    }
    return loss;
}

/* Renders training picture item and computes its gradient in t->work.d_image. The colours of
 * cameras do not change. Returns the loss, or a negative number with t->message filled. */
static double judge(ted4_trainer *t, size_t item, int keep, ted4_view *v, ted4_splats *s)
{
    const ted4_picture *pic = &t->data->pictures[item];
    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);
    ted4_generate_input in;
    ted4_colour_map map;
    double loss = -1, l1, ssim;

    if (truth == NULL)
        return -1;
    if (ted4_trainer_render(t, pic, keep ? TED4_PASS_JUDGE : TED4_PASS_IMAGE, v, &in, s) == 0) {
        loss = ted4_trainer_loss(t, pic, truth, keep ? map : NULL, &l1, &ssim);
        if (!(loss >= 0))
            ted4_trainer_fail(t, loss < 0 ? "no memory for the loss" : "the loss is not finite");
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

int ted4_distortion_gradient(ted4_trainer *t, size_t item, ted4_splats *s)
{
    ted4_view v;

    return judge(t, item, 1, &v, s) < 0 ? -1 : ted4_trainer_render_backward(t, &v, s);
}

/* Returns the PSNR of the current model on one picture, or a negative number with t->message
 * filled.
 */
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

    const int bad = ted4_trainer_render(t, pic, TED4_PASS_IMAGE, &v, &in, &s) != 0;
    const size_t pixels = bad ? 0 : (size_t)v.width * (size_t)v.height;

    for (int c = 0; c < 3; c++)
        for (size_t k = 0; k < pixels; k++) {
            const float x = t->work.image[(size_t)c * pixels + k];
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
