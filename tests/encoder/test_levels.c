/* test_levels.c - the kernels of rendering and training at every level that the machine supports
 * (render/leveled.h): v3 and v4 give identical bytes, and the base level, which has no fused
 * multiply-add, the same up to rounding.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "generate_case.h"
#include "larger.h"
#include "raster_scene.h"
#include "rate_ref.h"
#include "train/raster/raster_bwd.h"
#include "train/math/adam.h"
#include "train/loss/camera_colour_job.h"
#include "train/loss/loss.h"
#include "train/rate/rate_parts.h"

/* The results of a case at one level: arrays, one after the other. */
enum { MAX_ARRAYS = 4096 };

typedef struct {
    float *value;
    size_t n, room, n_arrays, end[MAX_ARRAYS];
} results;

static void keep(results *r, const float *x, size_t n)
{
    if (r->n + n > r->room) {
        r->room = 2 * (r->n + n);
        r->value = realloc(r->value, r->room * sizeof *r->value);
        assert_non_null(r->value);
    }
    memcpy(r->value + r->n, x, n * sizeof *x);
    r->n += n;
    assert_true(r->n_arrays < MAX_ARRAYS);
    r->end[r->n_arrays++] = r->n;
}

static void keep_double(results *r, double x)
{
    const float part[2] = { (float)x, (float)(x - (double)(float)x) };

    keep(r, part, 2);
}

static uint64_t seed;

static float *fill(size_t n, double lo, double hi)
{
    float *x = aligned_alloc(64, (n * sizeof *x + 64) / 64 * 64);

    assert_non_null(x);
    for (size_t i = 0; i < n; i++)
        x[i] = (float)scene_range(&seed, lo, hi);
    return x;
}

/* ---- cases ---- */

static void dense_case(results *r, int in, int out)
{
    enum { BLOCKS = 3 };
    const size_t n_in = (size_t)in, n_out = (size_t)out;
    const size_t x_stride = (n_in + 1) * TED4_LANES, y_stride = (n_out + 2) * TED4_LANES;
    float *w = fill(n_in * n_out, -1, 1), *b = fill(n_out, -1, 1);
    float *x = fill(BLOCKS * x_stride, -1, 1), *dx = fill(x_stride, -1, 1);
    float *y = fill(BLOCKS * y_stride, -1, 1);
    float *dw = fill(n_in * n_out, -1, 1), *db = fill(n_out, -1, 1);
    ted4_dense d;

    assert_int_equal(ted4_dense_init(&d, in, out), 0);
    ted4_dense_pack(&d, w, b);
    ted4_dense_backward_x(&d, y, dx, 1);
    ted4_dense_backward_w(in, out, x, x_stride, y, y_stride, BLOCKS, dw, db);
    ted4_dense_forward(&d, x, y, 1);
    ted4_dense_forward(&d, x, y + y_stride, 0);
    keep(r, dx, x_stride);
    keep(r, dw, n_in * n_out);
    keep(r, db, n_out);
    keep(r, y, 2 * y_stride);
    ted4_dense_finish(&d);
    float *const all[] = { w, b, x, y, dx, dw, db };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        free(all[i]);
}

static void dense(results *r)
{
    static const int shape[][2] = { { 1, 1 },   { 5, 7 },   { 13, 6 },
                                    { 24, 48 }, { 63, 31 }, { 33, 13 } };

    for (size_t i = 0; i < sizeof shape / sizeof shape[0]; i++)
        dense_case(r, shape[i][0], shape[i][1]);
}

static void raster(results *r)
{
    const ted4_view v = scene_view(101, 67);
    scene s = scene_random(400, &v, 5, 7);
    const size_t pixels = 3 * 101 * 67;
    float *image = fill(pixels, 0, 1), *d_image = fill(pixels, -1, 1);
    float *g = fill(15 * s.n, 0, 1);
    uint8_t *visible = calloc(s.n, 1);
    ted4_splat_grads grads = { .opacity = g, .mean2d = g + s.n, .visible = visible };
    ted4_raster *raster = ted4_raster_new();
    ted4_adjoint *adjoint = ted4_adjoint_new();

    assert_non_null(s.value);
    assert_non_null(visible);
    assert_non_null(raster);
    for (size_t k = 0; k < 3; k++) {
        grads.mean[k] = g + (2 + k) * s.n;
        grads.scale[k] = g + (5 + k) * s.n;
        grads.colour[k] = g + (8 + k) * s.n;
    }
    for (size_t k = 0; k < 4; k++)
        grads.rot[k] = g + (11 + k) * s.n;
    const ted4_splats splats = scene_splats(&s);

    assert_int_equal(ted4_raster_forward(raster, &splats, &v, NULL, 1, image), 0);
    assert_int_equal(ted4_raster_backward(adjoint, raster, &splats, &v, NULL, d_image, &grads), 0);
    keep(r, image, pixels);
    for (size_t k = 0; k < 15; k++)
        keep(r, g + k * s.n, s.n);
    ted4_adjoint_free(adjoint);
    ted4_raster_free(raster);
    scene_free(&s);
    free(visible);
    free(image);
    free(d_image);
    free(g);
}

