/* loss.c - see loss.h. SSIM of an 11 x 11 Gaussian window (sigma 1.5), turned by 45 degrees: with u = x + y and v = x - y the
 * four filtered planes u, v, u^2, v^2 give all
 * that SSIM needs (instead of five), and v is the L1 residual as well.
 *
 * Three passes, each parallel over fixed pieces of the picture: (1) u, v and L1; (2) the four filters,
 * SSIM and its derivatives by the filtered
 * planes; (3) the same filter, which is its own adjoint, over the three derivative planes. A filter
 * runs along rows into a ring of 11 rows of a
 * tile that stays in the first-level cache, then down the ring.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "train/loss.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A job is SPLIT rows in the first pass, BAND rows of a tile's width in the others: few enough that a small picture keeps 32 cores busy. */
enum { TAPS = 11, HALF = TAPS / 2, LANES = 16, TILE = 128, SPLIT = 4, BAND = 32, CHANNELS = 3 };

typedef float   lanes __attribute__((vector_size(64)));
typedef int32_t lanes_i __attribute__((vector_size(64)));
typedef float   lanes_mem __attribute__((vector_size(64), aligned(4), may_alias));

/* exp(-k^2 / (2 1.5^2)) for k = 5 .. -5, divided by the sum. */
static const float GAUSS[TAPS] = {
    0.00102838008f, 0.00759875814f, 0.0360007721f, 0.10936069f, 0.213005538f, 0.266011725f,
    0.213005538f, 0.10936069f, 0.0360007721f, 0.00759875814f, 0.00102838008f
};

/* Planes have LANES zero columns on the left, and zeros from the width to the end of the row, so
 * that a filter may read over the sides. */
struct ted4_loss_workspace {
    float  *block;              /* owned: u, v, then three derivatives, each [3][height][stride] */
    size_t  capacity;           /* floats in block */
    double *sum;                /* owned: one partial sum a chunk */
    size_t  n_sums;
};

typedef struct {
    const float   *image;
    const uint8_t *truth;
    float         *d_image;
    float         *u, *v, *d[3];
    double        *sum;
    int            width, height, n_splits, n_bands, n_tiles;
    size_t         stride, plane;       /* floats from row to row, channel to channel */
    float          l1_step, ssim_step;  /* dL/d|v|, -dL/dSSIM of one value */
} job;

typedef float ring4[TAPS][4][TILE];
typedef float ring3[TAPS][3][TILE];

static inline lanes load(const float *p)
{
    return *(const lanes_mem *)p;
}

static inline void store(float *p, lanes x)
{
    *(lanes_mem *)p = x;
}

static inline int min_int(int a, int b)
{
    return a < b ? a : b;
}

/* ---- pass 1: u = x + y, v = x - y, sum of |v| ---- */

static double split_row(const float *x, const uint8_t *y, float *u, float *v, int width)
{
    float sum = 0.0f;

#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < width; i++) {
        const float t = (float)y[CHANNELS * i] * (1.0f / 255.0f);
        const float d = x[i] - t;

        u[i] = x[i] + t;
        v[i] = d;
        sum += d < 0.0f ? -d : d;
    }
    return (double)sum;
}

static void clear_left(float *row)
{
    memset(row, 0, LANES * sizeof *row);
}

static void clear_right(float *row, size_t stride, int width)
{
    memset(row + LANES + width, 0, (stride - LANES - (size_t)width) * sizeof *row);
}

static void split_band(void *arg, size_t band)
{
    const job *j = arg;
    const int first = (int)band * SPLIT, last = min_int(first + SPLIT, j->height);
    double sum = 0.0;

    for (int r = first; r < last; r++) {
        for (int c = 0; c < CHANNELS; c++) {
            const size_t at = (size_t)c * j->plane + (size_t)r * j->stride;
            const size_t row = (size_t)r * (size_t)j->width;

            clear_left(j->u + at);
            clear_left(j->v + at);
            clear_right(j->u + at, j->stride, j->width);
            clear_right(j->v + at, j->stride, j->width);
            sum += split_row(j->image + (size_t)c * (size_t)j->width * (size_t)j->height + row,
                             j->truth + row * CHANNELS + c,
                             j->u + at + LANES, j->v + at + LANES, j->width);
        }
    }
    j->sum[band] = sum;
}

