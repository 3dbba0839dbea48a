/* test_extremes_raster_grad.c - the rasteriser's adjoint near the limits of binary32: every
 * gradient is finite, and equals the central difference of the image model in double precision
 * (raster_ref.h), whose parameters are double too.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>
#include <string.h>

#include "test.h"
#include "larger.h"
#include "raster_ref.h"
#include "raster_scene.h"
#include "train/raster/raster_bwd.h"

enum { SIDE = 20, PIXELS = SIDE * SIDE, MOST = 8, GROUPS = 5 };

/* mean, scale, rotation, opacity, colour */
static const int group_first[GROUPS + 1] = { SCENE_MEAN,    SCENE_SCALE,  SCENE_ROT,
                                             SCENE_OPACITY, SCENE_COLOUR, SCENE_PARAMS };

/* Steps relative to the parameter plus 1 / SIDE of a unit. The smaller step distinguishes a pixel
 * that crosses a threshold from a wrong gradient. */
#define STEP       1e-6
#define SMALL_STEP 2e-7
/* Tolerances between float gradients and double differences: relative to the value, relative to the
 * largest gradient in its group, and for the rounding of the loss in the difference. */
#define RELATIVE   2e-3
#define ABSOLUTE   2e-5
#define ROUNDING   1e-14

typedef struct {
    ted4_view v;
    scene s; /* at most MOST Gaussians */
    float d_image[3 * PIXELS];
    double exact[MOST][REF_SPLAT];
    double size; /* sum of |d_image| */
    float d[SCENE_PARAMS * MOST], mean2d[MOST];
    uint8_t visible[MOST];
} problem;

static problem p;

static double loss(void)
{
    static double image[3 * PIXELS];
    double sum = 0;

    (void)ref_render(&p.v, (const double(*)[REF_SPLAT])p.exact, p.s.n, image);
    for (int i = 0; i < 3 * PIXELS; i++)
        sum += image[i] * (double)p.d_image[i];
    return sum;
}

static double difference(double *x, double h)
{
    const double keep = *x;

    *x = keep + h;
    const double up = loss();

    *x = keep - h;
    const double down = loss();

    *x = keep;
    return (up - down) / (2 * h);
}

/* Makes n ordinary Gaussians in view, and a loss. */
static void begin(size_t n, uint64_t seed)
{
    memset(&p, 0, sizeof p);
    p.v = scene_view(SIDE, SIDE);
    p.s = scene_random(n, &p.v, 3, seed);
    for (size_t i = 0; i < n; i++) {
        scene_place(&p.s, &p.v, i, scene_range(&seed, 6, 14), scene_range(&seed, 6, 14),
                    2 + (double)i);
        *scene_param(&p.s, SCENE_OPACITY, i) = 0.6f;
    }
    for (int i = 0; i < 3 * PIXELS; i++) {
        p.d_image[i] = (float)scene_range(&seed, -1, 1);
        p.size += fabs((double)p.d_image[i]);
    }
}

/* Runs the kernels. Returns the number of Gaussians that were skipped. */
static uint64_t run(void)
{
    static float image[3 * PIXELS];
    const ted4_splats g = scene_splats(&p.s);
    const scene d = { p.s.n, p.d };
    ted4_splat_grads grads = { .opacity = scene_param(&d, SCENE_OPACITY, 0),
                               .mean2d = p.mean2d,
                               .visible = p.visible };
    ted4_raster *r = ted4_raster_new();
    ted4_adjoint *adjoint = ted4_adjoint_new();

    assert_non_null(r);
    for (int k = 0; k < 4; k++)
        grads.rot[k] = scene_param(&d, SCENE_ROT + k, 0);
    for (int k = 0; k < 3; k++) {
        grads.mean[k] = scene_param(&d, SCENE_MEAN + k, 0);
        grads.scale[k] = scene_param(&d, SCENE_SCALE + k, 0);
        grads.colour[k] = scene_param(&d, SCENE_COLOUR + k, 0);
    }
    memset(p.d, 0xff, sizeof p.d);
    assert_int_equal(ted4_raster_forward(r, &g, &p.v, NULL, 1, image), 0);
    assert_int_equal(ted4_raster_backward(adjoint, r, &g, &p.v, NULL, p.d_image, &grads), 0);
    for (size_t i = 0; i < p.s.n * SCENE_PARAMS; i++)
        if (!isfinite(p.d[i]))
            fail_msg("parameter %zu of Gaussian %zu: gradient %g", i / p.s.n, i % p.s.n,
                     (double)p.d[i]);
    for (size_t i = 0; i < p.s.n; i++) {
        assert_true(isfinite(p.mean2d[i]));
        assert_true(p.mean2d[i] >= 0);
    }
    const uint64_t skipped = ted4_raster_skipped(r);

    ted4_adjoint_free(adjoint);
    ted4_raster_free(r);
    return skipped;
}