static void generate_case(results *r, const ted4_header *h)
{
    test_case *t = malloc(sizeof *t);
    float *gradient = fill(SCENE_PARAMS * CASE_SPLATS, -1, 1);
    float *d_net = fill(CASE_NET, 0, 0);
    float *d = fill(CASE_BLOCKS * CASE_CHANNELS * TED4_LANES, 0, 1), *d_attr[CASE_BLOCKS];
    ted4_splat_grads grads = { .opacity = gradient + SCENE_OPACITY * CASE_SPLATS };
    ted4_splats s;

    assert_non_null(t);
    case_make(t, h, 2, 7, 5);
    for (size_t i = 0; i < CASE_BLOCKS; i++)
        d_attr[i] = d + i * CASE_CHANNELS * TED4_LANES;
    for (size_t k = 0; k < 4; k++)
        grads.rot[k] = gradient + (SCENE_ROT + k) * CASE_SPLATS;
    for (size_t k = 0; k < 3; k++) {
        grads.mean[k] = gradient + (SCENE_MEAN + k) * CASE_SPLATS;
        grads.scale[k] = gradient + (SCENE_SCALE + k) * CASE_SPLATS;
        grads.colour[k] = gradient + (SCENE_COLOUR + k) * CASE_SPLATS;
    }
    ted4_generator *g = ted4_generator_new(&t->layout);

    assert_non_null(g);
    ted4_generator_pack(g, t->net);
    assert_int_equal(ted4_generate(g, &t->in, NULL, &s), 0);
    for (int c = 0; c < SCENE_PARAMS; c++)
        keep(r, case_member(&s, c), s.n);
    assert_int_equal(ted4_generate_backward(g, &t->in, &grads, NULL, d_attr, d_net), 0);
    for (size_t i = 0; i < CASE_BLOCKS; i++)
        keep(r, d_attr[i], (size_t)t->layout.n_channels * TED4_LANES);
    keep(r, d_net, t->layout.n_net);
    ted4_generator_free(g);
    free(gradient);
    free(d_net);
    free(d);
    free(t);
}

static void generate(results *r)
{
    for (int motion = TED4_MOTION_NONE; motion <= TED4_MOTION_INR; motion++)
        for (int linear = 0; linear < 2; linear++) {
            ted4_header h = case_header(motion, linear ? TED4_VIEW_NONE : TED4_VIEW_FULL);

            h.scale_domain = linear ? TED4_SCALE_LINEAR : TED4_SCALE_LOG2;
            generate_case(r, &h);
        }
}

static void rate(results *r)
{
    static const ted4_quant quant[] = { TED4_QUANT_NOISE, TED4_QUANT_ROUND, TED4_QUANT_INTEGER };
    const ted4_header h = ref_header();
    ref_world *w = malloc(sizeof *w);

    assert_non_null(w);
    for (size_t q = 0; q < sizeof quant / sizeof quant[0]; q++) {
        double bits[TED4_TYPES];

        ref_source = random_seed(3);
        ref_world_make(w, &h);
        uint8_t *shift = malloc(w->layout.shape.n_units);

        assert_non_null(shift);
        memset(shift, 11, w->layout.shape.n_units);
        w->in.shift = shift;
        w->in.quant = quant[q];
        assert_int_equal(ref_run(w, NULL, bits), 0);
        for (int t = 0; t < TED4_TYPES; t++)
            keep_double(r, bits[t]);
        for (int i = 0; i < REF_BLOCKS; i++) {
            keep(r, w->steps[i], (size_t)TED4_TYPES * TED4_LANES);
            keep(r, w->d_attr[i], (size_t)w->layout.n_channels * TED4_LANES);
        }
        keep(r, w->d_net, w->layout.n_net);
        ref_world_finish(w);
        free(shift);
    }
    free(w);
}

static void loss_case(results *r, int width, int height)
{
    const size_t n = 3 * (size_t)width * (size_t)height;
    float *image = fill(n, -0.1, 1.1), *d_image = fill(n, 0, 1);
    uint8_t *truth = malloc(n);
    double l1, ssim;
    ted4_loss_workspace *w = ted4_loss_workspace_new();

    assert_non_null(truth);
    assert_non_null(w);
    for (size_t i = 0; i < n; i++)
        truth[i] = (uint8_t)scene_range(&seed, 0, 256);
    keep_double(r, ted4_loss(w, image, truth, width, height, 0.2f, NULL, d_image, &l1, &ssim));
    keep_double(r, l1);
    keep_double(r, ssim);
    keep(r, d_image, n);
    ted4_loss_workspace_free(w);
    free(image);
    free(d_image);
    free(truth);
}

