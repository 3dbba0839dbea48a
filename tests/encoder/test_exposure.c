/* test_exposure.c - train/loss/camera_exposure.h and train/densify/camera_exposure_init.h: the
 * gains and their gradient against central differences in double precision, their gauge, how they
 * are found, that light which all cameras see and what moves are none, and that checkpoints keep
 * them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ball_trainer.h"
#include "larger.h"
#include "test.h"
#include "tiny_scene.h"
#include "tools/scene/ray_rig.h"
#include "train/densify/camera_exposure_init.h"
#include "train/math/random.h"
#include "train/monitor/checkpoint.h"
#include "train/state/picture.h"
#include "train/step/apply_gradients.h"

enum { CAMERAS = 6, FRAMES = 16, N = TED4_COLOUR_VALUES };

/* ---- without pictures: gains ---- */

static ted4_picture shots[CAMERAS * FRAMES + 1];
static uint8_t all[CAMERAS + 1];

/* Cameras that take a picture each at every time, but for the last one, which takes one at every
 * second time. */
static ted4_dataset plan(void)
{
    ted4_dataset d = { .pictures = shots, .n_cameras = CAMERAS, .n_frames = FRAMES };

    memset(shots, 0, sizeof shots);
    memset(all, 1, sizeof all);
    for (uint32_t i = 0; i < CAMERAS * FRAMES; i++)
        if (i % CAMERAS < CAMERAS - 1 || i / CAMERAS % 2 == 0) {
            shots[d.n_pictures].camera = (ted4_camera) { .width = 1, .height = 1 };
            shots[d.n_pictures].camera_id = i % CAMERAS;
            shots[d.n_pictures++].frame = i / CAMERAS;
        }
    return d;
}

static void fill(ted4_exposure *e)
{
    for (uint64_t i = 0; i < 3 * e->n_cameras * e->n_knots; i++)
        e->value[i] = 0.4f * ted4_uniform(9, i) - 0.2f;
}

static void test_knots(void **state)
{
    ted4_dataset d = plan();
    ted4_exposure e;

    (void)state;
    assert_int_equal(ted4_exposure_init(&e, &d, all), 0);
    assert_int_equal(e.n_knots, 4); /* 88 pictures by 6 cameras */
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        double sum = 0;

        for (size_t k = 0; k < e.n_knots; k++)
            sum += ted4_exposure_weight(&e, k, frame);
        assert_true(fabs(sum - 1) < 1e-12);
    }
    assert_true(ted4_exposure_weight(&e, 0, 0) == 1);
    assert_true(ted4_exposure_weight(&e, 3, FRAMES - 1) == 1);
    ted4_exposure_finish(&e);
    /* Three pictures each are not worth two knots; held-out pictures do not count. */
    for (size_t i = 3 * CAMERAS; i < d.n_pictures; i++)
        d.pictures[i].is_test = 1;
    assert_int_equal(ted4_exposure_init(&e, &d, all), 0);
    assert_int_equal(e.n_knots, 0);
    ted4_exposure_finish(&e);
}

/* A loss of what a camera makes of one colour at two times, and of the knots themselves, in double
 * precision. value: [3 * knots], map: [N]. */
static double loss_of(const ted4_exposure *e, const double *value, const double *map,
                      uint32_t frame, double smoothness, double size)
{
    static const double rgb[3] = { 0.3, 0.7, 0.5 };
    double loss = 0;

    for (size_t c = 0; c < 3; c++) {
        double x = rgb[c] + map[9 + c], gain = 1;

        for (size_t r = 0; r < 3; r++)
            x += rgb[r] * map[3 * r + c];
        for (size_t k = 0; k < e->n_knots; k++)
            gain += ted4_exposure_weight(e, k, frame) * value[3 * k + c];
        loss += 0.5 * (1 + (double)c) * (gain * x) * (gain * x);
    }
    for (size_t i = 0; i < 3 * e->n_knots; i++) {
        loss += size * value[i] * value[i];
        if (i >= 3 && i + 3 < 3 * e->n_knots) {
            const double bend = value[i - 3] - 2 * value[i] + value[i + 3];

            loss += smoothness * bend * bend;
        }
    }
    return loss;
}

