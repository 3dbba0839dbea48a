/* loss_passes.c - the three passes of loss.c over columns, one register of columns at a time. The
 * result of a column does not depend on the width of a register. Sums over columns are kept in 16
 * lanes, with column i in lane i mod 16, and the lanes are added in order.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "loss_state.h"

#include "render/vec.h"

enum {
    TAPS = 11,
    HALF = TAPS / 2,
    TILE = TED4_LOSS_TILE,
    SIDE = TED4_LOSS_SIDE,
    CHANNELS = TED4_LOSS_CHANNELS
};

/* exp(-k^2 / (2 1.5^2)) for k = 5 .. -5, divided by the sum. */
static const float GAUSS[TAPS] = { 0.00102838008f, 0.00759875814f, 0.0360007721f, 0.10936069f,
                                   0.213005538f,   0.266011725f,   0.213005538f,  0.10936069f,
                                   0.0360007721f,  0.00759875814f, 0.00102838008f };

typedef float ring4[TAPS][4][TILE];
typedef float ring3[TAPS][3][TILE];

static inline int min_int(int a, int b)
{
    return a < b ? a : b;
}

static double add_lanes(const ted4_vf sum[TED4_VECS])
{
    float lane[TED4_LANE_GROUP];
    double total = 0.0;

    memcpy(lane, sum, sizeof lane);
    for (int l = 0; l < TED4_LANE_GROUP; l++)
        total += (double)lane[l];
    return total;
}

/* ---- pass 1: u = x + y, v = x - y, sum of |v| ---- */

TED4_INLINE void split_group(const float *x, const float *t, float *u, float *v,
                             ted4_vf sum[TED4_VECS])
{
    TED4_UNROLL
    for (int p = 0; p < TED4_VECS; p++) {
        const ted4_vf a = ted4_vf_load(x + p * TED4_VEC), b = ted4_vf_load(t + p * TED4_VEC),
                      d = a - b;

        ted4_vf_store(u + p * TED4_VEC, a + b);
        ted4_vf_store(v + p * TED4_VEC, d);
        sum[p] += ted4_vf_max(d, -d);
    }
}

/* Also writes the columns of the last group that lie outside the picture; they are 0. */
static double split_row(const float *x, const uint8_t *y, float *u, float *v, int width)
{
    const int whole = width / TED4_LANE_GROUP * TED4_LANE_GROUP;
    float t[TED4_LANE_GROUP], rest[TED4_LANE_GROUP] = { 0 };
    ted4_vf sum[TED4_VECS];

    for (int p = 0; p < TED4_VECS; p++)
        sum[p] = ted4_vf_all(0.0f);
    for (int i = 0; i < whole; i += TED4_LANE_GROUP) {
        const uint8_t *from = y + CHANNELS * i;

#pragma omp simd
        for (int j = 0; j < TED4_LANE_GROUP; j++)
            t[j] = (float)from[CHANNELS * j] * (1.0f / 255.0f);
        split_group(x + i, t, u + i, v + i, sum);
    }
    if (whole < width) {
        for (int j = 0; j < TED4_LANE_GROUP; j++)
            t[j] = whole + j < width ? (float)y[CHANNELS * (whole + j)] * (1.0f / 255.0f) : 0.0f;
        memcpy(rest, x + whole, (size_t)(width - whole) * sizeof *rest);
        split_group(rest, t, u + whole, v + whole, sum);
    }
    return add_lanes(sum);
}

static void clear_left(float *row)
{
    memset(row, 0, SIDE * sizeof *row);
}

static void clear_right(float *row, size_t stride, int width)
{
    memset(row + SIDE + width, 0, (stride - SIDE - (size_t)width) * sizeof *row);
}

void TED4_LEVELED(ted4_loss_split)(void *job, size_t i)
{
    const ted4_loss_job *j = job;
    const int first = (int)i * TED4_LOSS_SPLIT, last = min_int(first + TED4_LOSS_SPLIT, j->height);
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
                             j->truth + row * CHANNELS + c, j->u + at + SIDE, j->v + at + SIDE,
                             j->width);
        }
    }
    j->sum[i] = sum;
}

/* What job i of the second and the third pass processes. */
typedef struct {
    size_t channel;
    int first, last, x0; /* rows, first column */
    int n, valid;        /* columns: in whole lane groups, and within the picture */
} piece;

static piece piece_of(const ted4_loss_job *j, size_t i)
{
    const int tile = (int)(i % (size_t)j->n_tiles),
              band = (int)(i / (size_t)j->n_tiles % (size_t)j->n_bands);
    const int x0 = tile * TILE, n = min_int(TILE, (int)j->stride - 2 * SIDE - x0);

    return (piece) { i / (size_t)j->n_tiles / (size_t)j->n_bands,
                     band * TED4_LOSS_BAND,
                     min_int((band + 1) * TED4_LOSS_BAND, j->height),
                     x0,
                     n,
                     min_int(n, j->width - x0) };
}

