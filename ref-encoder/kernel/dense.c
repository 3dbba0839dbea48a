/* dense.c - the three products of a dense layer, register-blocked for 32 vector registers of 16
 * floats. Forward and its transpose share one kernel: a panel of up to 12 outputs times 32 lanes
 * lives in registers while the inputs stream by, one broadcast weight for two FMAs. The weight
 * gradient is a dot product over lanes: tiles of 4 x 4, folded by a shuffle tree. spec 7.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/dense.h"

#include <stdlib.h>
#include <string.h>

enum { VEC = 16, PANEL = 12, TILE = 4 };

typedef float vec __attribute__((vector_size(64), may_alias));
typedef int   ivec __attribute__((vector_size(64), may_alias));

#define INLINE static inline __attribute__((always_inline))
#ifdef __clang__
#define UNROLL _Pragma("clang loop unroll(full)")
#else
#define UNROLL _Pragma("GCC unroll 16")
#endif

/* Panels have nearly equal widths, so that none is too narrow to hide the latency of its FMAs. */
static int n_panels(int out)
{
    return (out + PANEL - 1) / PANEL;
}

static int panel_width(int out, int panel)
{
    const int n = n_panels(out);

    return out / n + (panel < out % n);
}

int ted4_dense_init(ted4_dense *d, int in, int out)
{
    const size_t n_in = (size_t)in, n_out = (size_t)out;

    d->in = in;
    d->out = out;
    d->fwd = malloc(n_out * (n_in + 1) * sizeof *d->fwd);
    d->bwd = malloc(n_in * (n_out + 1) * sizeof *d->bwd);
    if (d->fwd == NULL || d->bwd == NULL) {
        ted4_dense_finish(d);
        return -1;
    }
    return 0;
}

void ted4_dense_finish(ted4_dense *d)
{
    free(d->fwd);
    free(d->bwd);
    d->fwd = NULL;
    d->bwd = NULL;
}

/* Panel by panel: the biases of its outputs, then for each input the weights of its outputs.
 * step_out and step_in say how w lies; b is NULL for zeros. */
static void pack(int in, int out, const float *w, size_t step_out,
                 size_t step_in, const float *b, float *to)
{
    for (int p = 0, o = 0; p < n_panels(out); p++) {
        const int width = panel_width(out, p);

        for (int j = 0; j < width; j++)
            *to++ = b != NULL ? b[o + j] : 0.0f;
        for (int i = 0; i < in; i++)
            for (int j = 0; j < width; j++)
                *to++ = w[(size_t)(o + j) * step_out + (size_t)i * step_in];
        o += width;
    }
}

void ted4_dense_pack(ted4_dense *d, const float *w, const float *b)
{
    pack(d->in, d->out, w, (size_t)d->in, 1, b, d->fwd);
    pack(d->out, d->in, w, 1, (size_t)d->in, NULL, d->bwd);
}

typedef enum { SET, SET_RELU, ADD } store_mode;

INLINE void store(vec *y, const vec *acc, store_mode mode)
{
    if (mode == ADD)
        *y += *acc;
    else if (mode == SET_RELU)
        *y = (vec)((ivec)*acc & (*acc > 0.0f));
    else
        *y = *acc;
}

INLINE void panel_n(const int n, int in, const float *w, const float *x,
                    float *y, store_mode mode)
{
    vec acc[PANEL][2];

    UNROLL
    for (int j = 0; j < n; j++)
        acc[j][0] = acc[j][1] = (vec){0} + w[j];
    w += n;
    for (int i = 0; i < in; i++, w += n) {
        const vec x0 = *(const vec *)(x + (size_t)i * TED4_LANES);
        const vec x1 = *(const vec *)(x + (size_t)i * TED4_LANES + VEC);

        UNROLL
        for (int j = 0; j < n; j++) {
            acc[j][0] += w[j] * x0;
            acc[j][1] += w[j] * x1;
        }
    }
    UNROLL
    for (int j = 0; j < n; j++) {
        store((vec *)(y + j * TED4_LANES), &acc[j][0], mode);
        store((vec *)(y + j * TED4_LANES + VEC), &acc[j][1], mode);
    }
}

static void panel(int n, int in, const float *w, const float *x, float *y,
                  store_mode mode)
{
    switch (n) {
    case 1: panel_n(1, in, w, x, y, mode); break;
    case 2: panel_n(2, in, w, x, y, mode); break;
    case 3: panel_n(3, in, w, x, y, mode); break;
    case 4: panel_n(4, in, w, x, y, mode); break;
    case 5: panel_n(5, in, w, x, y, mode); break;
    case 6: panel_n(6, in, w, x, y, mode); break;
    case 7: panel_n(7, in, w, x, y, mode); break;
    case 8: panel_n(8, in, w, x, y, mode); break;
    case 9: panel_n(9, in, w, x, y, mode); break;
    case 10: panel_n(10, in, w, x, y, mode); break;
    case 11: panel_n(11, in, w, x, y, mode); break;
    default: panel_n(PANEL, in, w, x, y, mode); break;
    }
}

static void product(int in, int out, const float *w, const float *x, float *y,
                    store_mode mode)
{
    for (int p = 0; p < n_panels(out); p++) {
        const int width = panel_width(out, p);

        panel(width, in, w, x, y, mode);
        w += (size_t)width * ((size_t)in + 1);
        y += (size_t)width * TED4_LANES;
    }
}

void ted4_dense_forward(const ted4_dense *d, const float *x, float *y, int relu)
{
    product(d->in, d->out, d->fwd, x, y, relu ? SET_RELU : SET);
}

void ted4_dense_backward_x(const ted4_dense *d, const float *dy, float *dx,
                           int add)
{
    product(d->out, d->in, d->bwd, dy, dx, add ? ADD : SET);
}

