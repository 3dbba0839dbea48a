/* test_raster_grad.c - every gradient of the rasteriser against central differences of the plain
 * renderer in double precision.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "test.h"
#include "larger.h"
#include "tool/threads.h"
#include "raster_scene.h"
#include "render/raster_plain.h"
#include "train/raster/raster_bwd.h"

enum { GROUPS = 5 };

/* mean, scale, rotation, opacity, colour */
static const int group_first[GROUPS + 1] = { SCENE_MEAN,    SCENE_SCALE,  SCENE_ROT,
                                             SCENE_OPACITY, SCENE_COLOUR, SCENE_PARAMS };

/* The step is so small that few Gaussians reach another pixel, or stop reaching one, within it.
 * Such a jump is detected by a second, smaller step: a jump of height J adds J / step, so the two
 * results differ by far more than this share. */
#define STEP_ULPS      32
#define SMALL_ULPS     8
#define JUMP_TOLERANCE 1e-3
/* Tolerances between float gradients and double differences: relative to the value, plus relative
 * to the largest gradient in its group. */
#define RELATIVE       2e-3
#define ABSOLUTE       2e-5
#define COSINE         0.99999
/* The largest share of parameters that may be at a jump. */
#define MAX_JUMPS      0.02

typedef struct {
    scene s;
    ted4_view v;
    float *d_image; /* dL / d image, random; L = sum d_image image */
    double *image;
    size_t n_image;
} problem;

static void *must(void *p)
{
    assert_non_null(p);
    return p;
}

static problem make_problem(scene s, const ted4_view *v, uint64_t seed)
{
    const size_t n = 3 * (size_t)v->width * (size_t)v->height;
    problem p = { s, *v, must(malloc(n * sizeof(float))), must(malloc(n * sizeof(double))), n };

    for (size_t i = 0; i < n; i++)
        p.d_image[i] = (float)scene_range(&seed, -1, 1);
    return p;
}

static void free_problem(problem *p)
{
    scene_free(&p->s);
    free(p->d_image);
    free(p->image);
}

static double loss(const problem *p)
{
    const ted4_splats g = scene_splats(&p->s);
    double sum = 0;

    assert_int_equal(ted4_raster_plain(&g, &p->v, p->image), 0);
    for (size_t i = 0; i < p->n_image; i++)
        sum += p->image[i] * p->d_image[i];
    return sum;
}

/* Central difference with a step of ulps units in the last place of x: the steps are exact,
 * although x is float. */
static double difference(const problem *p, float *x, int ulps)
{
    const float keep = *x, h = (fabsf(keep) + 0.05f) * 0x1p-23f * (float)ulps;
    const float up = keep + h, down = keep - h;

    *x = up;
    const double above = loss(p);
    *x = down;
    const double below = loss(p);
    *x = keep;
    return (above - below) / ((double)up - (double)down);
}

static ted4_splat_grads grads_of(const scene *d, float *mean2d, uint8_t *visible)
{
    ted4_splat_grads g = { .opacity = scene_param(d, SCENE_OPACITY, 0),
                           .mean2d = mean2d,
                           .visible = visible };

    for (int k = 0; k < 3; k++) {
        g.mean[k] = scene_param(d, SCENE_MEAN + k, 0);
        g.scale[k] = scene_param(d, SCENE_SCALE + k, 0);
        g.colour[k] = scene_param(d, SCENE_COLOUR + k, 0);
    }
    for (int k = 0; k < 4; k++)
        g.rot[k] = scene_param(d, SCENE_ROT + k, 0);
    return g;
}

/* Computes the analytic gradients of p into d, in the layout of the scene. */
static void gradients(const problem *p, const ted4_parallel *threads, scene *d, float *mean2d,
                      uint8_t *visible)
{
    const ted4_splats g = scene_splats(&p->s);
    const ted4_splat_grads grads = grads_of(d, mean2d, visible);
    float *image = must(malloc(p->n_image * sizeof *image));
    ted4_raster *r = must(ted4_raster_new());
    ted4_adjoint *adjoint = must(ted4_adjoint_new());

    memset(d->value, 0xff,
           p->s.n * SCENE_PARAMS * sizeof(float)); /* NaN: each must be overwritten */
    assert_int_equal(ted4_raster_forward(r, &g, &p->v, threads, 1, image), 0);
    assert_int_equal(ted4_raster_backward(adjoint, r, &g, &p->v, threads, p->d_image, &grads), 0);
    ted4_adjoint_free(adjoint);
    ted4_raster_free(r);
    free(image);
}

