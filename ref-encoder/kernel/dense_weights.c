/* dense_weights.c - the weight gradient of a dense layer (dense.h): dot products over lanes, for
 * one tile of outputs times inputs at a time, block after block. Each dot product has 16 partial
 * sums, one per lane of a lane group. At every level alike, neighbouring sums are added in pairs,
 * then pairs of these, and so on.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/dense.h"
#include "render/vec.h"

/* The outputs and inputs of a tile. The tile's sums, its inputs and the gradient of one output fit
 * in 32 registers, or in 16. */
#if TED4_VEC_BYTES == 64 || defined(__aarch64__)
enum { TILE_OUT = 4, TILE_IN = 4 };
#else
enum { TILE_OUT = 2, TILE_IN = 4 };
#endif

typedef float four __attribute__((vector_size(16)));

/* Adds neighbouring lanes. Each four lanes of the result are two sums of a, then two of b. */
TED4_INLINE ted4_vf pairs(ted4_vf a, ted4_vf b)
{
#if TED4_VEC_BYTES == 64
    return TED4_SHUFFLE(a, b, 0, 2, 16, 18, 4, 6, 20, 22, 8, 10, 24, 26, 12, 14, 28, 30) +
           TED4_SHUFFLE(a, b, 1, 3, 17, 19, 5, 7, 21, 23, 9, 11, 25, 27, 13, 15, 29, 31);
#elif TED4_VEC_BYTES == 32
    return TED4_SHUFFLE(a, b, 0, 2, 8, 10, 4, 6, 12, 14) +
           TED4_SHUFFLE(a, b, 1, 3, 9, 11, 5, 7, 13, 15);
#else
    return TED4_SHUFFLE(a, b, 0, 2, 4, 6) + TED4_SHUFFLE(a, b, 1, 3, 5, 7);
#endif
}

/* Returns the sums over the lanes of v[0] .. v[3]: each four lanes are summed first, then the
 * results are added in pairs. */
TED4_INLINE four fold(const ted4_vf v[4])
{
    const ted4_vf s = pairs(pairs(v[0], v[1]), pairs(v[2], v[3]));

#if TED4_VEC_BYTES == 64
    return (TED4_SHUFFLE(s, s, 0, 1, 2, 3) + TED4_SHUFFLE(s, s, 4, 5, 6, 7)) +
           (TED4_SHUFFLE(s, s, 8, 9, 10, 11) + TED4_SHUFFLE(s, s, 12, 13, 14, 15));
#elif TED4_VEC_BYTES == 32
    return TED4_SHUFFLE(s, s, 0, 1, 2, 3) + TED4_SHUFFLE(s, s, 4, 5, 6, 7);
#else
    return s;
#endif
}

/* Adds the sums of the parts of a lane group. */
TED4_INLINE four add_parts(const four part[TED4_VECS])
{
#if TED4_VEC_BYTES == 64
    return part[0];
#elif TED4_VEC_BYTES == 32
    return part[0] + part[1];
#else
    return (part[0] + part[1]) + (part[2] + part[3]);
#endif
}

static int last_below(int i, int n)
{
    return i < n ? i : n - 1;
}

/* One operand of all tiles: it has n rows in each of n_blocks blocks. */
typedef struct {
    const float *base;
    size_t stride;
    int n;
} operand;

/* Points row[] to rows first .. first + n - 1. Beyond the end, the last row is repeated; its sums
 * are not used. */
TED4_INLINE void rows(const operand *m, int first, int n, const float **row)
{
    for (int a = 0; a < n; a++)
        row[a] = m->base + (size_t)last_below(first + a, m->n) * TED4_LANES;
}

/* Prevents gcc from folding the load into each product that uses it, since the load ports are the
 * bottleneck. */
TED4_INLINE void keep_in_register(ted4_vf *v)
{
#if TED4_VEC_BYTES >= 32
    __asm__("" : "+v"(*v));
#else
    (void)v;
#endif
}

/* Sums the products of part number part of each lane group of the rows, over groups and blocks. */
TED4_INLINE void tile_part(const float *const *x, size_t x_stride, const float *const *dy,
                           size_t dy_stride, size_t n_blocks, int part, ted4_vf *acc)
{
    TED4_UNROLL
    for (int i = 0; i < TILE_OUT * TILE_IN; i++)
        acc[i] = (ted4_vf) { 0 };
    for (size_t k = 0; k < n_blocks; k++) {
        const size_t kx = k * x_stride, ky = k * dy_stride;

        TED4_UNROLL
        for (int h = part * TED4_VEC; h < TED4_LANES; h += TED4_LANE_GROUP) {
            ted4_vf xv[TILE_IN];

            TED4_UNROLL
            for (int b = 0; b < TILE_IN; b++) {
                xv[b] = ted4_vf_load(x[b] + kx + h);
                keep_in_register(&xv[b]);
            }
            TED4_UNROLL
            for (int a = 0; a < TILE_OUT; a++) {
                const ted4_vf yv = ted4_vf_load(dy[a] + ky + h);

                TED4_UNROLL
                for (int b = 0; b < TILE_IN; b++)
                    acc[a * TILE_IN + b] = ted4_vf_fma(yv, xv[b], acc[a * TILE_IN + b]);
            }
        }
    }
}

