/* test_extremes_raster.c - projection, binning and blending at the limits of binary32: compared
 * with the plain renderer where that has a result; Gaussians that are left out are counted
 * (render/raster.h). test_raster.c tests values that occur in scenes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>
#include <string.h>

#include "test.h"
#include "raster_scene.h"
#include "render/raster_plain.h"
#include "train/raster/raster_bwd.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE };

/* A pixel may differ by a Gaussian of opacity 1/255 if rounding puts it on the other side of that
 * threshold. */
#define MAX_ERROR  (1.5 / 255)
/* Mean squared error: 90 dB. */
#define MAX_SQUARE 1e-9

/* A camera at the origin that looks along +z. The centres of pixels are at multiples of 1/64 at
 * depth 1. */
static ted4_view straight(void)
{
    return (ted4_view) { .width = SIDE,
                         .height = SIDE,
                         .fx = SIDE,
                         .fy = SIDE,
                         .cx = 0,
                         .cy = 0,
                         .R = { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
                         .near_z = 0.25f,
                         .background = { 0.25f, 0.5f, 1 } };
}

static scene make(size_t n)
{
    scene s = { n, calloc(n * SCENE_PARAMS + 1, sizeof(float)) };

    assert_non_null(s.value);
    return s;
}

/* Sets a round Gaussian with its centre at pixel (x, y) and depth z; size in scene units. */
static void set(scene *s, size_t i, double x, double y, float z, float size, float opacity)
{
    const ted4_view v = straight();

    scene_place(s, &v, i, x, y, (double)z);
    *scene_param(s, SCENE_MEAN + 2, i) = z;
    *scene_param(s, SCENE_ROT, i) = 1;
    *scene_param(s, SCENE_OPACITY, i) = opacity;
    for (int k = 0; k < 3; k++) {
        *scene_param(s, SCENE_SCALE + k, i) = size;
        *scene_param(s, SCENE_COLOUR + k, i) = (float)((i + (size_t)k) % 3) * 0.5f;
    }
}

/* Renders. Every value must be finite. Returns the number of Gaussians that were left out. */
static uint64_t draw(const scene *s, const ted4_view *v, float *image)
{
    const ted4_splats g = scene_splats(s);
    ted4_raster *r = ted4_raster_new();

    assert_non_null(r);
    assert_int_equal(ted4_raster_forward(r, &g, v, NULL, 1, image), 0);
    for (int i = 0; i < 3 * v->width * v->height; i++)
        assert_true(isfinite(image[i]));
    const uint64_t skipped = ted4_raster_skipped(r);

    ted4_raster_free(r);
    return skipped;
}

/* Asserts that no Gaussian is left out, and that the picture equals that of the plain renderer. */
static void check(const scene *s, const ted4_view *v)
{
    static float image[3 * PIXELS];
    static double plain[3 * PIXELS];
    const ted4_splats g = scene_splats(s);
    const int n = 3 * v->width * v->height;
    double square = 0;

    assert_int_equal(draw(s, v, image), 0);
    assert_int_equal(ted4_raster_plain(&g, v, plain), 0);
    for (int i = 0; i < n; i++) {
        const double e = fabs((double)image[i] - plain[i]);

        if (!(e <= MAX_ERROR))
            fail_msg("value %d: %g, not %g", i, (double)image[i], plain[i]);
        square += e * e / n;
    }
    assert_true(square <= MAX_SQUARE);
}

/* Sizes from 0 to a footprint 1.6e9 pixels wide, and a needle with both sizes. */
static void test_sizes(void **state)
{
    static const float size[] = { 0, 1e-45f, FLT_MIN, 0x1p-24f, 1e-6f, 1, 65504, 1e6f, 1e8f };
    const ted4_view v = straight();

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++)
        for (size_t k = 0; k < sizeof size / sizeof *size; k += 2) {
            scene s = make(3);

            set(&s, 0, 15.5, 16, 2, size[i], 0.7f);
            *scene_param(&s, SCENE_SCALE, 0) = size[k];
            set(&s, 1, 3, 4, 3, size[k], 0.9f);
            set(&s, 2, 20, 10, 4, 0.2f, 0.8f);
            check(&s, &v);
            scene_free(&s);
        }
}

