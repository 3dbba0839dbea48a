/* test_metrics.c - eval/metrics.h: cases that can be computed by hand, and slow reference
 * implementations written from the definitions.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "eval/metrics.h"
#include "odd_threads.h"
#include "random_source.h"

static random_source source = { 7 };

static uint8_t *constant(int width, int height, int value)
{
    uint8_t *v = malloc((size_t)width * (size_t)height * 3);

    assert_non_null(v);
    memset(v, value, (size_t)width * (size_t)height * 3);
    return v;
}

/* A smooth pattern with noise of the given size. */
static uint8_t *pattern(int width, int height, uint32_t noise)
{
    uint8_t *v = constant(width, height, 0);

    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++)
                v[(y * width + x) * 3 + c] =
                    (uint8_t)(90.0 + 60.0 * sin(0.1 * x * (c + 1)) * cos(0.07 * y) +
                              random_u32(&source) % noise);
    return v;
}

static void test_psnr(void **state)
{
    uint8_t *a = constant(20, 10, 100), *b = constant(20, 10, 105);
    ted4_metrics m;

    (void)state;
    assert_int_equal(ted4_metrics_compare(a, b, 20, 10, NULL, &m), 0);
    assert_true(fabs(m.psnr - 20.0 * log10(255.0 / 5.0)) < 1e-12);
    assert_int_equal(ted4_metrics_compare(a, a, 20, 10, NULL, &m), 0);
    assert_true(isinf(m.psnr));
    assert_true(fabs(m.ssim - 1.0) < 1e-12);
    assert_true(fabs(m.ssim2 - 1.0) < 1e-12);
    assert_true(isnan(m.ms_ssim));
    assert_int_equal(m.scales, 0); /* ten rows: the window does not fit */
    memcpy(b, a, 20 * 10 * 3);
    b[300] = 115; /* one value of 600 off by 15 */
    assert_int_equal(ted4_metrics_compare(a, b, 20, 10, NULL, &m), 0);
    assert_true(fabs(m.psnr - 10.0 * log10(255.0 * 255.0 * 600.0 / 225.0)) < 1e-12);
    assert_true(fabs(m.l1 - 15.0 / (600.0 * 255.0)) < 1e-15);
    free(a);
    free(b);
}

/* Two constant pictures have no covariance away from the border, so the luminance term remains. */
static void test_constants(void **state)
{
    const double x = 100.0 / 255.0, y = 160.0 / 255.0;
    uint8_t *a = constant(200, 190, 100), *b = constant(200, 190, 160);
    ted4_metrics m;

    (void)state;
    assert_int_equal(ted4_metrics_compare(a, b, 200, 190, NULL, &m), 0);
    assert_true(fabs(m.ssim2 - (2.0 * x * y + 4e-4) / (x * x + y * y + 4e-4)) < 1e-12);
    assert_int_equal(m.scales, 5);
    /* 200 x 190 is halved to 100 x 95 and then 50 x 48: the odd height 95 adds a row of half
     * values, so only the first scales are constant. */
    assert_true(m.ms_ssim < 1.0);
    assert_true(m.ms_ssim > 0.5);
    free(a);
    free(b);

    a = constant(176, 176, 100);
    b = constant(176, 176, 160);
    assert_int_equal(ted4_metrics_compare(a, b, 176, 176, NULL, &m), 0);
    assert_true(fabs(m.ms_ssim -
                     pow((2.0 * x * y + 1e-4) / (x * x + y * y + 1e-4), 0.1333 / 1.0001)) < 1e-9);
    free(a);
    free(b);
}

/* ---- definitions, computed without separation or reuse ---- */

typedef struct {
    double ssim, contrast;
} similarity;

/* A window of 2 half + 1 pixels; sigma 0: uniform. Pixels outside the picture count as zero. */
static similarity window_at(const double *a, const double *b, int w, int h, int x, int y, int half,
                            double sigma, double range)
{
    const double n = (2.0 * half + 1.0) * (2.0 * half + 1.0),
                 fix = sigma > 0.0 ? 1.0 : n / (n - 1.0);
    const double c1 = pow(0.01 * range, 2.0), c2 = pow(0.03 * range, 2.0);
    double total = 0.0, ma = 0.0, mb = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;

    for (int i = -half; i <= half; i++) {
        for (int k = -half; k <= half; k++) {
            const double g = sigma > 0.0 ? exp(-(i * i + k * k) / (2.0 * sigma * sigma)) : 1.0;
            const int in = y + i >= 0 && x + k >= 0 && y + i < h && x + k < w;
            const double p = in ? a[(y + i) * w + x + k] : 0.0,
                         q = in ? b[(y + i) * w + x + k] : 0.0;

            total += g;
            ma += g * p;
            mb += g * q;
            aa += g * p * p;
            bb += g * q * q;
            ab += g * p * q;
        }
    }
    ma /= total;
    mb /= total;
    aa = (aa / total - ma * ma) * fix;
    bb = (bb / total - mb * mb) * fix;
    ab = (ab / total - ma * mb) * fix;
    const double cs = (2.0 * ab + c2) / (aa + bb + c2);

    return (similarity) { cs * (2.0 * ma * mb + c1) / (ma * ma + mb * mb + c1), cs };
}

