/* test_extremes_loss.c - the loss of a picture and the colour maps of cameras at extreme values:
 * pictures of one colour, black, white, smaller than the window, far brighter than any screen; maps
 * without an inverse. Values and gradients are finite, and equal those of loss_ref.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "loss_ref.h"
#include "train/loss/camera_colour.h"
#include "train/loss/loss.h"
#include "train/step/apply_gradients.h"

enum { MOST = 64 * 64 };

typedef struct {
    ted4_loss_workspace *w;
    int width, height;
    float image[3 * MOST], gradient[3 * MOST];
    double exact[3 * MOST];
    uint8_t truth[3 * MOST];
} problem;

static problem p;

static int set_up(void **state)
{
    (void)state;
    p.w = ted4_loss_workspace_new();
    return p.w != NULL ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_loss_workspace_free(p.w);
    return 0;
}

/* Asserts that everything is finite. Returns L. */
static double run(float weight, double *l1, double *ssim)
{
    const int n = 3 * p.width * p.height;
    const double loss =
        ted4_loss(p.w, p.image, p.truth, p.width, p.height, weight, NULL, p.gradient, l1, ssim);

    assert_true(isfinite(loss));
    assert_true(isfinite(*l1));
    assert_true(isfinite(*ssim));
    assert_true(loss >= -1e-6);
    for (int i = 0; i < n; i++)
        if (!isfinite(p.gradient[i]))
            fail_msg("value %d of %d x %d: %g has gradient %g", i, p.width, p.height,
                     (double)p.image[i], (double)p.gradient[i]);
    return loss;
}

/* Compares with the definition, for gradients of every step-th value. */
static void check(float weight, int step)
{
    const int n = 3 * p.width * p.height, plane = p.width * p.height;
    const ref_picture ref = { p.width, p.height, p.exact, p.truth };
    const double h = 1e-4, w = (double)weight;
    double l1, ssim, want_l1, want_ssim;

    for (int i = 0; i < n; i++)
        p.exact[i] = (double)p.image[i];
    const double loss = run(weight, &l1, &ssim),
                 want = ref_distortion(&ref, w, &want_l1, &want_ssim);

    if (!(fabs(loss - want) < 1e-4 && fabs(l1 - want_l1) < 1e-6 * (1 + want_l1) &&
          fabs(ssim - want_ssim) < 1e-4))
        fail_msg("%d x %d: %g, not %g; SSIM %g, not %g", p.width, p.height, loss, want, ssim,
                 want_ssim);
    for (int i = 0; i < n; i += step) {
        const int c = i / plane, y = i % plane / p.width, x = i % p.width;
        const double up = ref_local_loss(&ref, w, c, y, x, h),
                     down = ref_local_loss(&ref, w, c, y, x, -h);
        const double slope = (up - down) / (2 * h), got = (double)p.gradient[i] * n;

        if (weight < 1.0f && ref_absolute(&ref, c, y, x, 0) < 2 * h)
            continue; /* at the kink of |.| */
        if (!(fabs(got - slope) < 5e-3 * (1 + fabs(slope))))
            fail_msg("%d x %d, (%d, %d) of %d: %g, not %g", p.width, p.height, x, y, c, got, slope);
    }
}

static void fill(int width, int height, float image, uint8_t truth)
{
    p.width = width;
    p.height = height;
    for (int i = 0; i < 3 * width * height; i++)
        p.image[i] = image;
    memset(p.truth, truth, sizeof p.truth);
}

/* One constant colour against another: the variance is 0, and rounding must not create one. The
 * first colour differs from its truth by 1/255 of a byte. */
static void test_constant(void **state)
{
    static const int size[][2] = { { 1, 1 },   { 2, 1 },  { 1, 13 }, { 5, 5 },
                                   { 11, 11 }, { 40, 3 }, { 33, 17 } };
    static const uint8_t truth[] = { 0, 1, 128, 255 };
    static const float image[] = { 0, 1, 0.5f, -0.25f, 1.5f, 0x1p-24f, 1e-45f, FLT_MIN };

    (void)state;
    for (size_t s = 0; s < sizeof size / sizeof *size; s++)
        for (size_t t = 0; t < sizeof truth; t++)
            for (size_t i = 0; i < sizeof image / sizeof *image; i++) {
                fill(size[s][0], size[s][1], image[i], truth[t]);
                check(i % 2 ? 0.2f : 1.0f, 1 + (int)s);
            }
}

/* Equal pictures, black and white: the loss is nearly 0 and not negative, SSIM is nearly 1 and not
 * above, and gradients vanish. */