/* Checks every parameter of every Gaussian. */
static void check(problem *p)
{
    const size_t n = p->s.n;
    scene d = { n, must(malloc(n * SCENE_PARAMS * sizeof(float))) };
    double *want = must(malloc(n * SCENE_PARAMS * sizeof(double)));
    float *mean2d = must(malloc(n * sizeof *mean2d));
    uint8_t *visible = must(malloc(n)), *jump = must(calloc(n * SCENE_PARAMS, 1));
    size_t n_jumps = 0;

    gradients(p, NULL, &d, mean2d, visible);
    for (int group = 0; group < GROUPS; group++) {
        const size_t begin = n * (size_t)group_first[group],
                     end = n * (size_t)group_first[group + 1];
        double top = 0, dot = 0, got2 = 0, want2 = 0;

        for (size_t i = begin; i < end; i++) {
            want[i] = difference(p, &p->s.value[i], STEP_ULPS);
            top = larger(top, fabs((double)d.value[i]));
        }
        for (size_t i = begin; i < end; i++) {
            const double got = d.value[i], allowed = ABSOLUTE * top + RELATIVE * fabs(want[i]);

            assert_true(isfinite(got));
            if (!(fabs(got - want[i]) <= allowed)) {
                const double small = difference(p, &p->s.value[i], SMALL_ULPS);

                jump[i] = fabs(small - want[i]) >
                          JUMP_TOLERANCE * (fabs(small) + fabs(want[i])) + ABSOLUTE * top;
                if (!jump[i])
                    print_error("group %d, Gaussian %zu: %g, should be %g (largest %g)\n", group,
                                i % n, got, want[i], top);
                assert_true(jump[i]);
                n_jumps++;
                continue;
            }
            dot += got * want[i];
            got2 += got * got;
            want2 += want[i] * want[i];
        }
        assert_true(dot >= COSINE * sqrt(got2 * want2));
    }
    assert_true((double)n_jumps <= MAX_JUMPS * (double)(n * SCENE_PARAMS));
    scene_free(&d);
    free(want);
    free(mean2d);
    free(visible);
    free(jump);
}

static void test_random(void **state)
{
    static const struct {
        int width, height;
        double sigma;
    } c[] = { { 24, 20, 2 }, { 17, 33, 4 }, { 33, 18, 1 }, { 1, 1, 3 } };

    (void)state;
    for (size_t i = 0; i < sizeof c / sizeof c[0]; i++) {
        const ted4_view v = scene_view(c[i].width, c[i].height);
        problem p = make_problem(scene_random(37, &v, c[i].sigma, i + 10), &v, i);

        check(&p);
        free_problem(&p);
    }
}

/* The opacity exceeds the cap at and around the centre: there only colour has a gradient. */
static void test_cap(void **state)
{
    const ted4_view v = scene_view(20, 20);
    problem p = make_problem(scene_random(20, &v, 4, 3), &v, 3);

    (void)state;
    for (size_t i = 0; i < p.s.n; i += 2)
        *scene_param(&p.s, SCENE_OPACITY, i) = 0.995f + 0.01f * (float)(i % 3);
    check(&p);
    free_problem(&p);
}

/* So many opaque Gaussians that every pixel stops early. */
static void test_early_stop(void **state)
{
    const ted4_view v = scene_view(16, 12);
    problem p = make_problem(scene_random(60, &v, 12, 4), &v, 4);

    (void)state;
    for (size_t i = 0; i < p.s.n; i++)
        *scene_param(&p.s, SCENE_OPACITY, i) = 0.7f;
    check(&p);
    free_problem(&p);
}

/* Centres outside the guard band, on all four sides, but large enough to be visible: the Jacobian's
 * slope is clamped. */
static void test_clamped_jacobian(void **state)
{
    static const double place[][2] = { { -12, 10 },  { 32, 10 }, { 10, -12 }, { 10, 32 },
                                       { -12, -12 }, { 35, 33 }, { 10, 10 } };
    enum { N = sizeof place / sizeof place[0] };
    const ted4_view v = scene_view(20, 20);
    problem p = make_problem(scene_random(N, &v, 6, 5), &v, 5);

    (void)state;
    for (size_t i = 0; i < N; i++) {
        scene_place(&p.s, &v, i, place[i][0], place[i][1], 2 + 0.1 * (double)i);
        *scene_param(&p.s, SCENE_OPACITY, i) = 0.8f;
    }
    check(&p);
    free_problem(&p);
}

/* Behind the camera, too faint, off the image; near the camera; needles; and one rotation that is
 * not quite normalised, since the gradient is that of the polynomial R(q). */
