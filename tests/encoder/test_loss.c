/* test_loss.c - train/loss/loss.h against an independent implementation in double precision:
 * values, central differences, threads, sizes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "loss_ref.h"
#include "odd_threads.h"
#include "random_source.h"
#include "train/loss/loss.h"

/* exact: the image in double precision, which the reference reads. */
typedef struct {
    int width, height;
    float *image, *gradient;
    double *exact;
    uint8_t *truth;
    ref_picture reference;
} picture;

static random_source source = { 1 };

/* The rendered image is near the truth in its left half, far from it in its right half, and may
 * leave [0, 1]. */
static picture make(int width, int height)
{
    const size_t n = (size_t)width * (size_t)height * 3;
    picture p = { .width = width,
                  .height = height,
                  .image = malloc(n * sizeof(float)),
                  .gradient = malloc(n * sizeof(float)),
                  .exact = malloc(n * sizeof(double)),
                  .truth = malloc(n) };

    assert_non_null(p.image);
    assert_non_null(p.gradient);
    assert_non_null(p.exact);
    assert_non_null(p.truth);
    for (size_t i = 0; i < n; i++)
        p.truth[i] = (uint8_t)((i / 40 * 16 + random_u32(&source) % 64) & 255);
    for (int c = 0; c < 3; c++) {
        for (int y = 0; y < height; y++) {
            for (int x = 0; x < width; x++) {
                const float amount = x < width / 2 ? 0.05f : 1.2f;
                const float noise = (float)(random_u32(&source) % 1000) / 1000.0f - 0.5f;

                p.image[((size_t)c * (size_t)height + (size_t)y) * (size_t)width + (size_t)x] =
                    (float)p.truth[((size_t)y * (size_t)width + (size_t)x) * 3 + (size_t)c] /
                        255.0f +
                    amount * noise + 0.003f;
            }
        }
    }
    for (size_t i = 0; i < n; i++)
        p.exact[i] = (double)p.image[i];
    p.reference = (ref_picture) { width, height, p.exact, p.truth };
    return p;
}

static void drop(picture *p)
{
    free(p->image);
    free(p->gradient);
    free(p->exact);
    free(p->truth);
}

static void check_gradient(const picture *p, double w, int c, int y, int x)
{
    const ref_picture *ref = &p->reference;
    const double h = 1e-4, count = 3.0 * p->width * p->height;
    const double up = ref_local_loss(ref, w, c, y, x, h),
                 down = ref_local_loss(ref, w, c, y, x, -h);
    const double want = (up - down) / (2.0 * h);
    const double got = (double)p->gradient[ref_pixel(ref, c, y, x)] * count;

    if (ref_absolute(ref, c, y, x, 0.0) < 2.0 * h)
        return; /* at the kink of |.| */
    assert_true(fabs(got - want) < 2e-3 * (1.0 + fabs(want)));
}

static void check_values(const picture *p, double w, double loss, double l1, double ssim)
{
    double want_l1, want_ssim;
    const double want = ref_distortion(&p->reference, w, &want_l1, &want_ssim);

    assert_true(fabs(l1 - want_l1) < 1e-6);
    assert_true(fabs(ssim - want_ssim) < 1e-5);
    assert_true(fabs(loss - want) < 1e-5);
}

/* Sizes: smaller than the window, odd, and across tiles (128 columns) and bands (64 rows), all with
 * one workspace. */
static void test_reference(void **state)
{
    static const int size[][2] = { { 1, 1 }, { 7, 4 }, { 33, 21 }, { 150, 70 }, { 128, 64 } };
    ted4_loss_workspace *w = ted4_loss_workspace_new();

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        const float weight = i == 0 ? 1.0f : 0.2f;
        picture p = make(size[i][0], size[i][1]);
        double l1, ssim;
        const double loss =
            ted4_loss(w, p.image, p.truth, p.width, p.height, weight, NULL, p.gradient, &l1, &ssim);

        check_values(&p, (double)weight, loss, l1, ssim);
        for (int k = 0; k < 120; k++)
            check_gradient(&p, (double)weight, k % 3,
                           (int)random_in(&source, 0, (uint32_t)p.height - 1),
                           (int)random_in(&source, 0, (uint32_t)p.width - 1));
        for (int y = 60; y < 68 && y < p.height; y++)
            for (int x = 122; x < 134 && x < p.width; x += 3)
                check_gradient(&p, (double)weight, 1, y, x);
        check_gradient(&p, (double)weight, 0, 0, 0);
        check_gradient(&p, (double)weight, 2, p.height - 1, p.width - 1);
        drop(&p);
    }
    ted4_loss_workspace_free(w);
}

static void test_equal(void **state)
{
    ted4_loss_workspace *w = ted4_loss_workspace_new();
    picture p = make(40, 30);
    double l1, ssim;

    (void)state;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 40 * 30; i++)
            p.image[c * 40 * 30 + i] = (float)p.truth[3 * i + c] * (1.0f / 255.0f);
    assert_true(ted4_loss(w, p.image, p.truth, 40, 30, 0.2f, NULL, p.gradient, &l1, &ssim) < 1e-6);
    assert_true(l1 < 1e-7);
    assert_true(ssim > 1.0 - 1e-6);
    assert_true(ted4_loss(w, p.image, p.truth, 40, 30, 1.0f, NULL, p.gradient, &l1, &ssim) < 1e-6);
    for (int i = 0; i < 3 * 40 * 30; i++) /* SSIM is at its maximum */
        assert_true(fabsf(p.gradient[i]) * 3 * 40 * 30 < 1e-2f);
    drop(&p);
    ted4_loss_workspace_free(w);
}

static void test_threads(void **state)
{
    const ted4_parallel how[2] = { { odd_backwards, NULL }, { odd_threads, NULL } };
    ted4_loss_workspace *w = ted4_loss_workspace_new();
    picture p = make(200, 150);
    const size_t size = 3 * 200 * 150 * sizeof(float);
    float *first = malloc(size);
    double l1, ssim;
    const double loss = ted4_loss(w, p.image, p.truth, 200, 150, 0.2f, NULL, first, &l1, &ssim);

    (void)state;
    for (int i = 0; i < 2; i++) {
        double l1_again, ssim_again;

        assert_true(ted4_loss(w, p.image, p.truth, 200, 150, 0.2f, &how[i], p.gradient, &l1_again,
                              &ssim_again) == loss);
        assert_true(l1 == l1_again);
        assert_true(ssim == ssim_again);
        assert_memory_equal(first, p.gradient, size);
    }
    free(first);
    drop(&p);
    ted4_loss_workspace_free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_equal),
        cmocka_unit_test(test_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