static void test_equal(void **state)
{
    (void)state;
    for (int white = 0; white < 2; white++)
        for (int side = 1; side <= 40; side += 13) {
            double l1, ssim;

            fill(side, side, (float)white, white ? 255 : 0);

            const double loss = run(1.0f, &l1, &ssim);

            assert_true(loss >= 0);
            assert_true(loss < 1e-5);
            assert_true(l1 < 1e-7);
            assert_true(ssim <= 1);
            assert_true(ssim > 1 - 1e-5);
            for (int i = 0; i < 3 * side * side; i++)
                assert_true(fabs((double)p.gradient[i]) * 3 * side * side < 2e-3);
        }
}

/* The sharpest edges: a chessboard, its negative, and lines, in black and white. */
static void test_contrast(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        fill(21, 19, 0, 0);
        for (int y = 0; y < 19; y++)
            for (int x = 0; x < 21; x++)
                for (int c = 0; c < 3; c++) {
                    const int on = kind < 2 ? (x + y) % 2 : kind == 2 ? x % 2 : y == 9;

                    p.truth[3 * (y * 21 + x) + c] = on ? 255 : 0;
                    p.image[(c * 19 + y) * 21 + x] = (float)(kind == 1 ? !on : kind == 2 ? 0 : on);
                }
        check(kind == 0 ? 1.0f : 0.2f, 3);
    }
}

/* Far brighter than white, where squares have no digits left for the variance: SSIM is determined
 * by rounding but finite, and L1 is correct. */
static void test_bright(void **state)
{
    static const float bright[] = { 30, 100, 1e3f, 65504, 1e6f, 1e9f, 1e15f, 1e18f };

    (void)state;
    for (size_t i = 0; i < sizeof bright / sizeof *bright; i++)
        for (int kind = 0; kind < 3; kind++) {
            double l1, ssim, want = 0;

            fill(37, 29, bright[i], 255);
            for (int k = 0; k < 3 * 37 * 29; k++) {
                p.image[k] *= kind == 1 ? -1 : 1;
                if (kind == 2)
                    p.image[k] *= 1 + 0x1p-20f * (float)(k * 7919 % 64);
                want += fabs((double)p.image[k] - 1) / (3 * 37 * 29);
            }
            const double loss = run(0.2f, &l1, &ssim);

            assert_true(fabs(l1 - want) < 1e-4 * want);
            assert_true(loss > 0.79 * want);
            assert_true(fabs(ssim) < 2.1);
        }
}

/* The same where rounding is about as large as the constants that SSIM's denominator adds to the
 * variances: no pixel's quotient may diverge, whatever the sign of the rounding error.
 * Mathematically SSIM is below 2 / 29, and the slope is that of L1. */
static void test_rounding(void **state)
{
    enum { SIDE = 23, N = 3 * SIDE * SIDE };

    (void)state;
    for (int n = 0; n < 400; n++) {
        const float bright = 30.0f + 0.7f * (float)n;
        double l1, ssim;

        fill(SIDE, SIDE, n % 3 == 1 ? -bright : bright, 255);
        for (int i = 0; i < N && n % 3 == 2; i++)
            p.image[i] *= 1 + 0x1p-23f * (float)(i * 7919 % 8);
        (void)run(0.2f, &l1, &ssim);
        assert_true(fabs(ssim) < 0.1);
        for (int i = 0; i < N; i++)
            assert_true(fabs((double)p.gradient[i]) * N < 1.5);
    }
}

/* ---- colour maps ---- */

enum { PIXELS = 3000 };

static void open_colour(ted4_colour *c)
{
    ted4_picture pic[4];
    const ted4_dataset d = { .pictures = pic, .n_pictures = 4, .n_cameras = 2 };

    memset(pic, 0, sizeof pic);
    for (int i = 0; i < 4; i++) {
        pic[i].camera_id = (uint32_t)i / 2;
        pic[i].camera.width = PIXELS;
        pic[i].camera.height = 1;
    }
    assert_int_equal(ted4_colour_init(c, &d), 0);
}

/* Constant pictures and gradients from 0 to huge, through maps from the identity to FP16's largest:
 * c' = c (I + A) + v in double precision, and its adjoint. All products are the same in every
 * pixel, so sums are PIXELS times one product. */