/* What job i of the second and third pass does. */
typedef struct {
    size_t channel;
    int    first, last, x0;     /* rows, first column */
} piece;

static piece piece_of(const job *j, size_t i)
{
    const int tile = (int)(i % (size_t)j->n_tiles), band = (int)(i / (size_t)j->n_tiles % (size_t)j->n_bands);

    return (piece){ i / (size_t)j->n_tiles / (size_t)j->n_bands, band * BAND, min_int((band + 1) * BAND, j->height), tile * TILE };
}

/* ---- pass 2: SSIM and its derivatives ---- */

/* u, v: at the first output column. */
static void filter_squares(const float *u, const float *v, int n, float out[4][TILE])
{
    for (int x = 0; x < n; x += LANES) {
        lanes mu = { 0 }, mv = { 0 }, uu = { 0 }, vv = { 0 };

        for (int k = 0; k < TAPS; k++) {
            const lanes a = load(u + x + k - HALF), b = load(v + x + k - HALF);
            const lanes ga = a * GAUSS[k], gb = b * GAUSS[k];

            mu += ga;
            mv += gb;
            uu += ga * a;
            vv += gb * b;
        }
        store(out[0] + x, mu);
        store(out[1] + x, mv);
        store(out[2] + x, uu);
        store(out[3] + x, vv);
    }
}

static inline lanes at_least(lanes x, float least)
{
    const lanes   floor = least - (lanes){ 0 };
    const lanes_i low = x < floor;

    return (lanes)((low & (lanes_i)floor) | (~low & (lanes_i)x));
}

/* SSIM = (A1 A2) / (B1 B2) from the local means mu, mv and second moments uu, vv. With a = mu^2,
 * b = mv^2, p = uu - a, q = vv - b:
 *     A1 = a - b + 2 C1,  B1 = a + b + 2 C1,  A2 = p - q + 2 C2,  B2 = p + q + 2 C2
 * p and q are variances, so nothing is divided by less than 2 C2; where the picture is so bright that their rounding is larger than that, they
 * are held above -C2 / 2.
 * d: derivatives by what x is filtered into: mu + mv together (du/dx = dv/dx = 1), uu, vv. */
static inline lanes similarity(lanes mu, lanes mv, lanes uu, lanes vv, lanes d[3])
{
    const float c1 = 2.0f * TED4_SSIM_C1, c2 = 2.0f * TED4_SSIM_C2;
    const lanes a = mu * mu, b = mv * mv;
    const lanes p = at_least(uu - a, -0.25f * c2), q = at_least(vv - b, -0.25f * c2);
    const lanes b1 = a + b + c1, b2 = p + q + c2;
    const lanes r = 1.0f / (b1 * b2);
    const lanes r1 = r * b2, r2 = r * b1;
    const lanes l = (a - b + c1) * r1, s = (p - q + c2) * r2;
    const lanes k1 = 2.0f * s * r1 * r1, k2 = 2.0f * l * r2 * r2;

    d[1] = k2 * q;
    d[2] = -k2 * (p + c2);
    d[0] = 2.0f * (mu * (k1 * b - d[1]) - mv * (k1 * (a + c1) + d[2]));
    return l * s;
}

static double similarity_row(ring4 ring, int oldest, int n, int valid, float *const d[3])
{
    lanes sum = { 0 };

    for (int x = 0; x < n; x += LANES) {
        lanes m[4] = { { 0 } }, dv[3], s;

        for (int k = 0; k < TAPS; k++) {
            const int slot = oldest + k < TAPS ? oldest + k : oldest + k - TAPS;

            for (int i = 0; i < 4; i++)
                m[i] += load(ring[slot][i] + x) * GAUSS[k];
        }
        s = similarity(m[0], m[1], m[2], m[3], dv);
        for (int l = valid - x; l < LANES; l++)
            s[l < 0 ? 0 : l] = 0.0f;
        sum += s;
        for (int i = 0; i < 3; i++)
            store(d[i] + x, dv[i]);
    }
    for (int i = 0; i < 3 && valid < n; i++)
        memset(d[i] + valid, 0, (size_t)(n - valid) * sizeof(float));

    double total = 0.0;

    for (int l = 0; l < LANES; l++)
        total += (double)sum[l];
    return total;
}