/* Depths at the near plane, on either side of it, at the camera, and behind it. */
static void test_depths(void **state)
{
    static const float depth[] = { 0.25f, -0.25f, 0,        -0.0f,   1e-45f, FLT_MIN,
                                   -1,    -65504, -FLT_MAX, FLT_MAX, 65504,  1e30f };
    const ted4_view v = straight();

    (void)state;
    for (size_t i = 0; i < sizeof depth / sizeof *depth; i++) {
        scene s = make(3);

        set(&s, 0, 15.5, 16, 2, 0.1f, 0.7f);
        for (size_t k = 1; k < 3; k++)
            set(&s, k, 4, 9, 1, 0.1f, 0.9f);
        *scene_param(&s, SCENE_MEAN + 2, 1) = depth[i];
        *scene_param(&s, SCENE_MEAN + 2, 2) = nextafterf(depth[i], 1);
        if (depth[i] < FLT_MAX)
            check(&s, &v);
        else
            (void)draw(&s, &v, (float[3 * PIXELS]) { 0 });
        scene_free(&s);
    }
}

/* Depths over the whole range of binary32, with neighbouring and equal values, in random order, on
 * one line of sight. */
static void test_order(void **state)
{
    enum { N = 60 };
    const ted4_view v = straight();
    scene s = make(N);

    (void)state;
    for (size_t i = 0; i < N; i++) {
        const size_t k = i * 37 % N;
        float z = k < 40 ? 0.3f * powf(7, (float)k) : 0x1.8p20f;

        for (size_t n = 50; n < k; n++)
            z = nextafterf(z, FLT_MAX);
        set(&s, i, 16 + 0.1 * (double)(k % 5), 15, z, 0.1f * z, 0.15f);
    }
    check(&s, &v);
    scene_free(&s);
}

/* A near plane at the camera itself: Gaussians so near that 1 / z overflows are left out. */
static void test_no_near_plane(void **state)
{
    static float image[3 * PIXELS];
    ted4_view v = straight();
    scene s = make(4);

    (void)state;
    v.near_z = 0;
    set(&s, 0, 9, 9, 2, 0.1f, 0.7f);
    for (size_t i = 1; i < 4; i++)
        set(&s, i, 0, 0, 1, 0.1f, 0.9f);
    *scene_param(&s, SCENE_MEAN + 2, 1) = 1e-40f;
    *scene_param(&s, SCENE_MEAN + 2, 2) = 0;
    *scene_param(&s, SCENE_MEAN + 2, 3) = 1e-10f;
    assert_int_equal(draw(&s, &v, image),
                     2); /* the third has a footprint that overflows; depth 0 is not in front */
    scene_free(&s);
}

/* Centres on edges and corners of tiles, blocks, pixels and the picture; widths of the picture that
 * end within a tile and at its edge. */
static void test_edges(void **state)
{
    static const double at[] = { -0.5, 0, 0.5, 3.5, 4, 15.5, 16, 16.5, 31, 31.5, 32, 32.5 };
    enum { N = sizeof at / sizeof *at };

    (void)state;
    for (int width = 29; width <= SIDE; width += 3)
        for (int faint = 0; faint < 3; faint++) {
            ted4_view v = straight();
            scene s = make(N * N);

            for (size_t i = 0; i < N * N; i++)
                set(&s, i, at[i % N], at[i / N], 1, faint == 2 ? 0.01f : 0,
                    faint == 0 ? 1.001f / 255 : 0.4f);
            v.width = width;
            check(&s, &v);
            scene_free(&s);
        }
}

/* Opacities from 0 to 1, on either side of the threshold, and others below it: negative,
 * subnormal. */
static void test_opacities(void **state)
{
    const float least = TED4_RASTER_ALPHA_MIN;
    const float opacity[] = { 0,
                              -0.0f,
                              1e-45f,
                              -1e-45f,
                              FLT_MIN,
                              0x1p-24f,
                              -1,
                              -FLT_MAX,
                              nextafterf(least, 0),
                              least,
                              nextafterf(least, 1),
                              0.5f,
                              TED4_RASTER_ALPHA_MAX,
                              nextafterf(1, 0),
                              1 };
    const ted4_view v = straight();

    (void)state;
    for (size_t i = 0; i < sizeof opacity / sizeof *opacity; i++) {
        scene s = make(4);

        for (size_t k = 0; k < 4; k++)
            set(&s, k, 8.5 * (double)k + 0.5, 7.5, 1 + (float)k, 0.1f, opacity[i]);
        check(&s, &v);
        scene_free(&s);
    }
}

/* Quaternions that no head produces: rotation is a polynomial of the quaternion, with the value 1
 * at 0, whatever its length. */