static void expect_near(double got, double want, const char *what, size_t i)
{
    if (!(fabs(got - want) <= 1e-5))
        fail_msg("%s %zu: %.9g, central difference %.9g", what, i, got, want);
}

/* Sets gradient to dL/d(map of ted4_colour_at) by ted4_colour_backward, for the loss without its
 * last terms. */
static void backward(ted4_colour *c, uint32_t camera, uint32_t frame, ted4_colour_map gradient)
{
    static const float rgb[3] = { 0.3f, 0.7f, 0.5f };
    ted4_colour_map at;
    float d_image[3];

    ted4_colour_at(c, camera, frame, at);
    memcpy(d_image, ted4_colour_apply(c, at, rgb, 1, NULL), sizeof d_image);
    for (size_t k = 0; k < 3; k++)
        d_image[k] *= 1 + (float)k;
    ted4_colour_backward(c, at, rgb, 1, NULL, d_image, gradient);
}

static void check_gradient(ted4_colour *c, uint32_t camera, uint32_t frame)
{
    const double smoothness = 0.7, size = 0.3, h = 1e-5;
    ted4_exposure *e = &c->exposure;
    double value[3 * TED4_EXPOSURE_KNOTS], map[N];
    ted4_colour_map gradient;
    float d_gain[3];

    for (size_t i = 0; i < 3 * e->n_knots; i++)
        value[i] = (double)e->value[3 * camera * e->n_knots + i];
    for (int i = 0; i < N; i++)
        map[i] = (double)c->value[camera][i];
    backward(c, camera, frame, gradient);
    ted4_colour_split(c, camera, frame, gradient, d_gain);
    ted4_exposure_backward(e, camera, frame, d_gain, smoothness, size);
    for (size_t i = 0; i < N + 3 * e->n_knots; i++) {
        double *const x = i < N ? &map[i] : &value[i - N], was = *x;
        double side[2];

        for (int k = 0; k < 2; k++) {
            *x = was + (k ? h : -h);
            side[k] = loss_of(e, value, map, frame, smoothness, size);
        }
        *x = was;
        expect_near(i < N ? (double)gradient[i] : (double)e->gradient[i - N],
                    (side[1] - side[0]) / (2 * h), i < N ? "map" : "knot", i < N ? i : i - N);
    }
}

static void test_gradient(void **state)
{
    const ted4_dataset d = plan();
    ted4_colour c;

    (void)state;
    assert_int_equal(ted4_colour_init(&c, &d), 0);
    assert_int_equal(ted4_exposure_init(&c.exposure, &d, c.corrected), 0);
    fill(&c.exposure);
    for (uint64_t k = 0; k < N * CAMERAS; k++)
        c.value[k / N][k % N] = 0.6f * ted4_uniform(4, k) - 0.3f;
    check_gradient(&c, 0, 0);
    check_gradient(&c, 3, 7);
    check_gradient(&c, 5, FRAMES - 1);
    ted4_colour_finish(&c);
}

/* Without exposures, no bit of a map or of its gradient changes. */
static void test_none(void **state)
{
    const ted4_dataset d = plan();
    ted4_colour c;
    ted4_colour_map map, gradient, before;
    float d_gain[3];

    (void)state;
    assert_int_equal(ted4_colour_init(&c, &d), 0);
    for (uint64_t k = 0; k < N; k++)
        before[k] = c.value[2][k] = 0.6f * ted4_uniform(4, k) - 0.3f;
    ted4_colour_at(&c, 2, 5, map);
    assert_memory_equal(map, before, sizeof map);
    memcpy(gradient, before, sizeof gradient);
    ted4_colour_split(&c, 2, 5, gradient, d_gain);
    assert_memory_equal(gradient, before, sizeof gradient);
    ted4_colour_finish(&c);
}