/* Returns the index, in a plane, of the first column of a piece in row r. */
static size_t row_of(const ted4_loss_job *j, const piece *p, int r)
{
    return p->channel * j->plane + (size_t)r * j->stride + SIDE + (size_t)p->x0;
}

/* ---- pass 2: SSIM and its derivatives ---- */

/* u, v: a row of each plane, at its first output column. */
static void filter_squares(const float *u, const float *v, int n, float out[4][TILE])
{
    for (int x = 0; x < n; x += TED4_VEC) {
        const ted4_vf zero = ted4_vf_all(0.0f);
        ted4_vf mu = zero, mv = zero, uu = zero, vv = zero;

        TED4_UNROLL
        for (int k = 0; k < TAPS; k++) {
            const ted4_vf a = ted4_vf_load(u + x + k - HALF), b = ted4_vf_load(v + x + k - HALF);
            const ted4_vf ga = a * GAUSS[k], gb = b * GAUSS[k];

            mu += ga;
            mv += gb;
            uu = ted4_vf_fma(ga, a, uu);
            vv = ted4_vf_fma(gb, b, vv);
        }
        ted4_vf_store(out[0] + x, mu);
        ted4_vf_store(out[1] + x, mv);
        ted4_vf_store(out[2] + x, uu);
        ted4_vf_store(out[3] + x, vv);
    }
}

/* SSIM = (A1 A2) / (B1 B2), computed from the local means mu, mv and the second moments uu, vv.
 * With a = mu^2, b = mv^2, p = uu - a and q = vv - b:
 *     A1 = a - b + 2 C1,  B1 = a + b + 2 C1,  A2 = p - q + 2 C2,  B2 = p + q + 2 C2
 * p and q are variances, so that no divisor is less than 2 C2. If the picture is so bright that
 * their rounding error exceeds this, they are clamped to at least -C2 / 2, and NaN stays NaN. d:
 * derivatives with respect to the filtered planes of x: mu + mv together (du/dx = dv/dx = 1), uu,
 * vv. */
TED4_INLINE ted4_vf similarity(const ted4_vf m[4], ted4_vf d[3])
{
    const float c1 = 2.0f * TED4_SSIM_C1, c2 = 2.0f * TED4_SSIM_C2;
    const ted4_vf mu = m[0], mv = m[1], least = ted4_vf_all(-0.25f * c2);
    const ted4_vf a = mu * mu, b = mv * mv;
    const ted4_vf p = ted4_vf_max(least, m[2] - a), q = ted4_vf_max(least, m[3] - b);
    const ted4_vf b1 = a + b + c1, b2 = p + q + c2;
    const ted4_vf r = 1.0f / (b1 * b2);
    const ted4_vf r1 = r * b2, r2 = r * b1;
    const ted4_vf l = (a - b + c1) * r1, s = (p - q + c2) * r2;
    const ted4_vf k1 = 2.0f * s * r1 * r1, k2 = 2.0f * l * r2 * r2;

    d[1] = k2 * q;
    d[2] = -k2 * (p + c2);
    d[0] = 2.0f * (mu * (k1 * b - d[1]) - mv * (k1 * (a + c1) + d[2]));
    return l * s;
}

/* Returns s with all lanes from n on set to 0. */
static ted4_vf keep_first(ted4_vf s, int n)
{
    float lane[TED4_VEC];

    ted4_vf_store(lane, s);
    return ted4_vf_load_n(lane, n > 0 ? (size_t)n : 0);
}

static double similarity_row(ring4 ring, int oldest, const piece *p, float *const to[3])
{
    ted4_vf sum[TED4_VECS];

    for (int i = 0; i < TED4_VECS; i++)
        sum[i] = ted4_vf_all(0.0f);
    for (int x = 0; x < p->n; x += TED4_LANE_GROUP)
        TED4_UNROLL
    for (int i = 0; i < TED4_VECS; i++) {
        const int at = x + i * TED4_VEC;
        ted4_vf m[4], d[3], s;

        TED4_UNROLL
        for (int c = 0; c < 4; c++)
            m[c] = ted4_vf_all(0.0f);
        TED4_UNROLL
        for (int k = 0; k < TAPS; k++) {
            const int ring_row = oldest + k < TAPS ? oldest + k : oldest + k - TAPS;

            TED4_UNROLL
            for (int c = 0; c < 4; c++)
                m[c] =
                    ted4_vf_fma(ted4_vf_load(ring[ring_row][c] + at), ted4_vf_all(GAUSS[k]), m[c]);
        }
        s = similarity(m, d);
        sum[i] += p->valid - at >= TED4_VEC ? s : keep_first(s, p->valid - at);
        TED4_UNROLL
        for (int c = 0; c < 3; c++)
            ted4_vf_store(to[c] + at, d[c]);
    }
    for (int c = 0; c < 3 && p->valid < p->n; c++)
        memset(to[c] + p->valid, 0, (size_t)(p->n - p->valid) * sizeof(float));
    return add_lanes(sum);
}

