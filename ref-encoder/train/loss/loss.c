/* loss.c - L1 and SSIM with an 11 x 11 Gaussian window (sigma 1.5), and their gradient (loss.h).
 * The two pictures x and y are transformed to u = x + y and v = x - y, a rotation by 45 degrees up
 * to scale: the four filtered planes u, v, u^2, v^2 give all that SSIM needs (instead of five),
 * and v is also the L1 residual.
 *
 * There are three passes (loss_passes.c), each parallel over fixed pieces of the picture: (1) u, v
 * and L1; (2) the four filters, SSIM and its derivatives with respect to the filtered planes; (3)
 * the same filter, which is its own adjoint, over the three derivative planes. A filter runs along
 * rows into a ring of 11 rows of a tile, which stays in the L1 cache, and then down the ring.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "loss_state.h"

#include <math.h>
#include <stdlib.h>

struct ted4_loss_workspace {
    float *block;    /* owned: u, v, then three derivatives, each [3][height][stride] */
    size_t capacity; /* floats in block */
    double *sum;     /* owned: one partial sum per chunk */
    size_t n_sums;
};

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
    const double count = (double)TED4_LOSS_CHANNELS * width * height;
    ted4_loss_job j = {
        .image = image, .truth = truth, .d_image = d_image, .width = width, .height = height
    };
    size_t volume, pieces;

    j.n_splits = (height + TED4_LOSS_SPLIT - 1) / TED4_LOSS_SPLIT;
    j.n_bands = (height + TED4_LOSS_BAND - 1) / TED4_LOSS_BAND;
    j.n_tiles = (width + TED4_LOSS_TILE - 1) / TED4_LOSS_TILE;
    pieces = TED4_LOSS_CHANNELS * (size_t)j.n_bands * (size_t)j.n_tiles;
    j.stride = (size_t)((width + TED4_LOSS_SIDE - 1) / TED4_LOSS_SIDE * TED4_LOSS_SIDE +
                        2 * TED4_LOSS_SIDE);
    j.plane = j.stride * (size_t)height;
    volume = j.plane * TED4_LOSS_CHANNELS;
    if (reserve(w, volume * 5, pieces > (size_t)j.n_splits ? pieces : (size_t)j.n_splits) != 0)
        return -1.0;
    j.u = w->block;
    j.v = j.u + volume;
    for (int k = 0; k < 3; k++)
        j.d[k] = j.v + (size_t)(k + 1) * volume;
    j.sum = w->sum;
    j.l1_step = (float)((1.0 - (double)ssim_weight) / count);
    j.ssim_step = (float)((double)ssim_weight / count);

    ted4_parallel_for(p, (size_t)j.n_splits, TED4_IN_USE(ted4_loss_split), &j);
    *l1 = sum_of(w->sum, (size_t)j.n_splits) / count;
    ted4_parallel_for(p, pieces, TED4_IN_USE(ted4_loss_similarity), &j);
    /* For equal pictures, SSIM may be rounded to slightly more than 1, and a negative loss is
     * treated as a failure. */
    *ssim = fmin(sum_of(w->sum, pieces) / count, 1.0);
    ted4_parallel_for(p, pieces, TED4_IN_USE(ted4_loss_gradient), &j);
    return (1.0 - (double)ssim_weight) * *l1 + (double)ssim_weight * (1.0 - *ssim);
}
