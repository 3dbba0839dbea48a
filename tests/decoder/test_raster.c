/* test_raster.c - compares the tile rasteriser with its plain twin, and with itself for other
 * numbers of threads.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "test.h"
#include "larger.h"
#include "tool/threads.h"
#include "odd_threads.h"
#include "raster_scene.h"
#include "render/raster_plain.h"

/* The project asks for 60 dB between any two renderers; float against double reaches far more. A
 * pixel may still differ by one Gaussian of opacity 1/255 if rounding puts it on the other side of
 * that threshold. */
#define MIN_PSNR  90.0
#define MAX_ERROR (1.5 / 255)

static double psnr(const float *a, const double *b, size_t n, double *worst)
{
    double sum = 0;

    *worst = 0;
    for (size_t i = 0; i < n; i++) {
        const double e = fabs(a[i] - b[i]);

        assert_true(isfinite(a[i]));
        sum += e * e;
        *worst = larger(*worst, e);
    }
    return 10 * log10((double)n / (sum + 1e-30));
}

static void check_against_plain(const scene *s, const ted4_view *v)
{
    const size_t n = 3 * (size_t)v->width * (size_t)v->height;
    const ted4_splats g = scene_splats(s);
    float *image = malloc(n * sizeof *image);
    double *plain = malloc(n * sizeof *plain), worst;
    ted4_raster *r = ted4_raster_new();

    assert_non_null(image);
    assert_non_null(plain);
    assert_non_null(r);
    assert_int_equal(ted4_raster_forward(r, &g, v, NULL, 0, image), 0);
    assert_int_equal(ted4_raster_plain(&g, v, plain), 0);
    assert_true(psnr(image, plain, n, &worst) >= MIN_PSNR);
    assert_true(worst <= MAX_ERROR);
    ted4_raster_free(r);
    free(image);
    free(plain);
}

static void test_random(void **state)
{
    static const int size[][2] = { { 1, 1 },   { 3, 2 },   { 16, 16 },
                                   { 17, 33 }, { 64, 48 }, { 100, 70 } };

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof size[0]; i++)
        for (int sigma = 1; sigma <= 9; sigma += 4) {
            const ted4_view v = scene_view(size[i][0], size[i][1]);
            scene s = scene_random(300, &v, sigma, i * 10 + (unsigned)sigma);

            check_against_plain(&s, &v);
            scene_free(&s);
        }
}

/* Pictures whose tiles or instances could not be counted are refused before anything is drawn. */
static void test_too_large(void **state)
{
    static const int size[][2] = { { 1048561, 1 }, { 1, 1048561 }, { 32768, 32784 } };
    ted4_raster *r = ted4_raster_new();
    const ted4_view small = scene_view(16, 16);
    scene s = scene_random(4, &small, 1, 1);
    const ted4_splats g = scene_splats(&s);

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        const ted4_view v = scene_view(size[i][0], size[i][1]);

        assert_int_equal(ted4_raster_forward(r, &g, &v, NULL, 0, NULL), -1);
    }
    ted4_raster_free(r);
    scene_free(&s);
}

/* Pixels coarser and finer than those of training (annex I.4). */
static void test_other_pixels(void **state)
{
    static const float pixel[] = { 0.3f, 1, 1.5f, 2, 9, 64 };

    (void)state;
    for (size_t i = 0; i < sizeof pixel / sizeof *pixel; i++)
        for (int sigma = 1; sigma <= 9; sigma += 4) {
            ted4_view v = scene_view(64, 48);
            scene s = scene_random(300, &v, sigma, i * 10 + (unsigned)sigma);

            v.pixel = pixel[i];
            check_against_plain(&s, &v);
            scene_free(&s);
        }
}

static void draw(const scene *s, const ted4_view *v, float *image)
{
    const ted4_splats g = scene_splats(s);
    ted4_raster *r = ted4_raster_new();

    assert_non_null(r);
    assert_int_equal(ted4_raster_forward(r, &g, v, NULL, 0, image), 0);
    ted4_raster_free(r);
}

/* The same camera with pixels n times as wide. */
static ted4_view coarser(const ted4_view *v, int n, float pixel)
{
    ted4_view c = *v;

    c.width /= n;
    c.height /= n;
    c.fx /= (float)n;
    c.fy /= (float)n;
    c.cx /= (float)n;
    c.cy /= (float)n;
    c.pixel = pixel;
    return c;
}