static void test_rotations(void **state)
{
    static const float length[] = { 0, 1e-45f, 1e-20f, 0x1p-20f, 1e-3f, 1, 30, 1e3f };
    const ted4_view v = straight();

    (void)state;
    for (size_t i = 0; i < sizeof length / sizeof *length; i++)
        for (int axis = 0; axis < 4; axis++) {
            scene s = make(2);

            set(&s, 0, 15, 14, 2, 0.05f, 0.7f);
            set(&s, 1, 20, 20, 3, 0.1f, 0.8f);
            *scene_param(&s, SCENE_SCALE, 0) = 0.3f;
            for (int k = 0; k < 4; k++)
                *scene_param(&s, SCENE_ROT + k, 0) = length[i] * (k == axis ? 0.8f : 0.3f);
            check(&s, &v);
            scene_free(&s);
        }
}

/* Gaussians with values that binary32 cannot represent are left out and counted, and every bit of
 * the others stays the same. Gaussians that are behind the camera or too faint are not counted,
 * whatever else is wrong with them. */
static void test_skipped(void **state)
{
    static const float bad[] = { NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX };
    static float without[3 * PIXELS], with[3 * PIXELS];
    const ted4_view v = straight();
    scene s = make(3);

    (void)state;
    for (size_t i = 0; i < 3; i++)
        set(&s, i, 12 + 4 * (double)i, 16, 2 + (float)i, 0.1f, i == 1 ? 0 : 0.7f);
    assert_int_equal(draw(&s, &v, without), 0);
    for (int param = 0; param <= SCENE_OPACITY; param++)
        for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
            const int at_x = param < SCENE_MEAN + 2, is_z = param == SCENE_MEAN + 2,
                      is_opacity = param == SCENE_OPACITY;
            const int gone = is_z || is_opacity ? k == 2 || k == 4
                                                : 0; /* behind the camera; below every threshold */
            const int held = (at_x || is_opacity) &&
                             k >= 3; /* far outside the picture; opacities above 1 are 1 */

            set(&s, 1, 16, 16, 3, 0.1f, 0.7f);
            scene_rotation(&s, 1, 1, 1, 1, 1);
            *scene_param(&s, param, 1) = bad[k];
            if (is_opacity && k == 3)
                continue; /* these are drawn */
            const uint64_t skipped = draw(&s, &v, with);

            if (skipped != (uint64_t)(!gone && !held))
                fail_msg("parameter %d, %g: %llu left out", param, (double)bad[k],
                         (unsigned long long)skipped);
            assert_memory_equal(without, with, sizeof with);
            *scene_param(&s, SCENE_MEAN + 2, 1) = -1;
            if (!is_z) /* 0 times infinity: the depth is then unknown */
                assert_int_equal(draw(&s, &v, with), at_x && k < 3);
            set(&s, 1, 16, 16, 3, 0.1f, 0);
            if (!is_opacity) {
                *scene_param(&s, param, 1) = bad[k];
                assert_int_equal(draw(&s, &v, with), 0);
            }
        }
    scene_free(&s);
}

/* Counts are summed over passes, chunks of projection, and lanes. */
static void test_skipped_adds_up(void **state)
{
    static float image[3 * PIXELS];
    enum { N = 2 * 1024 + 37 };
    const ted4_view v = straight();
    scene s = make(N);
    const ted4_splats g = scene_splats(&s);
    ted4_raster *r = ted4_raster_new();
    uint64_t bad = 0;

    (void)state;
    assert_non_null(r);
    for (size_t i = 0; i < N; i++) {
        set(&s, i, 16, 16, 3, i % 3 == 1 ? 1e12f : 0.1f, 0.5f);
        bad += i % 3 == 1;
    }
    for (uint64_t pass = 1; pass <= 3; pass++) {
        assert_int_equal(ted4_raster_forward(r, &g, &v, NULL, 0, image), 0);
        assert_int_equal(ted4_raster_skipped(r), pass * bad);
    }
    ted4_raster_free(r);
    scene_free(&s);
}

/* An opacity that is not a number is counted also if all around it are too faint. */
static void test_skipped_among_faint(void **state)
{
    static float image[3 * PIXELS];
    const ted4_view v = straight();
    scene s = make(64);

    (void)state;
    for (size_t i = 0; i < s.n; i++)
        set(&s, i, 16, 16, 3, 0.1f, i == 20 ? NAN : 0.001f);
    assert_int_equal(draw(&s, &v, image), 1);
    scene_free(&s);
}

enum { CROWD = 100000 };