static void test_awkward(void **state)
{
    const ted4_view v = scene_view(24, 24);
    problem p = make_problem(scene_random(24, &v, 3, 6), &v, 6);

    (void)state;
    scene_place(&p.s, &v, 0, 12, 12, -3);
    scene_place(&p.s, &v, 1, 12, 12, 0.25);
    *scene_param(&p.s, SCENE_OPACITY, 2) = 0.003f;
    *scene_param(&p.s, SCENE_OPACITY, 3) = -0.5f;
    scene_place(&p.s, &v, 4, 300, 12, 2);
    *scene_param(&p.s, SCENE_SCALE, 5) = 2;
    *scene_param(&p.s, SCENE_SCALE + 1, 5) = 1e-3f;
    *scene_param(&p.s, SCENE_SCALE, 6) = 5;
    *scene_param(&p.s, SCENE_SCALE + 1, 7) = 1e-4f;
    for (int k = 0; k < 4; k++)
        *scene_param(&p.s, SCENE_ROT + k, 8) *= 1.05f;
    check(&p);
    free_problem(&p);
}

/* Runs of Gaussians that are too faint, longer than a register, which projection skips, between
 * others. */
static void test_faint_runs(void **state)
{
    const ted4_view v = scene_view(24, 20);
    problem p = make_problem(scene_random(72, &v, 3, 9), &v, 9);

    (void)state;
    for (size_t i = 0; i < p.s.n; i++)
        if (i % 40 >= 8)
            *scene_param(&p.s, SCENE_OPACITY, i) = i % 3 == 0 ? 0 : 0.99f * TED4_RASTER_ALPHA_MIN;
    check(&p);
    free_problem(&p);
}

/* mean2d is the image-plane gradient in units of half the image size. For a Gaussian on the optical
 * axis, moving the mean by z / fx along the camera's x axis moves the centre by one pixel and, to
 * first order, changes nothing else except the Jacobian, whose effect on a tiny Gaussian is
 * negligible. visible says which Gaussians had a tile. */
static void test_mean2d(void **state)
{
    ted4_view v = scene_view(32, 16);
    problem p;

    (void)state;
    memcpy(v.R, (const float[9]) { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, sizeof v.R);
    p = make_problem(scene_random(3, &v, 3, 7), &v, 7);
    scene_place(&p.s, &v, 0, v.cx, v.cy, 2);
    scene_place(&p.s, &v, 1, v.cx, v.cy, -2);
    scene_place(&p.s, &v, 2, 99, v.cy, 2);
    for (size_t i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            *scene_param(&p.s, SCENE_SCALE + k, i) = 1e-4f;

    scene d = { 3, must(malloc(3 * SCENE_PARAMS * sizeof(float))) };
    float mean2d[3];
    uint8_t visible[3];
    gradients(&p, NULL, &d, mean2d, visible);
    const double gx = *scene_param(&d, SCENE_MEAN, 0) * 2 / v.fx * 16,
                 gy = *scene_param(&d, SCENE_MEAN + 1, 0) * 2 / v.fy * 8;
    assert_true(gx != 0);
    assert_true(fabs(hypot(gx, gy) - mean2d[0]) < 1e-3 * mean2d[0]);
    assert_true(mean2d[1] == 0);
    assert_true(mean2d[2] == 0);
    assert_memory_equal(visible, ((const uint8_t[]) { 1, 0, 0 }), 3);
    scene_free(&d);
    free_problem(&p);
}

static void test_threads(void **state)
{
    enum { N = 4000 };
    static float one2d[N], many2d[N];
    static uint8_t one_visible[N], many_visible[N];
    const ted4_view v = scene_view(90, 61);
    problem p = make_problem(scene_random(N, &v, 2, 8), &v, 8);
    scene one = { N, must(malloc(N * SCENE_PARAMS * sizeof(float))) },
          many = { N, must(malloc(N * SCENE_PARAMS * sizeof(float))) };

    (void)state;
    gradients(&p, NULL, &one, one2d, one_visible);
    for (int threads = 2; threads <= 5; threads += 3) {
        ted4_parallel par;

        ted4_threads_init(&par, threads);
        gradients(&p, &par, &many, many2d, many_visible);
        ted4_threads_finish(&par);
        assert_memory_equal(one.value, many.value, N * SCENE_PARAMS * sizeof(float));
        assert_memory_equal(one2d, many2d, sizeof one2d);
        assert_memory_equal(one_visible, many_visible, sizeof one_visible);
    }
    scene_free(&one);
    scene_free(&many);
    free_problem(&p);
}

static void test_nothing(void **state)
{
    const ted4_view v = scene_view(20, 10);
    problem p = make_problem(scene_random(0, &v, 2, 8), &v, 8);
    scene d = { 0, must(malloc(4)) };
    float mean2d = 0;
    uint8_t visible = 0;

    (void)state;
    gradients(&p, NULL, &d, &mean2d, &visible);
    scene_free(&d);
    free_problem(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),     cmocka_unit_test(test_cap),
        cmocka_unit_test(test_early_stop), cmocka_unit_test(test_clamped_jacobian),
        cmocka_unit_test(test_awkward),    cmocka_unit_test(test_mean2d),
        cmocka_unit_test(test_threads),    cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_faint_runs),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