/* A coarse picture is the mean of the fine one's pixels, much more so than without the correction.
 */
static void test_coarser(void **state)
{
    enum { N = 4, WIDTH = 128, HEIGHT = 96, W = WIDTH / N, H = HEIGHT / N };
    static float fine[3 * WIDTH * HEIGHT], mean[3 * W * H], coarse[3 * W * H], without[3 * W * H];
    static double want[3 * W * H];
    const ted4_view v = scene_view(WIDTH, HEIGHT), c = coarser(&v, N, N), u = coarser(&v, N, 0);
    scene s = scene_random(2000, &v, 0.5, 3);
    double worst;

    (void)state;
    draw(&s, &v, fine);
    draw(&s, &c, coarse);
    draw(&s, &u, without);
    for (size_t i = 0; i < 3 * (size_t)HEIGHT * WIDTH; i++)
        mean[i / (WIDTH * HEIGHT) * W * H + i / WIDTH % HEIGHT / N * W + i % WIDTH / N] += fine[i] /
                                                                                           (N * N);
    for (size_t i = 0; i < 3 * (size_t)W * H; i++)
        want[i] = (double)mean[i];

    const double with = psnr(coarse, want, 3 * (size_t)W * H, &worst);
    const double bare = psnr(without, want, 3 * (size_t)W * H, &worst);

    if (!(with >= 27 && with >= bare + 6))
        fail_msg("%.2f dB, without correction %.2f dB", with, bare);
    scene_free(&s);
}

static void test_nothing(void **state)
{
    const ted4_view v = scene_view(17, 9);
    scene s = scene_random(0, &v, 1, 1);

    (void)state;
    check_against_plain(&s, &v);
    scene_free(&s);
}

/* Each possible fault of a single Gaussian, placed between ordinary ones. */
static void test_awkward(void **state)
{
    const ted4_view v = scene_view(50, 40);
    scene s = scene_random(64, &v, 3, 5);
    uint64_t seed = 77;

    (void)state;
    for (size_t i = 0; i < s.n; i += 2) {
        const double x = scene_range(&seed, 0, 50), y = scene_range(&seed, 0, 40);
        float *scale[3] = { scene_param(&s, SCENE_SCALE, i), scene_param(&s, SCENE_SCALE + 1, i),
                            scene_param(&s, SCENE_SCALE + 2, i) };
        float *opacity = scene_param(&s, SCENE_OPACITY, i);

        switch (i / 2 % 12) {
        case 0: scene_place(&s, &v, i, x, y, -2); break;
        case 1: scene_place(&s, &v, i, x, y, 0.2000001); break;
        case 2: scene_place(&s, &v, i, x, y, 0.1999999); break;
        case 3: *scale[0] = *scale[1] = *scale[2] = 30; break;
        case 4: *scale[0] = *scale[1] = *scale[2] = 1e-6f; break;
        case 5: *opacity = TED4_RASTER_ALPHA_MIN * 1.0001f; break;
        case 6: *opacity = TED4_RASTER_ALPHA_MIN * 0.9999f; break;
        case 7: *opacity = 1; break;
        case 8: *opacity = -0.5f; break;
        case 9: scene_place(&s, &v, i, 400, -300, 1); break;
        case 10:
            *scale[0] = 3;
            *scale[1] = *scale[2] = 1e-4f;
            break;
        default:
            scene_place(&s, &v, i, -80, y, 1);
            *scale[0] = *scale[1] = *scale[2] = 1;
            break;
        }
    }
    check_against_plain(&s, &v);
    scene_free(&s);
}

/* A long thin Gaussian along the diagonal whose centre is far outside the picture: the case in
 * which the textbook form of the exponent suffers cancellation. */
static void test_needle(void **state)
{
    ted4_view v = scene_view(64, 64);
    scene s = scene_random(1, &v, 1, 9);

    (void)state;
    v.R[0] = v.R[8] = 1;
    v.R[2] = v.R[6] = 0;
    scene_place(&s, &v, 0, -568, -568, 2);
    scene_rotation(&s, 0, cos(0.39269908), 0, 0, sin(0.39269908));
    *scene_param(&s, SCENE_SCALE, 0) = 20;
    *scene_param(&s, SCENE_SCALE + 1, 0) = *scene_param(&s, SCENE_SCALE + 2, 0) = 1e-3f;
    *scene_param(&s, SCENE_OPACITY, 0) = 0.9f;
    v.fx = v.fy;
    v.cx = v.cy;
    check_against_plain(&s, &v);
    scene_free(&s);
}