static void compare(size_t i, int param, double top)
{
    const double got = (double)*scene_param(&(scene) { p.s.n, p.d }, param, i);
    double *x = &p.exact[i][param];
    const double h = STEP * (fabs(*x) + 1.0 / SIDE), want = difference(x, h);
    const double allowed = ABSOLUTE * top + RELATIVE * fabs(want) + ROUNDING * p.size / h;

    if (fabs(got - want) <= allowed)
        return;
    const double small = difference(x, SMALL_STEP / STEP * h);

    if (fabs(small - want) <= 1e-3 * (fabs(small) + fabs(want)) + 5 * ROUNDING * p.size / h)
        fail_msg("parameter %d of Gaussian %zu: %g, should be %g (largest %g)", param, i, got, want,
                 top);
}

/* Checks every parameter of every Gaussian except those of group not (-1: none). */
static void check(int not )
{
    for (size_t i = 0; i < p.s.n; i++)
        for (int k = 0; k < SCENE_PARAMS; k++)
            p.exact[i][k] = (double)*scene_param(&p.s, k, i);
    assert_int_equal(run(), 0);
    for (int group = 0; group < GROUPS; group++) {
        double top = 0;

        if (group == not )
            continue;
        for (size_t k = p.s.n * (size_t)group_first[group];
             k < p.s.n * (size_t)group_first[group + 1]; k++)
            top = larger(top, fabs((double)p.d[k]));
        for (size_t i = 0; i < p.s.n; i++)
            for (int k = group_first[group]; k < group_first[group + 1]; k++)
                compare(i, k, top);
    }
    scene_free(&p.s);
}

static void set_size(size_t i, float a, float b, float c)
{
    *scene_param(&p.s, SCENE_SCALE, i) = a;
    *scene_param(&p.s, SCENE_SCALE + 1, i) = b;
    *scene_param(&p.s, SCENE_SCALE + 2, i) = c;
}

/* Makes Gaussian i a ball, a plate or a needle. */
static void set_kind(size_t i, float size, int kind)
{
    set_size(i, size, kind > 0 ? 0.2f : size, kind < 2 ? size : kind == 2 ? 0.3f : 0);
}

/* The covariance is quadratic in a size, so at size 0 its gradient is 0. A huge Gaussian is flat
 * over the picture, so that only opacity and colour matter. */
static void test_sizes(void **state)
{
    static const float size[] = {
        0, 1e-45f, FLT_MIN, 0x1p-24f, 1e-4f, 10, 1e3f, 65504, 1e6f, 1e8f
    };

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++)
        for (int kind = 0; kind < 4; kind++) {
            begin(3, 7 + i);
            set_kind(1, size[i], kind);
            check(-1);
            begin(1, 70 + i);
            set_kind(0, size[i], kind);
            check(-1);
        }
    begin(2, 3);
    set_size(0, 0, 0, 0);
    (void)run();
    for (int k = 0; k < 3; k++)
        assert_true(p.d[(SCENE_SCALE + k) * 2] == 0);
    scene_free(&p.s);
}

/* Just in front of the near plane, and far away: near the camera the Jacobian grows like 1 / z. */
static void test_depths(void **state)
{
    static const double depth[] = { 0.2000001, 0.201, 0.25, 1e3, 65504, 1e6 };

    (void)state;
    for (size_t i = 0; i < sizeof depth / sizeof *depth; i++)
        for (int off = 0; off < 3; off++) {
            const float size = (float)(depth[i] * 0.1);

            begin(2, 20 + i);
            scene_place(&p.s, &p.v, 0, off == 0 ? 10 : off == 1 ? -2 : 24, 10.3, depth[i]);
            set_size(0, size, 0.5f * size, 2 * size);
            check(depth[i] < 0.2001 ? 0 : -1); /* a step of the mean may cross the near plane */
        }
}

/* Behind the camera, at the near plane and outside the picture: no gradient at all. */
static void test_unseen(void **state)
{
    static const float depth[] = { 0.2f, 0, -0.0f, 1e-45f, -1, -65504, -FLT_MAX };

    (void)state;
    for (size_t i = 0; i < sizeof depth / sizeof *depth; i++) {
        begin(3, 30 + i);
        memcpy(p.v.R, (const float[9]) { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, sizeof p.v.R);
        memset(p.v.t, 0, sizeof p.v.t);
        *scene_param(&p.s, SCENE_MEAN + 2, 1) = depth[i];
        *scene_param(&p.s, SCENE_MEAN, 2) = 65504;
        assert_int_equal(run(), 0);
        for (int k = 0; k < SCENE_PARAMS; k++)
            for (int g = 1; g < 3; g++)
                assert_true(p.d[k * 3 + g] == 0);
        assert_true(!p.visible[1]);
        assert_true(!p.visible[2]);
        assert_true(p.mean2d[1] == 0);
        scene_free(&p.s);
    }
}

/* Gaussians that the forward pass skipped get no gradient, and do not change a bit of the gradients
 * of the others. */
static void test_skipped(void **state)
{
    static const float bad[] = { NAN, INFINITY, FLT_MAX, 1e12f };
    float before[SCENE_PARAMS * 3];

    (void)state;
    begin(3, 40);
    *scene_param(&p.s, SCENE_OPACITY, 1) = 0;
    assert_int_equal(run(), 0);
    memcpy(before, p.d, sizeof before);
    for (int param = SCENE_SCALE; param < SCENE_OPACITY; param++)
        for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
            scene_free(&p.s);
            begin(3, 40);
            *scene_param(&p.s, param, 1) = bad[i];
            if (param < SCENE_ROT)
                set_size(1, bad[i], bad[i], bad[i]);
            assert_int_equal(run(), 1);
            assert_memory_equal(before, p.d, sizeof before);
        }
    scene_free(&p.s);
}