/* What all cameras have in common at a time is taken away, and so is what a camera shows alone. */
static void test_gauge(void **state)
{
    ted4_dataset d = plan();
    ted4_exposure e, with;

    (void)state;
    assert_int_equal(ted4_exposure_init(&e, &d, all), 0);
    assert_int_equal(ted4_exposure_init(&with, &d, all), 0);
    fill(&e);
    fill(&with);
    for (size_t i = 0; i < 3 * CAMERAS * e.n_knots; i++)
        with.value[i] += 0.1f * (float)(i / 3 % e.n_knots);
    ted4_exposure_centre(&e);
    ted4_exposure_centre(&with);
    for (size_t i = 0; i < 3 * CAMERAS * e.n_knots; i++) {
        assert_true(fabsf(e.value[i]) > 0);
        assert_true(fabsf(e.value[i] - with.value[i]) < 1e-6f);
    }
    ted4_exposure_finish(&e);
    ted4_exposure_finish(&with);
    /* Each time has one camera only: the first has the first half, and so on. */
    for (size_t i = 0; i < d.n_pictures; i++)
        d.pictures[i].is_test = d.pictures[i].camera_id != d.pictures[i].frame / 8;
    assert_int_equal(ted4_exposure_init(&e, &d, (const uint8_t[CAMERAS]) { 1, 1 }), 0);
    assert_int_equal(e.n_knots, 3);
    fill(&e);
    ted4_exposure_centre(&e);
    for (size_t c = 0; c < 3; c++) {
        assert_true(e.value[c] == 0);                     /* camera 0, first knot */
        assert_true(e.value[3 * e.n_knots + 6 + c] == 0); /* camera 1, last knot */
    }
    ted4_exposure_finish(&e);
}

/* A step goes against the gradient of this time's knots, and leaves other cameras alone, but for
 * the gauge. */
static void test_update(void **state)
{
    const ted4_dataset d = plan();
    ted4_colour_map gradient = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    ted4_colour c;

    (void)state;
    assert_int_equal(ted4_colour_init(&c, &d), 0);
    assert_int_equal(ted4_exposure_init(&c.exposure, &d, c.corrected), 0);
    ted4_colour_update(&c, 1, 0, gradient, 0.01, 0);
    const float *first = c.exposure.value, *mine = first + 3 * c.exposure.n_knots;

    for (size_t k = 0; k < 3 * c.exposure.n_knots; k++) {
        if (k < 3)
            assert_true(fabsf(mine[k] - first[k] + 0.01f) < 1e-6f);
        else
            assert_true(mine[k] == first[k]);
    }
    assert_int_equal(c.exposure.steps[1], 1);
    assert_int_equal(c.exposure.steps[0], 0);
    assert_int_equal(ted4_colour_finite(&c), 1);
    c.exposure.value[3] = NAN;
    assert_int_equal(ted4_colour_finite(&c), 0);
    ted4_colour_finish(&c);
}

/* Without a gradient of the picture, a step is against that of the penalty: p times the squares,
 * and 10 p times the squared second differences. Adam's first moments are a tenth of the gradient.
 */