/* Values that do not occur in any trained scene must do no harm. */
static void test_not_finite(void **state)
{
    const ted4_view v = scene_view(40, 24);
    scene s = scene_random(SCENE_PARAMS * 3, &v, 3, 6);
    const float bad[3] = { NAN, INFINITY, -INFINITY };
    float image[3 * 40 * 24];

    (void)state;
    for (size_t i = 0; i < s.n; i++)
        if (i % SCENE_PARAMS < SCENE_COLOUR)
            *scene_param(&s, (int)(i % SCENE_PARAMS), i) = bad[i / SCENE_PARAMS];

    const ted4_splats g = scene_splats(&s);
    ted4_raster *r = ted4_raster_new();
    assert_non_null(r);
    assert_int_equal(ted4_raster_forward(r, &g, &v, NULL, 1, image), 0);
    for (size_t i = 0; i < sizeof image / sizeof image[0]; i++)
        assert_true(isfinite(image[i]));
    ted4_raster_free(r);
    scene_free(&s);
}

/* Equal depths: the lower index is in front. */
static void test_ties(void **state)
{
    ted4_view v = scene_view(20, 20);
    scene s = scene_random(50, &v, 6, 3);

    (void)state;
    for (size_t i = 0; i < s.n; i++)
        for (int k = 0; k < 3; k++)
            *scene_param(&s, SCENE_MEAN + k, i) = k == 2 ? 2.0f : 0.01f * (float)(i % 7) - 0.1f;
    memcpy(v.R, (const float[9]) { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, sizeof v.R);
    check_against_plain(&s, &v);
    scene_free(&s);
}

static void test_threads(void **state)
{
    enum { W = 90, H = 61, N = 3 * W * H };
    static float one[N], many[N];
    const ted4_view v = scene_view(W, H);
    scene s = scene_random(5000, &v, 2, 8);
    const ted4_splats g = scene_splats(&s);
    ted4_raster *r = ted4_raster_new();
    ted4_parallel p[4] = { { odd_backwards, NULL } };

    (void)state;
    assert_non_null(r);
    for (int i = 1; i < 4; i++)
        ted4_threads_init(&p[i], 2 * i - 1);
    assert_int_equal(ted4_raster_forward(r, &g, &v, NULL, 0, one), 0);
    for (int i = 0; i < 4; i++) {
        memset(many, 0, sizeof many);
        assert_int_equal(ted4_raster_forward(r, &g, &v, &p[i], i & 1, many), 0);
        assert_memory_equal(one, many, sizeof one);
    }
    for (int i = 1; i < 4; i++)
        ted4_threads_finish(&p[i]);
    ted4_raster_free(r);
    scene_free(&s);
}

/* A workspace that was used for a larger scene renders a smaller one, and vice versa. */
static void test_reuse(void **state)
{
    enum { W = 33, H = 20, N = 3 * W * H };
    static float fresh[N], reused[N];
    const ted4_view v = scene_view(W, H), large = scene_view(2 * W, H);
    static float other[2 * N];
    scene s = scene_random(40, &v, 3, 1), t = scene_random(700, &v, 3, 2);
    const ted4_splats g = scene_splats(&s), h = scene_splats(&t);
    ted4_raster *r = ted4_raster_new(), *q = ted4_raster_new();

    (void)state;
    assert_non_null(r);
    assert_non_null(q);
    assert_int_equal(ted4_raster_forward(q, &g, &v, NULL, 0, fresh), 0);
    assert_int_equal(ted4_raster_forward(r, &g, &v, NULL, 0, reused), 0);
    assert_int_equal(ted4_raster_forward(r, &h, &large, NULL, 1, other), 0);
    assert_int_equal(ted4_raster_forward(r, &g, &v, NULL, 0, reused), 0);
    assert_memory_equal(fresh, reused, sizeof fresh);
    ted4_raster_free(r);
    ted4_raster_free(q);
    ted4_raster_free(NULL);
    scene_free(&s);
    scene_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),     cmocka_unit_test(test_other_pixels),
        cmocka_unit_test(test_coarser),    cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_awkward),    cmocka_unit_test(test_needle),
        cmocka_unit_test(test_not_finite), cmocka_unit_test(test_ties),
        cmocka_unit_test(test_threads),    cmocka_unit_test(test_reuse),
        cmocka_unit_test(test_too_large),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