static double similarity_tile(const job *j, size_t plane, int first, int last, int x0)
{
    ring4 ring;
    const int n = min_int(TILE, (int)j->stride - 2 * LANES - x0), valid = min_int(n, j->width - x0);
    int slot = 0;
    double sum = 0.0;

    for (int r = first - HALF; r < last + HALF; r++) {
        const size_t at = plane + (size_t)(r < 0 ? 0 : r) * j->stride + LANES + (size_t)x0;

        if (r < 0 || r >= j->height)
            memset(ring[slot], 0, sizeof ring[slot]);
        else
            filter_squares(j->u + at, j->v + at, n, ring[slot]);
        slot = slot + 1 < TAPS ? slot + 1 : 0;
        if (r >= first + HALF) {
            const size_t to = plane + (size_t)(r - HALF) * j->stride + LANES + (size_t)x0;
            float *const d[3] = { j->d[0] + to, j->d[1] + to, j->d[2] + to };

            sum += similarity_row(ring, slot, n, valid, d);
        }
    }
    return sum;
}

static void similarity_piece(void *arg, size_t i)
{
    const job *j = arg;
    const piece p = piece_of(j, i);
    const size_t plane = p.channel * j->plane;

    for (int r = p.first; r < p.last; r++)
        for (int k = 0; k < 3; k++) {
            float *row = j->d[k] + plane + (size_t)r * j->stride;

            if (p.x0 == 0)
                clear_left(row);
            if (p.x0 + TILE >= j->width)
                clear_right(row, j->stride, j->width);
        }
    j->sum[i] = similarity_tile(j, plane, p.first, p.last, p.x0);
}

/* ---- pass 3: dL/dx = l1_step sign(v) - ssim_step (G d0 + 2 u G d1 + 2 v G d2) ---- */

static void filter_derivatives(const float *const d[3], int n, float out[3][TILE])
{
    for (int i = 0; i < 3; i++) {
        for (int x = 0; x < n; x += LANES) {
            lanes m = { 0 };

            for (int k = 0; k < TAPS; k++)
                m += load(d[i] + x + k - HALF) * GAUSS[k];
            store(out[i] + x, m);
        }
    }
}

static void gradient_row(const job *j, ring3 ring, int oldest, const float *u, const float *v,
                         int valid, float *out)
{
    for (int x = 0; x < valid; x += LANES) {
        const lanes a = load(u + x), b = load(v + x);
        const lanes_i sign = (b < 0.0f) - (b > 0.0f);   /* a true comparison is -1 */
        lanes m[3] = { { 0 } }, g;

        for (int k = 0; k < TAPS; k++) {
            const int slot = oldest + k < TAPS ? oldest + k : oldest + k - TAPS;

            for (int i = 0; i < 3; i++)
                m[i] += load(ring[slot][i] + x) * GAUSS[k];
        }
        g = __builtin_convertvector(sign, lanes) * j->l1_step
            - (m[0] + 2.0f * (a * m[1] + b * m[2])) * j->ssim_step;
        if (valid - x >= LANES)
            store(out + x, g);
        else
            memcpy(out + x, &g, (size_t)(valid - x) * sizeof *out);
    }
}

