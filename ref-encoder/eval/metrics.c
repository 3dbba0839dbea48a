/* metrics.c - see metrics.h. Each pair of a channel and a kind of similarity is one task of the
 * parallel loop.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "eval/metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 3, HALF = TED4_SSIM_WINDOW / 2, BOX_HALF = TED4_SSIM2_WINDOW / 2 };

enum { KIND_GAUSS, KIND_BOX, KIND_SCALES, KINDS };

static const double K1 = 0.01, K2 = 0.03;
static const double SCALE_WEIGHT[TED4_MS_SSIM_SCALES] = { 0.0448, 0.2856, 0.3001, 0.2363, 0.1333 };

/* One channel of the two pictures, with values in [0, 1]. */
typedef struct {
    int width, height;
    double *a, *b;
} pair;

typedef struct {
    const uint8_t *a, *b;
    int width, height, scales;
    double value[KINDS][CHANNELS];
    int failed[KINDS][CHANNELS];
} job;

static void window_make(double g[TED4_SSIM_WINDOW])
{
    double sum = 0.0;

    for (int k = -HALF; k <= HALF; k++)
        sum += g[k + HALF] = exp(-k * k / (2.0 * 1.5 * 1.5));
    for (int k = 0; k < TED4_SSIM_WINDOW; k++)
        g[k] /= sum;
}

/* Filters a, b, a^2 + b^2 and ab vertically at row y. Rows outside the picture are zero. Each
 * out[i] holds HALF zeros, width values and HALF zeros. */
static void filter_down(const pair *p, const double *g, int y, double *const out[4])
{
    double *const oa = out[0] + HALF, *const ob = out[1] + HALF, *const os = out[2] + HALF,
                  *const op = out[3] + HALF;

    for (int i = 0; i < 4; i++)
        memset(out[i], 0, ((size_t)p->width + 2 * HALF) * sizeof(double));
    for (int k = -HALF; k <= HALF; k++) {
        if (y + k < 0 || y + k >= p->height)
            continue;
        const double w = g[k + HALF];
        const double *const a = p->a + (size_t)(y + k) * (size_t)p->width;
        const double *const b = p->b + (size_t)(y + k) * (size_t)p->width;

#pragma omp simd
        for (int x = 0; x < p->width; x++) {
            oa[x] += w * a[x];
            ob[x] += w * b[x];
            os[x] += w * (a[x] * a[x] + b[x] * b[x]);
            op[x] += w * (a[x] * b[x]);
        }
    }
}

/* Filters horizontally: out[x] is the filtered value of in[x] .. in[x + 10]. */
static void filter_along(const double *g, const double *in, double *out, int width)
{
    memset(out, 0, (size_t)width * sizeof *out);
    for (int k = 0; k < TED4_SSIM_WINDOW; k++)
#pragma omp simd
        for (int x = 0; x < width; x++)
            out[x] += g[k] * in[x + k];
}

typedef struct {
    double ssim, contrast;
} similarity;

/* Returns the sums of both similarities over columns [margin, width - margin) of a filtered row. */
static similarity row_similarity(double *const row[4], int width, int margin)
{
    const double c1 = K1 * K1, c2 = K2 * K2;
    const double *const ra = row[0], *const rb = row[1], *const rs = row[2], *const rp = row[3];
    double ssim = 0.0, contrast = 0.0;

#pragma omp simd reduction(+ : ssim, contrast)
    for (int x = margin; x < width - margin; x++) {
        const double a = ra[x], b = rb[x];
        const double cs = (2.0 * (rp[x] - a * b) + c2) / (rs[x] - a * a - b * b + c2);

        contrast += cs;
        ssim += cs * (2.0 * a * b + c1) / (a * a + b * b + c1);
    }
    return (similarity) { ssim, contrast };
}

/* Computes the means over the picture. With margin 0 the picture is padded with zeros; with HALF
 * only whole windows count. Returns 0, or -1 if there is no memory. */
