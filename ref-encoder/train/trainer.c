/* trainer.c - see trainer.h: construction.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "trainer.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "adam.h"
#include "random.h"
#include "seed.h"
#include "space.h"
#include "transient.h"

int ted4_trainer_fail(ted4_trainer *t, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(t->message.text, sizeof t->message.text, format, arguments);
    va_end(arguments);
    return -1;
}

/* The feature is cut in slices that grow like 1, 2, 3, ... (algorithm facts 3.3: 5, 10, 15, 20 of 50). */
static void make_slices(ted4_header *h, int n)
{
    const int whole = n * (n + 1) / 2;
    int       done = 0;

    h->n_slices = 0;
    for (int i = 1; i <= n; i++) {
        const int upto = (h->feature_dim * i * (i + 1) / 2 + whole / 2) / whole;

        if (upto > done)
            h->slice[h->n_slices++] = (uint8_t)(upto - done);
        done = upto;
    }
}

static void make_header_time(ted4_header *h, const ted4_train_options *o,
                             const ted4_dataset *d)
{
    const int still = d->n_frames <= 1;

    h->frames = d->n_frames;
    h->rate_num = d->rate > 0 ? (uint32_t)lrint(d->rate * 1000.0) : 30;
    h->rate_den = d->rate > 0 ? 1000 : 1;
    h->activation = (uint8_t)(still ? 0 : o->activation);
    h->motion = (uint8_t)(still ? TED4_MOTION_NONE : o->motion);
    if (h->motion == TED4_MOTION_NONE)
        return;
    h->temporal_mask = (uint8_t)o->temporal_mask;
    h->deform_layers = (uint8_t)o->deform_layers;
    h->deform_width = (uint16_t)o->deform_width;
    if (h->motion == TED4_MOTION_INR)
        return;
    h->phi_dim = (uint8_t)o->phi;
    h->bank_rows = o->bank_rows > 0 ? (uint32_t)o->bank_rows : (d->n_frames + 1) / 2;
    h->bank_dim = (uint16_t)o->bank_dim;
}

static void make_header(ted4_header *h, const ted4_train_options *o, const ted4_dataset *d)
{
    memset(h, 0, sizeof *h);
    h->tile_size = 4096;
    h->n_offsets = (uint8_t)o->offsets;
    h->feature_dim = (uint8_t)o->feature;
    make_header_time(h, o, d);
    h->offset_mask = (uint8_t)o->offset_mask;
    h->view = (uint8_t)o->view;
    h->head_layers = (uint8_t)o->head_layers;
    h->head_width = (uint16_t)(o->head_layers > 0 ? o->head_width : 0);
    h->scale_domain = o->linear_scale ? TED4_SCALE_LINEAR : TED4_SCALE_LOG2;
    h->prior = o->factorised ? TED4_PRIOR_FACTORISED : TED4_PRIOR_INR;
    if (!o->factorised) {
        h->pe_octaves = (uint8_t)o->octaves;
        h->hyper_layers = (uint8_t)o->hyper_layers;
        h->hyper_width = (uint16_t)(o->hyper_layers > 0 ? o->hyper_width : 0);
    }
    make_slices(h, o->slices);
    h->ar_width = (uint16_t)(h->n_slices > 1 ? o->ar_width : 0);
    h->context_bits = 8;

    const double step[TED4_TYPES] = { o->step_feature, o->step_scaling, o->step_offset,
                                      o->step_phi, o->step_tau };

    for (int y = 0; y < TED4_TYPES; y++)
        h->step[y] = (float)step[y];
    memcpy(h->background, d->background, sizeof h->background);
    ted4_space_make(h, d);
}

int ted4_trainer_rebuild(ted4_trainer *t)
{
    const size_t n = t->layout.n_net + 1;

    free(t->net);
    free(t->net_m);
    free(t->net_v);
    free(t->net_gradient);
    t->net = calloc(n, sizeof *t->net);
    t->net_m = calloc(n, sizeof *t->net_m);
    t->net_v = calloc(n, sizeof *t->net_v);
    t->net_gradient = calloc(n, sizeof *t->net_gradient);
    ted4_generator_free(t->generator);
    t->generator = ted4_generator_new(&t->layout);
    ted4_rate_free(t->rate);
    t->rate = ted4_rate_new(&t->layout);
    ted4_slots_finish(&t->slots);
    if (t->net == NULL || t->net_m == NULL || t->net_v == NULL || t->net_gradient == NULL ||
        t->generator == NULL || t->rate == NULL)
        return ted4_trainer_fail(t, "no memory for the networks");
    return 0;
}