static void test_penalty(void **state)
{
    const double penalty = 0.3, h = 1e-5;
    const ted4_dataset d = plan();
    const double map[N] = { 0 };
    const ted4_colour_map nothing = { 0 };
    double value[3 * TED4_EXPOSURE_KNOTS];
    ted4_colour c;

    (void)state;
    assert_int_equal(ted4_colour_init(&c, &d), 0);
    assert_int_equal(ted4_exposure_init(&c.exposure, &d, c.corrected), 0);
    fill(&c.exposure);
    const size_t n = 3 * c.exposure.n_knots, at = 3 * n;

    for (size_t i = 0; i < n; i++)
        value[i] = (double)c.exposure.value[at + i];
    ted4_colour_update(&c, 3, 7, nothing, 0.01, penalty);
    for (size_t i = 0; i < n; i++) {
        const double was = value[i];
        double side[2];

        for (int k = 0; k < 2; k++) {
            value[i] = was + (k ? h : -h);
            side[k] = loss_of(&c.exposure, value, map, 7, 10 * penalty, penalty) -
                      loss_of(&c.exposure, value, map, 7, 0, 0);
        }
        value[i] = was;
        expect_near(10 * (double)c.exposure.m[at + i], (side[1] - side[0]) / (2 * h), "moment", i);
    }
    ted4_colour_finish(&c);
}

/* ---- with pictures ---- */

typedef struct {
    tiny_folder f;
    ted4_dataset d;
    ted4_trainer t;
} training;

/* spoilt: 1: test pictures are those of other times. */
static void load(training *x, const ted4_ray_options *o, int spoilt)
{
    const ted4_dataset_options options = { .downscale = 1, .seed = 3, .cache_bytes = 1 << 20 };
    ted4_ray_message why;
    ted4_message m;

    x->f = tiny_new();
    if (ted4_ray_write(o, x->f.path, NULL, &why) != 0)
        fail_msg("%s", why.text);
    for (int i = 0; i < o->n_train * o->n_frames && spoilt; i++) {
        char from[300], to[300];

        snprintf(from, sizeof from, "%s/train/r_%03d_15.png", x->f.path, i / o->n_frames);
        snprintf(to, sizeof to, "%s/test/r_%03d_%02d.png", x->f.path, i / o->n_frames,
                 i % o->n_frames);
        if (ted4_ray_is_taken(o, o->n_train + i / o->n_frames, i % o->n_frames)) {
            remove(to);
            assert_int_equal(link(from, to), 0);
        }
    }
    if (ted4_dataset_load(&x->d, x->f.path, &options, &m) != 0)
        fail_msg("%s", m.text);
}

static void finish(training *x)
{
    ted4_trainer_finish(&x->t);
    ted4_dataset_free(&x->d);
    tiny_free(&x->f);
}

static ted4_ray_options small(ted4_ray_scene s)
{
    ted4_ray_options o = ted4_ray_defaults(s);

    o.width = 48;
    o.height = 32;
    return o;
}

static void begin_with(training *x, const ted4_ray_options *o, const char *option, int spoilt)
{
    ted4_train_options options = ball_options();

    if (option != NULL)
        ball_set(&options, option);
    load(x, o, spoilt);
    ball_begin(&x->t, &options, &x->d, NULL);
}

static void begin(training *x, const ted4_ray_options *o, const char *option)
{
    begin_with(x, o, option, 0);
}

/* Returns the exposure of a camera at a time in the encoding of pictures, about its mean over the
 * training times, at a middle grey. */
static double truth(const ted4_ray_options *o, int camera, int frame)
{
    const double x = 0.2 * ted4_ray_exposure(o, camera, frame);

    return (1.055 * pow(x, 1 / 2.4) - 0.055) / (1.055 * pow(0.2, 1 / 2.4) - 0.055) - 1;
}

static void test_found(void **state)
{
    const ted4_ray_options o = small(RAY_DUSK);
    training x;
    double worst = 0, most = 0;

    (void)state;
    begin(&x, &o, NULL);
    assert_int_equal(x.t.colour.exposure.n_knots, 4);
    assert_in_range((int)(1e4 * x.t.colour.exposure_change), 400, 800);
    for (size_t i = 0; i < x.d.n_pictures; i++) {
        const ted4_picture *p = &x.d.pictures[i];
        const char *at = strstr(p->path, "/r_");
        float gain[3];

        if (p->is_test)
            continue;
        assert_non_null(at);
        ted4_exposure_at(&x.t.colour.exposure, p->camera_id, p->frame, gain);
        for (int c = 0; c < 3; c++) {
            const double want = truth(&o, atoi(at + 3), (int)p->frame);

            worst = larger(worst, fabs((double)gain[c] - want));
            most = larger(most, fabs(want));
        }
    }
    if (!(worst < 0.25 * most))
        fail_msg("off by %.4f of %.4f", worst, most);
    finish(&x);
}

