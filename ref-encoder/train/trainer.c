/* trainer.c - see trainer.h: construction and one step.
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

/* Room for the gradients of n splats. */
static int reserve_splats(ted4_trainer *t, size_t n)
{
    ted4_splat_grads *g = &t->splat_gradient;
    float            *at;

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

/* Volume term: weight times the mean of the product of scales over the Gaussians on screen. Returns how many there are. */
static size_t add_volume(ted4_trainer *t, const ted4_splats *s)
{
    ted4_splat_grads *g = &t->splat_gradient;
    size_t            n = 0;

    for (size_t i = 0; i < s->n; i++)
        n += g->visible[i];

    const float w = n > 0 ? (float)(t->opt.volume_weight / (double)n) : 0.0f;

#pragma omp simd
    for (size_t i = 0; i < s->n; i++) {
        const float on = w * (float)g->visible[i];
        const float a = s->scale[0][i], b = s->scale[1][i], c = s->scale[2][i];

        g->scale[0][i] += on * b * c;
        g->scale[1][i] += on * a * c;
        g->scale[2][i] += on * a * b;
    }
    return n;
}

/* Mean squared second difference of the bank's rows. */
static void add_bank_smoothness(ted4_trainer *t)
{
    const ted4_header *h = &t->layout.head;
    const size_t       D = h->bank_dim, M = h->bank_rows;
    const float       *z = t->net + t->layout.bank;
    float             *d = t->net_gradient + t->layout.bank;

    if (M < 3)
        return;

    const float w = (float)(2.0 * t->opt.tv_weight / ((double)(M - 2) * (double)D));

    for (size_t i = 0; i + 2 < M; i++)
        for (size_t c = 0; c < D; c++) {
            const float e = z[i * D + c] - 2.0f * z[(i + 1) * D + c] + z[(i + 2) * D + c];

            d[i * D + c] += w * e;
            d[(i + 1) * D + c] -= 2.0f * w * e;
            d[(i + 2) * D + c] += w * e;
        }
}

/* Largest number of channels that header ranges allow (model.h). */
enum { MAX_CHANNELS = TED4_MAX_FEATURE + 6 + 4 * TED4_MAX_OFFSETS + TED4_MAX_PHI + 4 + 1 };

typedef struct {
    ted4_trainer *t;
    uint64_t      key;
    ted4_quant    quant;
    float         rate[MAX_CHANNELS];
    ted4_adam_bias bias;
    float         mask_weight, temporal_weight;
} slot_job;

static void quantise_slot(void *arg, size_t i)
{
    const slot_job   *j = arg;
    const ted4_slots *s = &j->t->slots;
    const size_t      floats = (size_t)j->t->layout.n_channels * TED4_LANES;

    ted4_quantise(&j->t->layout, j->quant, s->raw[i], s->steps[i], s->block[i], j->key,
                  s->quantised + i * floats);
}

/* d sigmoid(logit) times weight, for the anchors of the slot. */
static void add_mask_loss(const slot_job *j, size_t i, int channel, int n, float weight)
{
    const ted4_slots *s = &j->t->slots;

    for (int c = channel; c < channel + n; c++)
        for (int k = 0; k < TED4_LANES; k++) {
            const float x = s->raw[i][c * TED4_LANES + k];
            const float m = 1.0f / (1.0f + expf(-x));
            const float on = (float)(s->lanes[i] >> k & 1);

            s->gradient[i][c * TED4_LANES + k] += on * weight * m * (1.0f - m);
        }
}

static void update_slot(void *arg, size_t i)
{
    const slot_job    *j = arg;
    ted4_trainer      *t = j->t;
    const ted4_slots  *s = &t->slots;
    const ted4_layout *l = &t->layout;
    float *x = ted4_block(&t->anchors, TED4_ROW_VALUE, s->block[i]);
    float *m = ted4_block(&t->anchors, TED4_ROW_M, s->block[i]);
    float *v = ted4_block(&t->anchors, TED4_ROW_V, s->block[i]);

    if (j->mask_weight > 0)
        add_mask_loss(j, i, l->offset_logit, l->head.n_offsets, j->mask_weight);
    if (j->temporal_weight > 0)
        add_mask_loss(j, i, l->temporal_logit, 1, j->temporal_weight);
    for (int c = 0; c < l->n_channels; c++) {
        const size_t at = (size_t)c * TED4_LANES;

        if (j->rate[c] > 0)
            ted4_adam(x + at, m + at, v + at, s->gradient[i] + at, TED4_LANES, j->rate[c],
                      j->bias);
    }
}

static void update_parameters(ted4_trainer *t)
{
    const ted4_header *h = &t->layout.head;
    const uint64_t     count = t->iteration - (t->stage2 ? t->stage2_start : 0) + 1;
    const double       n = (double)t->anchors.n;
    slot_job           j = { .t = t, .bias = ted4_adam_bias_make(count) };

    ted4_schedule_rates(t, j.rate);
    if (t->stage2 && h->offset_mask)
        j.mask_weight = (float)(t->opt.lambda * t->opt.mask_weight / (n * h->n_offsets));
    if (h->motion != TED4_MOTION_NONE && h->temporal_mask)
        j.temporal_weight = (float)(t->opt.temporal_weight / n);
    ted4_parallel_for(t->parallel, t->slots.n, update_slot, &j);
    ted4_schedule_network_step(t);
}

/* Rate of a random share of the visible blocks: gradients of bits on values, masks and NETE, and of the distortion on step sizes. */
static int add_rate(ted4_trainer *t, uint64_t key)
{
    ted4_slots  *s = &t->slots;
    const size_t want = (size_t)ceil(t->opt.rate_share * (double)s->n);
    const size_t m = want < s->n ? want : s->n;
    double       bits[TED4_TYPES], params = 0, chosen = 0;

    /* Partial shuffle: the first m slots are a uniform choice; the order of the others does not matter. */
    for (size_t i = 0; i < m; i++) {
        const size_t k = i + ted4_below(key, i, (uint32_t)(s->n - i));

#define SWAP(type, a) do { type x_ = s->a[i]; s->a[i] = s->a[k]; s->a[k] = x_; } while (0)
        SWAP(uint32_t, block);
        SWAP(uint32_t, lanes);
        SWAP(const float *, position);
        SWAP(const float *, raw);
        SWAP(const float *, used);
        SWAP(float *, gradient);
        SWAP(float *, steps);
#undef SWAP
    }
    for (size_t i = 0; i < m; i++)
        for (uint32_t x = s->lanes[i]; x != 0; x &= x - 1)
            chosen += 1;
    for (int y = 0; y < TED4_TYPES; y++)
        params += t->layout.shape.dim[y];

    ted4_rate_input in = {
        &t->layout, t->net, t->shift, m, s->raw, s->position, s->lanes, s->block, key,
        t->integer ? TED4_QUANT_INTEGER : TED4_QUANT_NOISE,
        (float)(t->opt.lambda / (fmax(chosen, 1) * params)), (float)((double)s->n / (double)m),
        t->layout.head.activation
    };

    if (!t->integer)
        ted4_rate_pack(t->rate, t->net);
    if (m > 0 && ted4_rate_evaluate(t->rate, &in, t->parallel, (const float *const *)s->gradient,
                                    s->gradient, t->net_gradient, s->steps, bits) != 0)
        return ted4_trainer_fail(t, "no memory for the rate model");
    for (int y = 0; y < TED4_TYPES && chosen > 0; y++)
        t->progress.bits[y] += 0.02 * (bits[y] / chosen - t->progress.bits[y]);
    return 0;
}

static void follow(ted4_progress *p, double loss, double l1, double ssim, double splats,
                   int first)
{
    const double w = first ? 1.0 : 0.01;

    p->loss += w * (loss - p->loss);
    p->l1 += w * (l1 - p->l1);
    p->ssim += w * (ssim - p->ssim);
    p->splats += w * (splats - p->splats);
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
    in->num = t->data->n_frames > 1 ? pic->frame : 0;
    in->den = t->data->n_frames > 1 ? t->data->n_frames - 1 : 1;
    in->activation = t->layout.head.activation;
    if (t->stage2) {
        slot_job j = { .t = t, .key = ted4_random(t->opt.seed, t->iteration),
                       .quant = training && !t->integer ? TED4_QUANT_NOISE
                                                        : TED4_QUANT_ROUND };

        ted4_parallel_for(t->parallel, t->slots.n, quantise_slot, &j);
    }
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
    *on_screen = add_volume(t, s);
    memset(t->net_gradient, 0, t->layout.n_net * sizeof *t->net_gradient);
    if (ted4_generate_backward(t->generator, in, &t->splat_gradient, t->parallel,
                               t->slots.gradient, t->net_gradient) != 0)
        return ted4_trainer_fail(t, "no memory for gradients");
    add_bank_smoothness(t);
    return 0;
}

/* Looking at every anchor takes time, so it is done once in so many steps. */
enum { CHECK_ANCHORS = 100 };

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

int ted4_trainer_step(ted4_trainer *t)
{
    if (ted4_trainer_check(t, t->iteration % CHECK_ANCHORS == 0) != 0 ||
        ted4_schedule_event(t) != 0)
        return -1;

    const uint32_t      item = next_picture(&t->order);
    const ted4_picture *pic = &t->data->pictures[item];
    const uint64_t      key = ted4_random(t->opt.seed, t->iteration);
    ted4_view           v;
    ted4_generate_input in;
    ted4_splats         s;
    double              l1, ssim;
    size_t              on_screen = 0;

    const uint8_t *truth = ted4_dataset_pixels(t->data, item, &t->message);

    if (truth == NULL)
        return -1;
    if (render(t, pic, 1, &v, &in, &s) != 0) {
        ted4_dataset_release(t->data, item);
        return -1;
    }
    const double loss = ted4_loss(t->loss, t->image, truth, v.width, v.height,
                                  (float)t->opt.ssim, t->parallel, t->d_image, &l1, &ssim);

    ted4_dataset_release(t->data, item);
    if (!isfinite(loss))
        return ted4_trainer_fail(t, "the loss is not finite at step %llu",
                                 (unsigned long long)t->iteration);
    if (loss < 0)
        return ted4_trainer_fail(t, "no memory for the loss");
    if (backward(t, &v, &in, &s, &on_screen) != 0)
        return -1;
    if (!t->stage2)
        ted4_densify_gather(t, &s);
    if (t->stage2 && add_rate(t, key) != 0)
        return -1;
    update_parameters(t);
    follow(&t->progress, loss, l1, ssim, (double)on_screen, t->iteration == 0);
    t->iteration++;
    return 0;
}

double ted4_trainer_preview(ted4_trainer *t, int n)
{
    size_t tests = 0;
    double sum = 0;
    int    done = 0;

    for (size_t i = 0; i < t->data->n_pictures; i++)
        tests += t->data->pictures[i].is_test;

    const size_t from = tests > 0 ? tests : t->data->n_pictures;
    size_t       seen = 0;

    for (size_t i = 0; i < t->data->n_pictures && done < n; i++) {
        const ted4_picture *pic = &t->data->pictures[i];
        ted4_view           v;
        ted4_generate_input in;
        ted4_splats         s;

        if (tests > 0 && !pic->is_test)
            continue;
        if (seen++ != (size_t)done * from / (size_t)n)
            continue;
        const uint8_t *truth = ted4_dataset_pixels(t->data, i, &t->message);

        if (truth == NULL || render(t, pic, 0, &v, &in, &s) != 0)
            return -1;
        const size_t pixels = (size_t)v.width * (size_t)v.height;
        double       square = 0;

        for (int c = 0; c < 3; c++)
            for (size_t k = 0; k < pixels; k++) {
                const float x = t->image[(size_t)c * pixels + k];
                const float e = (x < 0 ? 0 : x > 1 ? 1 : x) -
                                (float)truth[3 * k + (size_t)c] / 255.0f;

                square += (double)(e * e);
            }
        ted4_dataset_release(t->data, i);
        sum += -10.0 * log10(fmax(square / (3.0 * (double)pixels), 1e-10));
        done++;
    }
    return done > 0 ? sum / done : 0;
}