static void loss(results *r)
{
    loss_case(r, 1, 1);
    loss_case(r, 37, 23);
    loss_case(r, 150, 40);
    loss_case(r, 128, 33);
}

static void colour(results *r)
{
    enum { PIXELS = TED4_COLOUR_BAND + 2 * TED4_COLOUR_RUN + 21 };
    float *image = fill((size_t)3 * PIXELS, 0, 1), *to = fill((size_t)3 * PIXELS, -1, 1);
    float *map = fill(TED4_COLOUR_VALUES, -0.2, 0.2);
    double sums[2 * TED4_COLOUR_VALUES];
    ted4_colour_job j = { image, map, to, sums, PIXELS };

    for (size_t band = 0; band < 2; band++)
        TED4_IN_USE(ted4_colour_backward_band)(&j, band);
    keep(r, to, (size_t)3 * PIXELS);
    for (size_t k = 0; k < sizeof sums / sizeof sums[0]; k++)
        keep_double(r, sums[k]);
    for (size_t band = 0; band < 2; band++)
        TED4_IN_USE(ted4_colour_apply_band)(&j, band);
    keep(r, to, (size_t)3 * PIXELS);
    free(image);
    free(to);
    free(map);
}

static void adam(results *r)
{
    enum { N = 77 };
    float *x = fill(N, -1, 1), *m = fill(N, -1, 1), *v = fill(N, 0, 1), *g = fill(N, -1, 1);

    g[3] = 3e38f;
    ted4_adam(x, m, v, g, N, 0.01f, ted4_adam_bias_make(7));
    keep(r, x, N);
    keep(r, m, N);
    keep(r, v, N);
    free(x);
    free(m);
    free(v);
    free(g);
}

/* ---- comparison ---- */

/* base: largest difference at the base level, relative to the largest value of an array. Where an
 * opacity or a bound is on different sides of a threshold, the base may differ by more. */
static const struct {
    const char *name;
    void (*run)(results *r);
    double base;
} kinds[] = {
    { "dense", dense, 1e-6 }, { "raster", raster, 1e-4 }, { "generate", generate, 1e-5 },
    { "rate", rate, 1e-5 },   { "loss", loss, 1e-5 },     { "colour", colour, 3e-5 },
    { "adam", adam, 0 },
};

static results at_level(size_t kind, ted4_level level)
{
    results r = { 0 };

    seed = 11;
    assert_int_equal(ted4_level_use(level), level);
    kinds[kind].run(&r);
    assert_true(r.n > 0);
    return r;
}

static void same_bytes(const results *a, const results *b, const char *name)
{
    assert_int_equal(a->n, b->n);
    for (size_t i = 0, k = 0; i < a->n; i++) {
        k += i >= a->end[k];
        if (memcmp(a->value + i, b->value + i, sizeof(float)) != 0)
            fail_msg("%s: value %zu of array %zu is %.9g and %.9g", name,
                     i - (k > 0 ? a->end[k - 1] : 0), k, (double)a->value[i], (double)b->value[i]);
    }
}

/* Returns the largest difference. */
static double about_same(const results *a, const results *b, double tolerance, const char *name)
{
    double worst = 0;

    assert_int_equal(a->n, b->n);
    for (size_t k = 0; k < a->n_arrays; k++) {
        double largest = 0, off = 0;

        for (size_t i = k > 0 ? a->end[k - 1] : 0; i < a->end[k]; i++) {
            largest = larger(largest, fabs((double)a->value[i]));
            largest = larger(largest, fabs((double)b->value[i]));
            off = larger(off, fabs((double)a->value[i] - (double)b->value[i]));
        }
        worst = larger(worst, largest <= 1e-6 ? 0 : off / largest);
    }
    if (!(worst <= tolerance))
        fail_msg("%s: the base is off by %g of the largest value, of %g", name, worst, tolerance);
    return worst;
}

static void levels_agree(void **state)
{
    const ted4_level most = ted4_level_of_machine();

    (void)state;
    if (most < TED4_LEVEL_V3) {
        print_message("skipped: this machine has only one level\n");
        skip();
    }
    for (size_t kind = 0; kind < sizeof kinds / sizeof kinds[0]; kind++) {
        results base = at_level(kind, TED4_LEVEL_BASE), v3 = at_level(kind, TED4_LEVEL_V3);

        printf("    %-8s %7zu values; the base is off by %g of the largest\n", kinds[kind].name,
               v3.n, about_same(&v3, &base, kinds[kind].base, kinds[kind].name));
        if (most >= TED4_LEVEL_V4) {
            results v4 = at_level(kind, TED4_LEVEL_V4);

            same_bytes(&v3, &v4, kinds[kind].name);
            free(v4.value);
        }
        free(base.value);
        free(v3.value);
    }
    if (most < TED4_LEVEL_V4)
        printf("    no v4 on this machine: v3 is compared with the base alone\n");
    ted4_level_use(most);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(levels_agree) };

    return cmocka_run_group_tests_name("levels", tests, NULL, NULL);
}
