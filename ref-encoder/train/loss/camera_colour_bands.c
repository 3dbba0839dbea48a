/* camera_colour_bands.c - the passes of camera_colour.c over pixels. Sums over pixels are kept in
 * 16 lanes, with pixel i in lane i mod 16, and the lanes are added in order.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "camera_colour_job.h"

#include "render/vec.h"

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

void TED4_LEVELED(ted4_colour_apply_band)(void *job, size_t band)
{
    const ted4_colour_job *j = job;
    const size_t first = band * TED4_COLOUR_BAND, n = least(TED4_COLOUR_BAND, j->pixels - first);
    const float *r = j->image + first, *g = r + j->pixels, *b = g + j->pixels;

    for (int k = 0; k < 3; k++) {
        const float *a = j->map + k;
        const float of_r = a[0] + (k == 0), of_g = a[3] + (k == 1), of_b = a[6] + (k == 2);
        const float v = a[TED4_COLOUR_ROW_V];
        float *to = j->to + (size_t)k * j->pixels + first;

#pragma omp simd
        for (size_t i = 0; i < n; i++)
            to[i] = of_r * r[i] + of_g * g[i] + of_b * b[i] + v;
    }
}

/* Adds the products of the pixels of one lane group; pixels from n on count as 0. */
TED4_INLINE void add_group(const float *image, const float *d, size_t plane, size_t n,
                           ted4_vf sum[4][TED4_VECS])
{
    for (size_t p = 0; p < TED4_VECS; p++) {
        const size_t at = p * TED4_VEC, left = n > at ? n - at : 0;
        const ted4_vf e = ted4_vf_load_n(d + at, left);

        for (size_t k = 0; k < 3; k++)
            sum[k][p] = ted4_vf_fma(ted4_vf_load_n(image + k * plane + at, left), e, sum[k][p]);
        sum[3][p] += e;
    }
}

static double add_lanes(const ted4_vf sum[TED4_VECS])
{
    float lane[TED4_LANE_GROUP];
    double total = 0;

    memcpy(lane, sum, sizeof lane);
    for (int l = 0; l < TED4_LANE_GROUP; l++)
        total += (double)lane[l];
    return total;
}

/* Adds the sums of d times each colour and times 1, over at most TED4_COLOUR_RUN pixels, to column
 * k of a map. */
static void add_products(const float *image, const float *d, size_t plane, size_t n, double *column)
{
    const size_t whole = n / TED4_LANE_GROUP * TED4_LANE_GROUP;
    ted4_vf sum[4][TED4_VECS];

    for (int k = 0; k < 4; k++)
        for (int p = 0; p < TED4_VECS; p++)
            sum[k][p] = ted4_vf_all(0.0f);
    for (size_t i = 0; i < whole; i += TED4_LANE_GROUP)
        add_group(image + i, d + i, plane, TED4_LANE_GROUP, sum);
    if (whole < n)
        add_group(image + whole, d + whole, plane, n - whole, sum);
    for (int k = 0; k < 4; k++)
        column[3 * k] += add_lanes(sum[k]);
}

/* d <- (I + A) d for every pixel. */
static void turn_gradient(const float *a, float *d, size_t plane, size_t n)
{
    const float r0 = a[0] + 1.0f, r1 = a[1], r2 = a[2];
    const float g0 = a[3], g1 = a[4] + 1.0f, g2 = a[5];
    const float b0 = a[6], b1 = a[7], b2 = a[8] + 1.0f;
    float *r = d, *g = r + plane, *b = g + plane;

#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        const float x = r[i], y = g[i], z = b[i];

        r[i] = r0 * x + r1 * y + r2 * z;
        g[i] = g0 * x + g1 * y + g2 * z;
        b[i] = b0 * x + b1 * y + b2 * z;
    }
}

void TED4_LEVELED(ted4_colour_backward_band)(void *job, size_t band)
{
    const ted4_colour_job *j = job;
    const size_t end = least((band + 1) * TED4_COLOUR_BAND, j->pixels);
    double *sum = j->sums + band * TED4_COLOUR_VALUES;

    for (int k = 0; k < TED4_COLOUR_VALUES; k++)
        sum[k] = 0;
    for (size_t at = band * TED4_COLOUR_BAND; at < end; at += TED4_COLOUR_RUN) {
        const size_t n = least(TED4_COLOUR_RUN, end - at);

        for (size_t k = 0; k < 3; k++)
            add_products(j->image + at, j->to + k * j->pixels + at, j->pixels, n, sum + k);
        turn_gradient(j->map, j->to + at, j->pixels, n);
    }
}