static int make_order(ted4_trainer *t)
{
    t->order.item = malloc((t->data->n_pictures + 1) * sizeof *t->order.item);
    if (t->order.item == NULL)
        return ted4_trainer_fail(t, "no memory for the order of pictures");
    for (uint32_t i = 0; i < t->data->n_pictures; i++)
        if (!t->data->pictures[i].is_test)
            t->order.item[t->order.n++] = i;
    if (t->order.n == 0)
        return ted4_trainer_fail(t, "no training pictures");
    t->order.key = ted4_mix(t->opt.seed ^ 0x6f72646572u);
    t->order.next = t->order.n;
    return 0;
}

static int make_images(ted4_trainer *t)
{
    size_t pixels = 0;

    for (size_t i = 0; i < t->data->n_pictures; i++) {
        const ted4_camera *c = &t->data->pictures[i].camera;
        const size_t       n = (size_t)c->width * (size_t)c->height;

        pixels = n > pixels ? n : pixels;
    }
    t->image = malloc(3 * pixels * sizeof *t->image + 64);
    t->d_image = malloc(3 * pixels * sizeof *t->d_image + 64);
    t->raster = ted4_raster_new();
    t->loss = ted4_loss_workspace_new();
    if (t->image == NULL || t->d_image == NULL || t->raster == NULL || t->loss == NULL)
        return ted4_trainer_fail(t, "no memory for images of %zu pixels", pixels);
    return 0;
}

int ted4_trainer_init(ted4_trainer *t, const ted4_train_options *o, ted4_dataset *d,
                      const ted4_parallel *p)
{
    ted4_header h;

    memset(t, 0, sizeof *t);
    t->opt = *o;
    t->data = d;
    t->parallel = p;
    make_header(&h, o, d);
    ted4_layout_make(&t->layout, &h);
    if (ted4_trainer_rebuild(t) != 0 || make_order(t) != 0 || make_images(t) != 0)
        return -1;
    if (ted4_anchors_init(&t->anchors, &t->layout) != 0 ||
        ted4_seed_anchors(&t->anchors, &t->layout, d, o, &t->cell) != 0)
        return ted4_trainer_fail(t, "no memory for the anchors");
    if (t->anchors.n == 0)
        return ted4_trainer_fail(t, "no initial point lies inside the scene's bounds");
    ted4_seed_networks(t->net, &t->layout, o->seed);
    return ted4_seed_transients(t);
}

void ted4_trainer_finish(ted4_trainer *t)
{
    ted4_anchors_finish(&t->anchors);
    ted4_slots_finish(&t->slots);
    free(t->net);
    free(t->net_m);
    free(t->net_v);
    free(t->net_gradient);
    free(t->shift);
    free(t->order.item);
    ted4_generator_free(t->generator);
    ted4_rate_free(t->rate);
    ted4_raster_free(t->raster);
    ted4_loss_workspace_free(t->loss);
    free(t->image);
    free(t->d_image);
    free(t->splat_storage);
    free(t->splat_visible);
    memset(t, 0, sizeof *t);
}

uint64_t ted4_trainer_total(const ted4_trainer *t)
{
    return (uint64_t)t->opt.stage1 + (uint64_t)t->opt.stage2;
}

/* A sum of products with 0 is 0 unless a value is infinite or not a number. */
static int all_finite(const float *x, size_t n)
{
    float sum = 0;

#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++)
        sum += x[i] * 0.0f;
    return sum == 0.0f;
}

int ted4_trainer_check(ted4_trainer *t, int anchors)
{
    const unsigned long long now = t->iteration;

    if (!all_finite(t->net, t->layout.n_net))
        return ted4_trainer_fail(t, "a network weight is not finite at step %llu", now);
    if (anchors &&
        !all_finite(t->anchors.data[TED4_ROW_VALUE],
                    t->anchors.n_blocks * (size_t)t->layout.n_channels * TED4_LANES))
        return ted4_trainer_fail(t, "an anchor's value is not finite at step %llu", now);
    return 0;
}