/* Sets sum[TILE_IN a + b] to the dot product of row a of dy and row b of x, over all blocks. */
TED4_INLINE void tile(const float *const *x, size_t x_stride, const float *const *dy,
                      size_t dy_stride, size_t n_blocks, float *sum)
{
    four part[TILE_OUT * TILE_IN / 4][TED4_VECS];

    TED4_UNROLL
    for (int p = 0; p < TED4_VECS; p++) {
        ted4_vf acc[TILE_OUT * TILE_IN];

        tile_part(x, x_stride, dy, dy_stride, n_blocks, p, acc);
        TED4_UNROLL
        for (int i = 0; i < TILE_OUT * TILE_IN / 4; i++)
            part[i][p] = fold(acc + 4 * i);
    }
    TED4_UNROLL
    for (int i = 0; i < TILE_OUT * TILE_IN / 4; i++) {
        const four s = add_parts(part[i]);

        memcpy(sum + 4 * i, &s, sizeof s);
    }
}

/* Adds a tile of sums to dw, which has n_x columns. From dw on, only n_rows rows and n_cols columns
 * exist. */
TED4_INLINE void add_tile(float *dw, int n_x, int n_rows, int n_cols, const float *sum)
{
    if (n_rows >= TILE_OUT && n_cols >= TILE_IN) {
        TED4_UNROLL
        for (int a = 0; a < TILE_OUT; a++, dw += n_x)
            for (int b = 0; b < TILE_IN; b++)
                dw[b] += sum[a * TILE_IN + b];
        return;
    }
    for (int a = 0; a < TILE_OUT && a < n_rows; a++, dw += n_x)
        for (int b = 0; b < TILE_IN && b < n_cols; b++)
            dw[b] += sum[a * TILE_IN + b];
}

/* A group of rows of x, which consists of whole tiles, stays in the first-level cache while dy
 * streams by. */
enum { GROUP = 16 / TILE_IN * TILE_IN };

static void weight_sums(const operand *x, const operand *dy, size_t n_blocks, float *dw)
{
    for (int group = 0; group < x->n; group += GROUP)
        for (int o = 0; o < dy->n; o += TILE_OUT) {
            const float *dy_row[TILE_OUT];

            rows(dy, o, TILE_OUT, dy_row);
            for (int i = group; i < group + GROUP && i < x->n; i += TILE_IN) {
                const float *x_row[TILE_IN];
                float sum[TILE_OUT * TILE_IN];

                rows(x, i, TILE_IN, x_row);
                tile(x_row, x->stride, dy_row, dy->stride, n_blocks, sum);
                add_tile(dw + (size_t)o * (size_t)x->n + (size_t)i, x->n, dy->n - o, x->n - i, sum);
            }
        }
}

static void bias_sums(const operand *dy, size_t n_blocks, float *db)
{
    for (int o = 0; o < dy->n; o += 4) {
        const float *row[4];
        four part[TED4_VECS], sum;

        rows(dy, o, 4, row);
        for (int p = 0; p < TED4_VECS; p++) {
            ted4_vf acc[4] = { { 0 } };

            for (size_t k = 0; k < n_blocks; k++)
                for (int j = 0; j < 4; j++) {
                    const float *at = row[j] + k * dy->stride + p * TED4_VEC;

                    acc[j] += ted4_vf_load(at) + ted4_vf_load(at + TED4_LANE_GROUP);
                }
            part[p] = fold(acc);
        }
        sum = add_parts(part);
        for (int j = 0; j < 4 && o + j < dy->n; j++)
            db[o + j] += sum[j];
    }
}

void TED4_LEVELED(ted4_dense_backward_w)(int in, int out, const float *x, size_t x_stride,
                                         const float *dy, size_t dy_stride, size_t n_blocks,
                                         float *dw, float *db)
{
    const operand xo = { x, x_stride, in }, yo = { dy, dy_stride, out };

    weight_sums(&xo, &yo, n_blocks, dw);
    bias_sums(&yo, n_blocks, db);
}
