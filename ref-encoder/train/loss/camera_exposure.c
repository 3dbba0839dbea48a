/* camera_exposure.c - see camera_exposure.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "camera_exposure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "middle.h"

static float *values_of(const ted4_exposure *e, uint32_t camera)
{
    return e->value + (size_t)camera * e->n_knots * 3;
}

/* Returns how many knots the training pictures of the corrected cameras are worth. */
static size_t count_knots(const ted4_dataset *d, const uint8_t *corrected)
{
    size_t pictures = 0, cameras = 0, n;

    for (size_t i = 0; i < d->n_pictures; i++)
        pictures += !d->pictures[i].is_test && corrected[d->pictures[i].camera_id];
    for (size_t k = 0; k < d->n_cameras; k++)
        cameras += corrected[k];
    n = cameras > 0 && d->n_frames > 1 ? 1 + pictures / cameras / TED4_EXPOSURE_PICTURES : 0;
    return n < 2 ? 0 : n > TED4_EXPOSURE_KNOTS ? TED4_EXPOSURE_KNOTS : n;
}

static void look_for_pictures(ted4_exposure *e, const ted4_dataset *d, const uint8_t *corrected)
{
    for (size_t i = 0; i < d->n_pictures; i++) {
        const ted4_picture *p = &d->pictures[i];

        for (size_t k = 0; k < e->n_knots && !p->is_test && corrected[p->camera_id]; k++)
            if (ted4_exposure_weight(e, k, p->frame) > 0)
                e->near[p->camera_id * e->n_knots + k] = 1;
    }
}

int ted4_exposure_init(ted4_exposure *e, const ted4_dataset *d, const uint8_t *corrected)
{
    const size_t n_knots = count_knots(d, corrected), n = d->n_cameras * n_knots;

    memset(e, 0, sizeof *e);
    if (n == 0)
        return 0;
    e->n_cameras = d->n_cameras;
    e->n_knots = n_knots;
    e->knots_per_time = (double)(n_knots - 1) / (d->n_frames - 1);
    e->near = calloc(n, sizeof *e->near);
    e->value = calloc(9 * n, sizeof *e->value);
    e->gradient = calloc(3 * n_knots, sizeof *e->gradient);
    e->steps = calloc(e->n_cameras, sizeof *e->steps);
    e->sorted = malloc(e->n_cameras * sizeof *e->sorted);
    if (e->near == NULL || e->value == NULL || e->gradient == NULL || e->steps == NULL ||
        e->sorted == NULL)
        return -1;
    e->m = e->value + 3 * n;
    e->v = e->m + 3 * n;
    look_for_pictures(e, d, corrected);
    return 0;
}

void ted4_exposure_finish(ted4_exposure *e)
{
    free(e->near);
    free(e->value);
    free(e->gradient);
    free(e->steps);
    free(e->sorted);
    memset(e, 0, sizeof *e);
}

double ted4_exposure_weight(const ted4_exposure *e, size_t knot, uint32_t frame)
{
    return fmax(0, 1 - fabs((double)frame * e->knots_per_time - (double)knot));
}

void ted4_exposure_at(const ted4_exposure *e, uint32_t camera, uint32_t frame, float gain[3])
{
    const float *x = values_of(e, camera);

    for (size_t c = 0; c < 3; c++) {
        double sum = 0;

        for (size_t k = 0; k < e->n_knots; k++)
            sum += ted4_exposure_weight(e, k, frame) * (double)x[3 * k + c];
        gain[c] = (float)sum;
    }
}

void ted4_exposure_backward(ted4_exposure *e, uint32_t camera, uint32_t frame, const float *d_gain,
                            double smoothness, double size)
{
    const float *x = values_of(e, camera);
    float *g = e->gradient;

    for (size_t i = 0; i < 3 * e->n_knots; i++)
        g[i] = (float)(ted4_exposure_weight(e, i / 3, frame) * (double)d_gain[i % 3] +
                       2 * size * (double)x[i]);
    for (size_t i = 3; i + 3 < 3 * e->n_knots; i++) {
        /* L += smoothness bend^2 */
        const double bend = (double)x[i - 3] - 2 * (double)x[i] + (double)x[i + 3];

        g[i - 3] += (float)(2 * smoothness * bend);
        g[i] -= (float)(4 * smoothness * bend);
        g[i + 3] += (float)(2 * smoothness * bend);
    }
}

void ted4_exposure_centre(ted4_exposure *e)
{
    for (size_t i = 0; i < 3 * e->n_knots; i++) {
        size_t n = 0;
        float middle;

        for (uint32_t k = 0; k < e->n_cameras; k++)
            if (e->near[k * e->n_knots + i / 3])
                e->sorted[n++] = values_of(e, k)[i];
        if (n == 0)
            continue;
        middle = (float)ted4_middle(e->sorted, n);
        for (uint32_t k = 0; k < e->n_cameras; k++)
            if (e->near[k * e->n_knots + i / 3])
                values_of(e, k)[i] -= middle;
    }
}

int ted4_exposure_finite(const ted4_exposure *e)
{
    for (size_t i = 0; i < 3 * e->n_cameras * e->n_knots; i++)
        if (!isfinite(e->value[i]))
            return 0;
    return 1;
}