static int gauss_similarity(const pair *p, int margin, similarity *mean)
{
    const size_t padded = (size_t)p->width + 2 * HALF;
    double *const block = malloc(8 * padded * sizeof *block);
    double *row[4], *along[4];
    const double count = (double)(p->width - 2 * margin) * (p->height - 2 * margin);
    double g[TED4_SSIM_WINDOW];

    if (block == NULL)
        return -1;
    window_make(g);
    for (int i = 0; i < 4; i++) {
        row[i] = block + (size_t)i * padded;
        along[i] = block + (size_t)(4 + i) * padded;
    }
    *mean = (similarity) { 0.0, 0.0 };
    for (int y = margin; y < p->height - margin; y++) {
        filter_down(p, g, y, row);
        for (int i = 0; i < 4; i++)
            filter_along(g, row[i], along[i], p->width);
        const similarity s = row_similarity(along, p->width, margin);

        mean->ssim += s.ssim;
        mean->contrast += s.contrast;
    }
    mean->ssim /= count;
    mean->contrast /= count;
    free(block);
    return 0;
}

static int side_halved(int side)
{
    return (side + 1) / 2;
}

/* Halves a plane in place, which is possible because no value is read from before the position
 * where the result is written. */
static void plane_halve(double *v, int width, int height)
{
    const int pad_x = width % 2, pad_y = height % 2, w = side_halved(width),
              h = side_halved(height);

    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            double sum = 0.0;

            for (int r = 2 * y - pad_y; r < 2 * y - pad_y + 2; r++)
                for (int c = 2 * x - pad_x; c < 2 * x - pad_x + 2; c++)
                    if (r >= 0 && c >= 0)
                        sum += v[(size_t)r * (size_t)width + (size_t)c];
            v[(size_t)y * (size_t)w + (size_t)x] = sum / 4.0;
        }
    }
}

static int scale_count(int width, int height)
{
    int n = 0;

    while (n < TED4_MS_SSIM_SCALES && width >= TED4_SSIM_WINDOW && height >= TED4_SSIM_WINDOW) {
        n++;
        width = side_halved(width);
        height = side_halved(height);
    }
    return n;
}

/* Overwrites the planes. Returns 0, or -1 if there is no memory. */
static int multi_scale(pair *p, int scales, double *value)
{
    double total = 0.0, product = 1.0;

    for (int i = 0; i < scales; i++)
        total += SCALE_WEIGHT[i];
    for (int i = 0; i < scales; i++) {
        similarity s;

        if (gauss_similarity(p, HALF, &s) != 0)
            return -1;
        product *= pow(fmax(0.0, i + 1 < scales ? s.contrast : s.ssim), SCALE_WEIGHT[i] / total);
        plane_halve(p->a, p->width, p->height);
        plane_halve(p->b, p->width, p->height);
        p->width = side_halved(p->width);
        p->height = side_halved(p->height);
    }
    *value = scales > 0 ? product : (double)NAN;
    return 0;
}

/* Returns the similarity at one pixel, from exact integer sums over its window. m aa - a a is
 * m (m - 1) times the sample variance, in units of 1 / 255^2. */