static similarity mean_over(const double *a, const double *b, int w, int h, int margin, int half,
                            double sigma, double range)
{
    similarity sum = { 0.0, 0.0 };

    for (int y = margin; y < h - margin; y++) {
        for (int x = margin; x < w - margin; x++) {
            const similarity s = window_at(a, b, w, h, x, y, half, sigma, range);

            sum.ssim += s.ssim / ((w - 2.0 * margin) * (h - 2.0 * margin));
            sum.contrast += s.contrast / ((w - 2.0 * margin) * (h - 2.0 * margin));
        }
    }
    return sum;
}

static double *plane_of(const uint8_t *v, int n, int channel)
{
    double *out = malloc((size_t)n * sizeof *out);

    assert_non_null(out);
    for (int i = 0; i < n; i++)
        out[i] = v[3 * i + channel] / 255.0;
    return out;
}

/* Adds a zero row or column before the first if a side is odd, then takes means of 2 x 2. */
static double *halved(double *v, int w, int h)
{
    const int ow = (w + 1) / 2, oh = (h + 1) / 2;
    double *padded = calloc((size_t)(2 * ow) * (size_t)(2 * oh), sizeof *padded);
    double *out = malloc((size_t)ow * (size_t)oh * sizeof *out);

    assert_non_null(padded);
    assert_non_null(out);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            padded[(y + h % 2) * 2 * ow + x + w % 2] = v[y * w + x];
    for (int y = 0; y < oh; y++) {
        for (int x = 0; x < ow; x++) {
            const double *p = padded + 2 * y * 2 * ow + 2 * x;

            out[y * ow + x] = (p[0] + p[1] + p[2 * ow] + p[2 * ow + 1]) / 4.0;
        }
    }
    free(padded);
    free(v);
    return out;
}

static double slow_ms_ssim(const uint8_t *a, const uint8_t *b, int w, int h, int scales)
{
    static const double weight[5] = { 0.0448, 0.2856, 0.3001, 0.2363, 0.1333 };
    double total = 0.0, mean = 0.0;

    for (int i = 0; i < scales; i++)
        total += weight[i];
    for (int c = 0; c < 3; c++) {
        double *p = plane_of(a, w * h, c), *q = plane_of(b, w * h, c), product = 1.0;
        int cw = w, ch = h;

        for (int i = 0; i < scales; i++) {
            const similarity s = mean_over(p, q, cw, ch, 5, 5, 1.5, 1.0);
            const double factor = i == scales - 1 ? s.ssim : s.contrast;

            product *= factor > 0.0 ? pow(factor, weight[i] / total) : 0.0;
            p = halved(p, cw, ch);
            q = halved(q, cw, ch);
            cw = (cw + 1) / 2;
            ch = (ch + 1) / 2;
        }
        mean += product / 3.0;
        free(p);
        free(q);
    }
    return mean;
}

static void check(int w, int h, uint32_t noise, int scales)
{
    uint8_t *a = pattern(w, h, 30), *b = pattern(w, h, noise);
    double ssim = 0.0, ssim2 = 0.0;
    ted4_metrics m;

    for (int c = 0; c < 3; c++) {
        double *p = plane_of(a, w * h, c), *q = plane_of(b, w * h, c);

        ssim += mean_over(p, q, w, h, 0, 5, 1.5, 1.0).ssim / 3.0;
        ssim2 += mean_over(p, q, w, h, 3, 3, 0.0, 2.0).ssim / 3.0;
        free(p);
        free(q);
    }
    assert_int_equal(ted4_metrics_compare(a, b, w, h, NULL, &m), 0);
    assert_true(fabs(m.ssim - ssim) < 1e-10);
    assert_true(fabs(m.ssim2 - ssim2) < 1e-10);
    assert_int_equal(m.scales, scales);
    assert_true(fabs(m.ms_ssim - slow_ms_ssim(a, b, w, h, scales)) < 1e-10);
    free(a);
    free(b);
}

static void test_definitions(void **state)
{
    (void)state;
    check(31, 24, 40, 2);
    check(11, 45, 90, 1);
    check(67, 53, 10, 3);
    check(176, 161, 100, 5);
}

static void test_threads(void **state)
{
    const ted4_parallel p = { odd_threads, NULL };
    uint8_t *a = pattern(90, 77, 30), *b = pattern(90, 77, 50);
    ted4_metrics one, three, swapped;

    (void)state;
    assert_int_equal(ted4_metrics_compare(a, b, 90, 77, NULL, &one), 0);
    assert_int_equal(ted4_metrics_compare(a, b, 90, 77, &p, &three), 0);
    assert_int_equal(ted4_metrics_compare(b, a, 90, 77, &p, &swapped), 0);
    assert_true(one.psnr == three.psnr);
    assert_true(one.ssim == three.ssim);
    assert_true(one.ssim2 == three.ssim2);
    assert_true(one.ms_ssim == three.ms_ssim);
    assert_true(one.psnr == swapped.psnr);
    assert_true(fabs(one.ssim - swapped.ssim) < 1e-12);
    assert_true(fabs(one.ms_ssim - swapped.ms_ssim) < 1e-12);
    free(a);
    free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_psnr),
        cmocka_unit_test(test_constants),
        cmocka_unit_test(test_definitions),
        cmocka_unit_test(test_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