static void gradient_tile(const job *j, size_t channel, int first, int last, int x0)
{
    ring3 ring;
    const int n = min_int(TILE, (int)j->stride - 2 * LANES - x0), valid = min_int(n, j->width - x0);
    const size_t plane = channel * j->plane;
    int slot = 0;

    for (int r = first - HALF; r < last + HALF; r++) {
        const size_t at = plane + (size_t)(r < 0 ? 0 : r) * j->stride + LANES + (size_t)x0;
        const float *const d[3] = { j->d[0] + at, j->d[1] + at, j->d[2] + at };

        if (r < 0 || r >= j->height)
            memset(ring[slot], 0, sizeof ring[slot]);
        else
            filter_derivatives(d, n, ring[slot]);
        slot = slot + 1 < TAPS ? slot + 1 : 0;
        if (r >= first + HALF) {
            const int row = r - HALF;
            const size_t from = plane + (size_t)row * j->stride + LANES + (size_t)x0;
            const size_t to =
                (channel * (size_t)j->height + (size_t)row) * (size_t)j->width + (size_t)x0;

            gradient_row(j, ring, slot, j->u + from, j->v + from, valid, j->d_image + to);
        }
    }
}

static void gradient_piece(void *arg, size_t i)
{
    const job *j = arg;
    const piece p = piece_of(j, i);

    gradient_tile(j, p.channel, p.first, p.last, p.x0);
}

/* ---- the whole ---- */

ted4_loss_workspace *ted4_loss_workspace_new(void)
{
    return calloc(1, sizeof(ted4_loss_workspace));
}

void ted4_loss_workspace_free(ted4_loss_workspace *w)
{
    if (w == NULL)
        return;
    free(w->block);
    free(w->sum);
    free(w);
}

static int reserve(ted4_loss_workspace *w, size_t n_floats, size_t n_sums)
{
    if (n_floats > w->capacity) {
        free(w->block);
        w->block = aligned_alloc(64, (n_floats * sizeof(float) + 63) / 64 * 64);
        w->capacity = w->block == NULL ? 0 : n_floats;
    }
    if (n_sums > w->n_sums) {
        free(w->sum);
        w->sum = malloc(n_sums * sizeof *w->sum);
        w->n_sums = w->sum == NULL ? 0 : n_sums;
    }
    return w->capacity >= n_floats && w->n_sums >= n_sums ? 0 : -1;
}

static double sum_of(const double *x, size_t n)
{
    double sum = 0.0;

    for (size_t i = 0; i < n; i++)
        sum += x[i];
    return sum;
}

double ted4_loss(ted4_loss_workspace *w, const float *image, const uint8_t *truth, int width,
                 int height, float ssim_weight, const ted4_parallel *p, float *d_image, double *l1,
                 double *ssim)
{
    const double count = (double)CHANNELS * width * height;
    job j = {
        .image = image, .truth = truth, .d_image = d_image, .width = width, .height = height
    };
    size_t volume, pieces;

    j.n_splits = (height + SPLIT - 1) / SPLIT;
    j.n_bands = (height + BAND - 1) / BAND;
    j.n_tiles = (width + TILE - 1) / TILE;
    pieces    = CHANNELS * (size_t)j.n_bands * (size_t)j.n_tiles;
    j.stride  = (size_t)((width + LANES - 1) / LANES * LANES + 2 * LANES);
    j.plane   = j.stride * (size_t)height;
    volume    = j.plane * CHANNELS;
    if (reserve(w, volume * 5, pieces > (size_t)j.n_splits ? pieces : (size_t)j.n_splits) != 0)
        return -1.0;
    j.u = w->block;
    j.v = j.u + volume;
    for (int k = 0; k < 3; k++)
        j.d[k] = j.v + (size_t)(k + 1) * volume;
    j.sum       = w->sum;
    j.l1_step   = (float)((1.0 - (double)ssim_weight) / count);
    j.ssim_step = (float)((double)ssim_weight / count);

    ted4_parallel_for(p, (size_t)j.n_splits, split_band, &j);
    *l1 = sum_of(w->sum, (size_t)j.n_splits) / count;
    ted4_parallel_for(p, pieces, similarity_piece, &j);
    /* Of equal pictures rounding may find a little more than 1, and a negative loss means a failure. */
    *ssim = fmin(sum_of(w->sum, pieces) / count, 1.0);
    ted4_parallel_for(p, pieces, gradient_piece, &j);
    return (1.0 - (double)ssim_weight) * *l1 + (double)ssim_weight * (1.0 - *ssim);
}