/* Many Gaussians in one tile, all at the same depth if equal is set, so faint that over a thousand
 * of them blend into a pixel. */
static scene make_crowd(int equal)
{
    scene s = make(CROWD);
    uint64_t seed = 5;

    for (size_t i = 0; i < CROWD; i++) {
        set(&s, i, scene_range(&seed, 1, 15), scene_range(&seed, 1, 15),
            equal ? 2.0f : (float)scene_range(&seed, 1, 9), 0.01f,
            (float)scene_range(&seed, 0.004, 0.03));
        for (int k = 0; k < 3; k++)
            *scene_param(&s, SCENE_COLOUR + k, i) = (float)ted4_split_uniform(&seed);
    }
    return s;
}

/* sum: the sum of all gradients with respect to a colour, if the gradient of every pixel is 1. All
 * colours of g are set to 1, so the picture shows the weights. */
static void check_weights(const ted4_splats *g, const ted4_view *v, double sum)
{
    static double plain[3 * PIXELS];
    double want = 0;

    assert_int_equal(ted4_raster_plain(g, v, plain), 0);
    for (int i = 0; i < v->width * v->height; i++)
        want += plain[i];
    assert_true(want > 200);
    assert_true(fabs(sum - want) <= 1e-3 * want);
}

/* 100,000 Gaussians in one tile: tests the picture, and that gradients are finite. The gradients of
 * colours are the weights, which sum to 1 minus the background's share. */
static void test_crowd(void **state)
{
    static float d_image[3 * PIXELS];
    ted4_view v = straight();

    (void)state;
    v.width = v.height = 16;
    v.background[0] = v.background[1] = v.background[2] = 0;
    for (int i = 0; i < 3 * 256; i++)
        d_image[i] = 1;
    for (int equal = 0; equal < 2; equal++) {
        static float image[3 * PIXELS];
        static double plain[3 * PIXELS];
        scene s = make_crowd(equal), d = make(CROWD);
        const ted4_splats g = scene_splats(&s);
        float *mean2d = malloc(CROWD * sizeof *mean2d);
        uint8_t *visible = malloc(CROWD);
        ted4_raster *r = ted4_raster_new();
        ted4_adjoint *adjoint = ted4_adjoint_new();
        double square = 0, sum = 0;

        assert_non_null(mean2d);
        assert_non_null(visible);
        assert_non_null(r);
        ted4_splat_grads grads = { .opacity = scene_param(&d, SCENE_OPACITY, 0),
                                   .mean2d = mean2d,
                                   .visible = visible };

        for (int k = 0; k < 4; k++)
            grads.rot[k] = scene_param(&d, SCENE_ROT + k, 0);
        for (int k = 0; k < 3; k++) {
            grads.mean[k] = scene_param(&d, SCENE_MEAN + k, 0);
            grads.scale[k] = scene_param(&d, SCENE_SCALE + k, 0);
            grads.colour[k] = scene_param(&d, SCENE_COLOUR + k, 0);
        }
        assert_int_equal(ted4_raster_forward(r, &g, &v, NULL, 1, image), 0);
        assert_int_equal(ted4_raster_plain(&g, &v, plain), 0);
        for (int i = 0; i < 3 * 256; i++)
            square += ((double)image[i] - plain[i]) * ((double)image[i] - plain[i]) / (3.0 * 256);
        assert_true(square <= 1e-8);
        assert_int_equal(ted4_raster_backward(adjoint, r, &g, &v, NULL, d_image, &grads), 0);
        for (size_t i = 0; i < CROWD * SCENE_PARAMS; i++)
            assert_true(isfinite(d.value[i]));
        for (size_t i = 0; equal && i < CROWD; i++) {
            sum += (double)*scene_param(&d, SCENE_COLOUR, i);
            for (int k = 0; k < 3; k++)
                *scene_param(&s, SCENE_COLOUR + k, i) = 1;
        }
        if (equal)
            check_weights(&g, &v, sum);
        ted4_adjoint_free(adjoint);
        ted4_raster_free(r);
        free(mean2d);
        free(visible);
        scene_free(&s);
        scene_free(&d);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_depths),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_no_near_plane),
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_opacities),
        cmocka_unit_test(test_rotations),
        cmocka_unit_test(test_skipped),
        cmocka_unit_test(test_skipped_adds_up),
        cmocka_unit_test(test_crowd),
        cmocka_unit_test(test_skipped_among_faint),
    };

    return cmocka_run_group_tests_name("raster at extreme values", tests, NULL, NULL);
}