/* Sums neighbouring pairs of a and b: the first 8 elements of the result come from a, the others
 * from b. */
INLINE void fold(vec *to, const vec *a, const vec *b)
{
    *to = __builtin_shufflevector(*a, *b, 0, 2, 4, 6, 8, 10, 12, 14,
                                  16, 18, 20, 22, 24, 26, 28, 30)
        + __builtin_shufflevector(*a, *b, 1, 3, 5, 7, 9, 11, 13, 15,
                                  17, 19, 21, 23, 25, 27, 29, 31);
}

/* v[0] = the 16 sums of the elements of v[0] .. v[15]. */
INLINE void fold_16(vec *v)
{
    UNROLL
    for (int i = 0; i < 8; i++)
        fold(&v[i], &v[2 * i], &v[2 * i + 1]);
    UNROLL
    for (int i = 0; i < 4; i++)
        fold(&v[i], &v[2 * i], &v[2 * i + 1]);
    fold(&v[0], &v[0], &v[1]);
    fold(&v[1], &v[2], &v[3]);
    fold(&v[0], &v[0], &v[1]);
}

static int last_below(int i, int n)
{
    return i < n ? i : n - 1;
}

/* One operand of all the tiles: n rows in each of n_blocks blocks. */
typedef struct {
    const float *base;
    size_t       stride;
    int          n;
} operand;

typedef struct {
    const float *row[TILE];
} tile_rows;

/* Rows first .. first + 3; beyond the end the last one is repeated and its sums are not used. */
INLINE tile_rows rows(const operand *m, int first)
{
    tile_rows r;

    for (int a = 0; a < TILE; a++)
        r.row[a] = m->base + (size_t)last_below(first + a, m->n) * TED4_LANES;
    return r;
}

/* Keeps gcc from folding a load into each FMA that uses it: the load ports are the bottleneck. */
INLINE void keep_in_register(vec *v)
{
#ifdef __AVX512F__
    __asm__("" : "+v"(*v));
#else
    (void)v;
#endif
}

/* sum[4 a + b] = dot product of row a of dy and row b of x over all blocks. */
INLINE void tile(const tile_rows *x, size_t x_stride, const tile_rows *dy,
                 size_t dy_stride, size_t n_blocks, vec *sum)
{
    vec acc[TILE * TILE] = {{0}};

    for (size_t k = 0; k < n_blocks; k++) {
        const size_t kx = k * x_stride, ky = k * dy_stride;

        UNROLL
        for (int h = 0; h < TED4_LANES; h += VEC) {
            vec xv[TILE], yv[TILE];

            UNROLL
            for (int a = 0; a < TILE; a++) {
                xv[a] = *(const vec *)(x->row[a] + kx + h);
                keep_in_register(&xv[a]);
            }
            UNROLL
            for (int a = 0; a < TILE; a++) {
                yv[a] = *(const vec *)(dy->row[a] + ky + h);
                keep_in_register(&yv[a]);
            }
            UNROLL
            for (int a = 0; a < TILE * TILE; a++)
                acc[a] += yv[a / TILE] * xv[a % TILE];
        }
    }
    fold_16(acc);
    *sum = acc[0];
}

/* Adds a tile of sums to dw, which has n_x columns; n_rows and n_cols of it exist. */
INLINE void add_tile(float *dw, int n_x, int n_rows, int n_cols,
                     const vec *sum)
{
    const vec v = *sum;

    if (n_rows >= TILE && n_cols >= TILE) {
        UNROLL
        for (int a = 0; a < TILE; a++, dw += n_x)
            for (int b = 0; b < TILE; b++)
                dw[b] += v[a * TILE + b];
        return;
    }
    for (int a = 0; a < TILE && a < n_rows; a++, dw += n_x)
        for (int b = 0; b < TILE && b < n_cols; b++)
            dw[b] += v[a * TILE + b];
}

/* Groups of rows of x stay in the first-level cache while dy streams by. */
enum { GROUP = 16 };

static void weight_sums(const operand *x, const operand *dy, size_t n_blocks,
                        float *dw)
{
    for (int group = 0; group < x->n; group += GROUP)
        for (int o = 0; o < dy->n; o += TILE) {
            const tile_rows dy_rows = rows(dy, o);

            for (int i = group; i < group + GROUP && i < x->n; i += TILE) {
                const tile_rows x_rows = rows(x, i);
                vec sum;

                tile(&x_rows, x->stride, &dy_rows, dy->stride, n_blocks, &sum);
                add_tile(dw + (size_t)o * (size_t)x->n + (size_t)i, x->n,
                         dy->n - o, x->n - i, &sum);
            }
        }
}

static void bias_sums(int out, const float *dy, size_t dy_stride,
                      size_t n_blocks, float *db)
{
    for (int o = 0; o < out; o += VEC) {
        const int n = out - o < VEC ? out - o : VEC;
        vec acc[VEC] = {{0}};

        for (size_t k = 0; k < n_blocks; k++)
            for (int j = 0; j < n; j++) {
                const float *row = dy + k * dy_stride
                                 + (size_t)(o + j) * TED4_LANES;

                acc[j] += *(const vec *)row + *(const vec *)(row + VEC);
            }
        fold_16(acc);
        for (int j = 0; j < n; j++)
            db[o + j] += acc[0][j];
    }
}

void ted4_dense_backward_w(int in, int out, const float *x, size_t x_stride,
                           const float *dy, size_t dy_stride, size_t n_blocks,
                           float *dw, float *db)
{
    const operand xo = { x, x_stride, in }, yo = { dy, dy_stride, out };

    weight_sums(&xo, &yo, n_blocks, dw);
    bias_sums(out, dy, dy_stride, n_blocks, db);
}
