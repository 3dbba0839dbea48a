/* out_splat.c - the format ".splat" with 32 bytes per Gaussian. The largest and most opaque
 * Gaussians come first, so that a partial download shows something; in a sequence, all files have
 * the order of the scene.
 * A record holds position and linear scale as binary32, then r g b a and the rotation w x y z (128
 * + 128 q) as bytes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "export.h"

#include <math.h>
#include <stdlib.h>

#include "base/bytes.h"
#include "sh.h"

enum { SPLAT_SIZE = 32 };

typedef struct {
    double weight;
    size_t index;
} splat_order;

static int by_weight(const void *a, const void *b)
{
    const splat_order *const p = a, *const q = b;

    if (p->weight != q->weight)
        return p->weight > q->weight ? -1 : 1;
    return p->index < q->index ? -1 : 1;
}

static uint8_t splat_byte(double v)
{
    return (uint8_t)fmin(fmax(floor(v + 0.5), 0.0), 255.0);
}

static void fill_splat(uint8_t out[SPLAT_SIZE], const ted4_frame *x, size_t i)
{
    const size_t n_coefs = (size_t)ted4_sh_count(x->sh_degree);

    for (int c = 0; c < 3; c++) {
        ted4_store32(out + 4 * c, ted4_float_bits(x->mean[c][i]));
        ted4_store32(out + 12 + 4 * c, ted4_float_bits(x->scale[c][i]));
        out[24 + c] =
            splat_byte(255.0 * (0.5 + TED4_SH_C0 * (double)x->sh[(i * 3 + (size_t)c) * n_coefs]));
    }
    out[27] = splat_byte(255.0 * (double)x->opacity[i]);
    for (int c = 0; c < 4; c++)
        out[28 + c] = splat_byte(128.0 * (double)x->rot[c][i] + 128.0);
}

static int write_splat(FILE *f, const ted4_frame *x)
{
    splat_order *const order = malloc((x->n + 1) * sizeof *order);
    int r = 0;

    if (order == NULL)
        return -1;
    for (size_t i = 0; i < x->n; i++)
        order[i] = (splat_order) {
            (double)x->scale[0][i] * x->scale[1][i] * x->scale[2][i] * x->opacity[i], i
        };
    if (!x->in_order)
        qsort(order, x->n, sizeof *order, by_weight);
    for (size_t i = 0; i < x->n && r == 0; i++) {
        uint8_t bytes[SPLAT_SIZE];

        fill_splat(bytes, x, order[i].index);
        r = fwrite(bytes, sizeof bytes, 1, f) == 1 ? 0 : -1;
    }
    free(order);
    return r;
}

const ted4_format ted4_format_splat = {
    ".splat", "32 bytes per Gaussian, one colour; a single file has the largest first", 0,
    write_splat
};