/* Exposures that are the same at all times, light that flickers, and an option. */
static void test_not_found(void **state)
{
    ted4_ray_options o = small(RAY_DUSK);
    training x;

    (void)state;
    begin(&x, &o, "exposure=0");
    assert_int_equal(x.t.colour.exposure.n_knots, 0);
    assert_true(x.t.colour.exposure_change == 0);
    finish(&x);
    o.drift = 0;
    begin(&x, &o, NULL);
    assert_int_equal(x.t.colour.exposure.n_knots, 0);
    assert_true(x.t.colour.exposure_change < 0.001);
    finish(&x);
    o = small(RAY_FLICKER);
    begin(&x, &o, NULL);
    assert_int_equal(x.t.colour.exposure.n_knots, 0);
    assert_true(x.t.colour.exposure_change < 0.005);
    finish(&x);
    o = small(RAY_TINTS);
    begin(&x, &o, NULL);
    assert_int_equal(x.t.colour.exposure.n_knots, 0);
    finish(&x);
}

/* Other test pictures of the same cameras leave the gains as they are. */
static void test_held_out(void **state)
{
    ted4_ray_options o = small(RAY_TINTS4);
    training x, y;

    (void)state;
    o.drift = 0.5;
    begin(&x, &o, NULL);
    begin_with(&y, &o, NULL, 1);

    const ted4_exposure *const a = &x.t.colour.exposure, *const b = &y.t.colour.exposure;

    assert_int_equal(a->n_knots, 4);
    assert_int_equal(b->n_knots, 4);
    assert_memory_equal(a->value, b->value, 3 * a->n_cameras * a->n_knots * sizeof *a->value);
    finish(&x);
    finish(&y);
}

static int is_at(const ted4_snapshot *a, const ted4_snapshot *b)
{
    return a->size == b->size && memcmp(a->bytes, b->bytes, a->size) == 0;
}

/* A training that goes on from a checkpoint has the same state in the end. */
static void test_resumed(void **state)
{
    const ted4_ray_options o = small(RAY_DUSK);
    ted4_snapshot whole = { 0 }, resumed = { 0 };
    training x;
    char path[300];

    (void)state;
    begin(&x, &o, NULL);
    snprintf(path, sizeof path, "%s/checkpoint", x.f.path);
    ball_train(&x.t, 20);
    assert_int_equal(ted4_checkpoint_save(&x.t, path), 0);
    ball_train(&x.t, 40);
    x.t.seconds = 0;
    assert_int_equal(ted4_state_take(&x.t, &whole), 0);

    const ted4_train_options options = x.t.opt;

    ted4_trainer_finish(&x.t);
    ball_begin(&x.t, &options, &x.d, NULL);
    assert_int_equal(ted4_checkpoint_load(&x.t, path), 0);
    assert_int_equal(x.t.iteration, 20);
    ball_train(&x.t, 40);
    x.t.seconds = 0;
    assert_int_equal(ted4_state_take(&x.t, &resumed), 0);
    assert_true(x.t.colour.exposure.steps[0] > 0);
    assert_true(is_at(&whole, &resumed));
    ted4_snapshot_free(&whole);
    ted4_snapshot_free(&resumed);
    finish(&x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_knots),    cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_none),     cmocka_unit_test(test_gauge),
        cmocka_unit_test(test_update),   cmocka_unit_test(test_penalty),
        cmocka_unit_test(test_found),    cmocka_unit_test(test_not_found),
        cmocka_unit_test(test_held_out), cmocka_unit_test(test_resumed),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