static double similarity_piece(const ted4_loss_job *j, const piece *p)
{
    ring4 ring;
    int ring_row = 0;
    double sum = 0.0;

    for (int r = p->first - HALF; r < p->last + HALF; r++) {
        if (r < 0 || r >= j->height)
            memset(ring[ring_row], 0, sizeof ring[ring_row]);
        else
            filter_squares(j->u + row_of(j, p, r), j->v + row_of(j, p, r), p->n, ring[ring_row]);
        ring_row = ring_row + 1 < TAPS ? ring_row + 1 : 0;
        if (r >= p->first + HALF) {
            const size_t to = row_of(j, p, r - HALF);
            float *const d[3] = { j->d[0] + to, j->d[1] + to, j->d[2] + to };

            sum += similarity_row(ring, ring_row, p, d);
        }
    }
    return sum;
}

void TED4_LEVELED(ted4_loss_similarity)(void *job, size_t i)
{
    const ted4_loss_job *j = job;
    const piece p = piece_of(j, i);

    for (int r = p.first; r < p.last; r++)
        for (int k = 0; k < 3; k++) {
            float *row = j->d[k] + p.channel * j->plane + (size_t)r * j->stride;

            if (p.x0 == 0)
                clear_left(row);
            if (p.x0 + TILE >= j->width)
                clear_right(row, j->stride, j->width);
        }
    j->sum[i] = similarity_piece(j, &p);
}

/* ---- pass 3: dL/dx = l1_step sign(v) - ssim_step (G d0 + 2 u G d1 + 2 v G d2) ---- */

static void filter_derivatives(const float *const d[3], int n, float out[3][TILE])
{
    for (int x = 0; x < n; x += TED4_VEC)
        TED4_UNROLL
    for (int i = 0; i < 3; i++) {
        ted4_vf m = ted4_vf_all(0.0f);

        TED4_UNROLL
        for (int k = 0; k < TAPS; k++)
            m = ted4_vf_fma(ted4_vf_load(d[i] + x + k - HALF), ted4_vf_all(GAUSS[k]), m);
        ted4_vf_store(out[i] + x, m);
    }
}

static void gradient_row(const ted4_loss_job *j, ring3 ring, int oldest, size_t from, int valid,
                         float *out)
{
    for (int x = 0; x < valid; x += TED4_VEC) {
        const ted4_vf a = ted4_vf_load(j->u + from + x), b = ted4_vf_load(j->v + from + x);
        const ted4_vi sign = (b < 0.0f) - (b > 0.0f); /* a true comparison gives -1 */
        ted4_vf m[3], ssim;

        TED4_UNROLL
        for (int i = 0; i < 3; i++)
            m[i] = ted4_vf_all(0.0f);
        TED4_UNROLL
        for (int k = 0; k < TAPS; k++) {
            const int ring_row = oldest + k < TAPS ? oldest + k : oldest + k - TAPS;

            TED4_UNROLL
            for (int i = 0; i < 3; i++)
                m[i] =
                    ted4_vf_fma(ted4_vf_load(ring[ring_row][i] + x), ted4_vf_all(GAUSS[k]), m[i]);
        }
        ssim = m[0] + 2.0f * (a * m[1] + b * m[2]);
        ted4_vf_store_n(out + x,
                        __builtin_convertvector(sign, ted4_vf) * j->l1_step - ssim * j->ssim_step,
                        (size_t)(valid - x));
    }
}

void TED4_LEVELED(ted4_loss_gradient)(void *job, size_t i)
{
    const ted4_loss_job *j = job;
    const piece p = piece_of(j, i);
    ring3 ring;
    int ring_row = 0;

    for (int r = p.first - HALF; r < p.last + HALF; r++) {
        const size_t at = row_of(j, &p, r < 0 ? 0 : r);
        const float *const d[3] = { j->d[0] + at, j->d[1] + at, j->d[2] + at };

        if (r < 0 || r >= j->height)
            memset(ring[ring_row], 0, sizeof ring[ring_row]);
        else
            filter_derivatives(d, p.n, ring[ring_row]);
        ring_row = ring_row + 1 < TAPS ? ring_row + 1 : 0;
        if (r >= p.first + HALF) {
            const int row = r - HALF;
            const size_t to = (p.channel * (size_t)j->height + (size_t)row) * (size_t)j->width +
                              (size_t)p.x0;

            gradient_row(j, ring, ring_row, row_of(j, &p, row), p.valid, j->d_image + to);
        }
    }
}
