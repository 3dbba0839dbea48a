/* trainer.c - see trainer.h: construction.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "trainer.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "train/densify/camera_colour_init.h"
#include "train/model/header_from_options.h"
#include "train/math/random.h"
#include "train/model/init.h"
#include "train/model/normalise.h"
#include "train/densify/short_lived.h"

int ted4_trainer_fail(ted4_trainer *t, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(t->message.text, sizeof t->message.text, format, arguments);
    va_end(arguments);
    return -1;
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
        const size_t n = (size_t)c->width * (size_t)c->height;

        pixels = n > pixels ? n : pixels;
    }
    t->image = malloc(3 * pixels * sizeof *t->image + 64);
    t->d_image = malloc(3 * pixels * sizeof *t->d_image + 64);
    t->raster = ted4_raster_new();
    t->loss = ted4_loss_workspace_new();
    if (t->image == NULL || t->d_image == NULL || t->raster == NULL || t->loss == NULL)
        return ted4_trainer_fail(t, "no memory for images of %zu pixels", pixels);
    if (t->opt.colour && ted4_colour_init(&t->colour, t->data) != 0)
        return ted4_trainer_fail(t, "no memory for colour correction");
    return 0;
}

/* Everything at its start, in the layout of h. */
static int begin(ted4_trainer *t, const ted4_header *h)
{
    const char *wrong = ted4_header_wrong(h);

    if (wrong != NULL)
        return ted4_trainer_fail(
            t, "no file can hold this scene with these options: %s is beyond its range in a header",
            wrong);
    ted4_layout_make(&t->layout, h);
    t->charged = t->layout.head;
    ted4_grid_full(t->bits);
    t->watch.state.factor = 1;
    if (ted4_trainer_rebuild(t) != 0 || make_order(t) != 0 || make_images(t) != 0)
        return -1;
    if (ted4_anchors_init(&t->anchors, &t->layout) != 0 ||
        ted4_seed_anchors(&t->anchors, &t->layout, t->data, &t->opt, &t->cell) != 0)
        return ted4_trainer_fail(t, "no memory for the anchors");
    if (t->anchors.n == 0)
        return ted4_trainer_fail(t, "no initial point lies inside the scene's bounds");
    ted4_seed_networks(t->net, &t->layout, t->opt.seed);
    if (ted4_colour_match(t) != 0)
        return -1;
    return t->opt.transients ? ted4_seed_transients(t) : 0;
}

int ted4_trainer_init(ted4_trainer *t, const ted4_train_options *o, ted4_dataset *d,
                      const ted4_parallel *p)
{
    ted4_header h;

    memset(t, 0, sizeof *t);
    t->opt = *o;
    t->data = d;
    t->parallel = p;
    ted4_header_make(&h, o, d);
    return begin(t, &h);
}

int ted4_trainer_restart(ted4_trainer *t, const ted4_header *h)
{
    const ted4_train_options opt = t->opt;
    ted4_dataset *data = t->data;
    const ted4_parallel *parallel = t->parallel;
    const double seconds = t->seconds;
    const ted4_onlooker onlooker = t->onlooker;

    ted4_trainer_finish(t);
    t->opt = opt;
    t->data = data;
    t->parallel = parallel;
    t->seconds = seconds;
    t->onlooker = onlooker;
    t->probed = 1;
    return begin(t, h);
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
    free(t->trial);
    free(t->order.item);
    ted4_generator_free(t->generator);
    ted4_rate_free(t->rate);
    ted4_raster_free(t->raster);
    ted4_loss_workspace_free(t->loss);
    ted4_colour_finish(&t->colour);
    ted4_watch_forget(t);
    free(t->image);
    free(t->d_image);
    free(t->splat_storage);
    free(t->splat_visible);
    memset(t, 0, sizeof *t);
}

void ted4_trainer_busy(ted4_trainer *t, ted4_busy busy, double budget)
{
    t->onlooker.busy = busy;
    t->onlooker.spent = 0;
    t->onlooker.budget = budget;
}

int ted4_trainer_told(ted4_trainer *t, double spent)
{
    ted4_onlooker *o = &t->onlooker;

    o->spent += spent;
    if (o->look == NULL || o->look(o->user) == 0 || o->busy == TED4_BUSY_TRAINING)
        return 0;
    o->stopped = 1;
    return ted4_trainer_fail(t, "stopped");
}

double ted4_trainer_charged(const ted4_trainer *t)
{
    ted4_shape s;
    double sum = 0;

    ted4_shape_make(&s, &t->charged);
    for (int y = 0; y < TED4_TYPES; y++)
        sum += s.dim[y];
    return sum;
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
    if (anchors && !all_finite(t->anchors.data[TED4_ROW_VALUE],
                               t->anchors.n_blocks * (size_t)t->layout.n_channels * TED4_LANES))
        return ted4_trainer_fail(t, "an anchor's value is not finite at step %llu", now);
    if (anchors && !all_finite(t->anchors.data[TED4_ROW_POSITION],
                               t->anchors.n_blocks * (size_t)3 * TED4_LANES))
        return ted4_trainer_fail(t, "an anchor's position is not finite at step %llu", now);
    return ted4_colour_finite(&t->colour)
               ? 0
               : ted4_trainer_fail(t, "a colour map is not finite at step %llu", now);
}