static double box_pixel(int64_t a, int64_t b, int64_t aa, int64_t bb, int64_t ab)
{
    const double n = TED4_SSIM2_WINDOW * TED4_SSIM2_WINDOW, range = 2.0;
    const double c1 = K1 * range * K1 * range, c2 = K2 * range * K2 * range;
    const double ma = (double)a / (n * 255.0), mb = (double)b / (n * 255.0);
    const double scale = 1.0 / (n * (n - 1.0) * 255.0 * 255.0);
    const int64_t m = TED4_SSIM2_WINDOW * TED4_SSIM2_WINDOW;
    const double va = (double)(m * aa - a * a) * scale, vb = (double)(m * bb - b * b) * scale;
    const double cov = (double)(m * ab - a * b) * scale;

    return (2.0 * ma * mb + c1) * (2.0 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
}

/* Sums a, b, a^2, b^2 and ab over the 7 rows from y on, for each column. */
static void box_down(const job *j, int channel, int y, int32_t *const out[5])
{
    for (int i = 0; i < 5; i++)
        memset(out[i], 0, (size_t)j->width * sizeof(int32_t));
    for (int r = y; r < y + TED4_SSIM2_WINDOW; r++) {
        const size_t row = (size_t)r * (size_t)j->width * CHANNELS + (size_t)channel;

        for (int x = 0; x < j->width; x++) {
            const int32_t a = j->a[row + (size_t)x * CHANNELS],
                          b = j->b[row + (size_t)x * CHANNELS];

            out[0][x] += a;
            out[1][x] += b;
            out[2][x] += a * a;
            out[3][x] += b * b;
            out[4][x] += a * b;
        }
    }
}

static int box_similarity(const job *j, int channel, double *value)
{
    const int w = j->width - 2 * BOX_HALF, h = j->height - 2 * BOX_HALF;
    const size_t width = (size_t)j->width;
    int32_t *const block = malloc(5 * width * sizeof *block);
    int32_t *const column[5] = { block, block + width, block + 2 * width, block + 3 * width,
                                 block + 4 * width };
    double sum = 0.0;

    if (block == NULL)
        return -1;
    for (int y = 0; y < h; y++) {
        box_down(j, channel, y, column);
        for (int x = 0; x < w; x++) {
            int64_t s[5] = { 0 };

            for (int i = 0; i < 5; i++)
                for (int k = 0; k < TED4_SSIM2_WINDOW; k++)
                    s[i] += column[i][x + k];
            sum += box_pixel(s[0], s[1], s[2], s[3], s[4]);
        }
    }
    *value = w > 0 && h > 0 ? sum / ((double)w * h) : (double)NAN;
    free(block);
    return 0;
}

static int gauss_task(const job *j, int channel, int kind, double *value)
{
    const size_t n = (size_t)j->width * (size_t)j->height;
    pair p = { j->width, j->height, calloc(n, sizeof(double)), calloc(n, sizeof(double)) };
    similarity s = { 0.0, 0.0 };
    int r = -1;

    if (p.a != NULL && p.b != NULL) {
        for (size_t i = 0; i < n; i++) {
            p.a[i] = j->a[CHANNELS * i + (size_t)channel] / 255.0;
            p.b[i] = j->b[CHANNELS * i + (size_t)channel] / 255.0;
        }
        if (kind == KIND_SCALES) {
            r = multi_scale(&p, j->scales, value);
        } else {
            r = gauss_similarity(&p, 0, &s);
            *value = s.ssim;
        }
    }
    free(p.a);
    free(p.b);
    return r;
}

static void compare_task(void *arg, size_t i)
{
    job *j = arg;
    const int kind = (int)(i % KINDS), channel = (int)(i / KINDS);

    j->failed[kind][channel] = kind == KIND_BOX
                                   ? box_similarity(j, channel, &j->value[kind][channel])
                                   : gauss_task(j, channel, kind, &j->value[kind][channel]);
}

static double psnr(const uint8_t *a, const uint8_t *b, size_t n)
{
    uint64_t sum = 0;

    for (size_t i = 0; i < n; i++) {
        const int d = a[i] - b[i];

        sum += (uint64_t)(d * d);
    }
    return sum == 0 ? (double)INFINITY : 10.0 * log10(255.0 * 255.0 * (double)n / (double)sum);
}

static double l1(const uint8_t *a, const uint8_t *b, size_t n)
{
    uint64_t sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += (uint64_t)(a[i] > b[i] ? a[i] - b[i] : b[i] - a[i]);
    return (double)sum / (255.0 * (double)n);
}

int ted4_metrics_compare(const uint8_t *a, const uint8_t *b, int width, int height,
                         const ted4_parallel *p, ted4_metrics *m)
{
    job j = {
        .a = a, .b = b, .width = width, .height = height, .scales = scale_count(width, height)
    };
    double mean[KINDS] = { 0.0 };

    ted4_parallel_for(p, KINDS * CHANNELS, compare_task, &j);
    for (int k = 0; k < KINDS; k++) {
        for (int c = 0; c < CHANNELS; c++) {
            if (j.failed[k][c])
                return -1;
            mean[k] += j.value[k][c] / CHANNELS;
        }
    }
    *m = (ted4_metrics) { psnr(a, b, (size_t)width * (size_t)height * CHANNELS),
                          mean[KIND_GAUSS],
                          mean[KIND_BOX],
                          mean[KIND_SCALES],
                          l1(a, b, (size_t)width * (size_t)height * CHANNELS),
                          j.scales };
    return 0;
}