/* Centres on edges and corners of tiles and of the picture. */
static void test_edges(void **state)
{
    static const double at[][2] = { { 16, 16 },   { 15.5, 16.5 }, { 16.5, 15.5 }, { 0, 0 },
                                    { -0.5, 16 }, { 20, 20 },     { 4, 4 },       { 20.4, 0.5 } };

    (void)state;
    for (size_t i = 0; i < sizeof at / sizeof *at; i++)
        for (int small = 0; small < 2; small++) {
            begin(2, 50 + i);
            scene_place(&p.s, &p.v, 0, at[i][0], at[i][1], 1.5);
            if (small)
                set_size(0, 0, 0, 0);
            check(-1);
        }
}

/* Opacity 0, or too little to be drawn, has no gradient; at the cap only colour has one. */
static void test_opacities(void **state)
{
    static const float faint[] = { 0, -0.0f, 1e-45f, FLT_MIN, -1, -FLT_MAX, 0.0039f };
    static const float opaque[] = { 0.00393f, 0.004f, 0.98f, 1 };

    (void)state;
    for (size_t i = 0; i < sizeof faint / sizeof *faint; i++) {
        begin(2, 60 + i);
        *scene_param(&p.s, SCENE_OPACITY, 0) = faint[i];
        assert_int_equal(run(), 0);
        for (int k = 0; k < SCENE_PARAMS; k++)
            assert_true(p.d[k * 2] == 0);
        scene_free(&p.s);
    }
    for (size_t i = 0; i < sizeof opaque / sizeof *opaque; i++) {
        begin(4, 65 + i);
        for (size_t k = 0; k < 4; k++)
            *scene_param(&p.s, SCENE_OPACITY, k) = opaque[i];
        check(-1);
    }
}

/* Quaternions of any length: the gradient is that of the polynomial R(q), which is 0 at q = 0. */
static void test_rotations(void **state)
{
    static const float length[] = { 0, 1e-45f, 1e-20f, 0x1p-20f, 1e-3f, 30, 1e3f };

    (void)state;
    for (size_t i = 0; i < sizeof length / sizeof *length; i++) {
        begin(2, 80 + i);
        for (int k = 0; k < 4; k++)
            *scene_param(&p.s, SCENE_ROT + k, 0) *= length[i];
        set_size(0, 0.4f, 0.05f, 0.2f);
        check(-1);
    }
}

/* All at the same depth: the Gaussian with the lower index is in front, for gradients too. A step
 * of a mean changes the order, so means are not varied. */
static void test_ties(void **state)
{
    (void)state;
    for (uint64_t seed = 90; seed < 93; seed++) {
        begin(MOST, seed);
        memcpy(p.v.R, (const float[9]) { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, sizeof p.v.R);
        for (size_t i = 0; i < MOST; i++)
            *scene_param(&p.s, SCENE_MEAN + 2, i) = 1.75f;
        check(0);
    }
}

/* Gradients of the picture from zero to huge: the adjoint is linear in them. */
static void test_picture_gradients(void **state)
{
    static const float factor[] = { 0, 0x1p-126f, 0x1p-60f, 0x1p60f, 0x1p90f };
    float one[SCENE_PARAMS * 3];

    (void)state;
    begin(3, 100);
    (void)run();
    memcpy(one, p.d, sizeof one);
    for (size_t i = 0; i < sizeof factor / sizeof *factor; i++) {
        scene_free(&p.s);
        begin(3, 100);
        for (int k = 0; k < 3 * PIXELS; k++)
            p.d_image[k] *= factor[i];
        (void)run();
        for (int k = 0; k < SCENE_PARAMS * 3; k++)
            assert_true(fabs((double)p.d[k] - (double)one[k] * (double)factor[i]) <=
                        1e-5 * fabs((double)one[k] * (double)factor[i]) + 1e-38);
    }
    scene_free(&p.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_depths),
        cmocka_unit_test(test_unseen),
        cmocka_unit_test(test_skipped),
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_opacities),
        cmocka_unit_test(test_rotations),
        cmocka_unit_test(test_ties),
        cmocka_unit_test(test_picture_gradients),
    };

    return cmocka_run_group_tests_name("raster gradients at their extremes", tests, NULL, NULL);
}