static void test_maps(void **state)
{
    static const float map[] = { 0, -1, 0x1p-24f, 1e-45f, 1, -65504, 65504 };
    static const float colour[] = { 0, 1, 1e-45f, 65504, -1e6f };
    static float image[3 * PIXELS], d[3 * PIXELS];

    (void)state;
    for (size_t m = 0; m < sizeof map / sizeof *map; m++)
        for (size_t k = 0; k < sizeof colour / sizeof *colour; k++) {
            ted4_colour c;
            ted4_colour_map gradient;

            open_colour(&c);
            for (int i = 0; i < TED4_COLOUR_VALUES; i++)
                c.value[1][i] = map[m];
            for (int i = 0; i < 3 * PIXELS; i++) {
                image[i] = colour[k];
                d[i] = 0.25f;
            }
            const float *out = ted4_colour_apply(&c, c.value[1], image, PIXELS, NULL);
            const double a = (double)map[m], x = (double)colour[k], want = x * (1 + 3 * a) + a;

            for (int i = 0; i < 3 * PIXELS; i++)
                assert_true(fabs((double)out[i] - want) <=
                            1e-5 * (fabs(x) * (1 + 3 * fabs(a)) + fabs(a)));
            ted4_colour_backward(&c, c.value[1], image, PIXELS, NULL, d, gradient);
            for (int i = 0; i < TED4_COLOUR_VALUES; i++) {
                const double sum = 0.25 * PIXELS * (i < 9 ? x : 1);

                assert_true(fabs((double)gradient[i] - sum) <= 1e-5 * fabs(sum) + 2e-42);
            }
            for (int i = 0; i < 3 * PIXELS; i++)
                assert_true(fabs((double)d[i] - 0.25 * (1 + 3 * a)) <= 1e-5 * (1 + 3 * fabs(a)));
            ted4_colour_finish(&c);
        }
}

/* For any map, undo returns a picture: bytes, or the unchanged picture if the map has no
 * inverse. */
static void test_undo(void **state)
{
    static const float diagonal[] = {
        0, -1, -0.9999f, -2, 1e-45f, 65504, 1e30f, FLT_MAX, -FLT_MAX
    };
    static uint8_t picture[3 * PIXELS];

    (void)state;
    for (size_t i = 0; i < sizeof diagonal / sizeof *diagonal; i++)
        for (int all = 0; all < 2; all++) {
            ted4_colour c;
            double inverse[9];

            open_colour(&c);
            for (size_t k = 0; k < sizeof picture; k++)
                picture[k] = (uint8_t)(k % 256);
            for (int k = 0; k < 9; k++)
                c.value[1][k] = all || k % 4 == 0 ? diagonal[i] : 0;
            c.value[1][9] = diagonal[i];
            const int bad = ted4_colour_invert(c.value[1], inverse);
            const uint8_t *seen = ted4_colour_undo(&c, c.value[1], picture, PIXELS, NULL);

            if (bad)
                assert_ptr_equal(seen, picture);
            for (int k = 0; k < 9 && !bad; k++)
                assert_true(isfinite(inverse[k]));
            ted4_colour_finish(&c);
        }
}

/* Repeated steps with gradients of any size: the map stays finite and moves by about the learning
 * rate. */
static void test_steps(void **state)
{
    static const float gradient_of[] = { 0, 1e-45f, 1e-30f, 1e-10f, 1, 1e10f, 1e18f };

    (void)state;
    for (size_t i = 0; i < sizeof gradient_of / sizeof *gradient_of; i++) {
        ted4_colour c;
        ted4_colour_map gradient;

        open_colour(&c);
        for (int k = 0; k < TED4_COLOUR_VALUES; k++)
            gradient[k] = k % 2 ? gradient_of[i] : -gradient_of[i];
        for (int step = 0; step < 20; step++)
            ted4_colour_update(&c, 1, 0, gradient, 0.01, 0);
        for (int k = 0; k < TED4_COLOUR_VALUES; k++) {
            assert_true(isfinite(c.value[1][k]));
            assert_true(fabsf(c.value[1][k]) < 0.11f);
            if (gradient_of[i] >=
                1e-10f) /* half of 20 steps: the gauge gives the other half to the other camera */
                assert_true(fabsf(fabsf(c.value[1][k]) - 0.1f) < 1e-4f);
        }
        ted4_colour_finish(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constant), cmocka_unit_test(test_equal),
        cmocka_unit_test(test_contrast), cmocka_unit_test(test_bright),
        cmocka_unit_test(test_rounding), cmocka_unit_test(test_maps),
        cmocka_unit_test(test_undo),     cmocka_unit_test(test_steps),
    };

    return cmocka_run_group_tests_name("loss and colour at their extremes", tests, set_up,
                                       tear_down);
}
