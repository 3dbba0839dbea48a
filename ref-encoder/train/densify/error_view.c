/* error_view.c - see error_view.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "error_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/compare.h"
#include "train/state/picture.h"
#include "view_geometry.h"

/* The tested depths begin and end at these multiples of the range of depths that contains 96 % of
 * the anchors in a view. */
#define NEARER   0.5f
#define FARTHER  1.2f
#define OUTLIERS 0.02f

int ted4_view_spacing(int width)
{
    return (int)fmaxf(1.0f, roundf(TED4_VIEW_SPACING * (float)width));
}

/* Sets the range of depths from the anchors in the view. Returns 0, or -1 if memory ran out. */
static int depth_range(const ted4_trainer *t, ted4_error_view *e)
{
    float *z = malloc((t->anchors.n + 1) * sizeof *z);
    size_t n = 0;

    if (z == NULL)
        return -1;
    for (size_t i = 0; i < t->anchors.n; i++) {
        float p[3];
        size_t pixel;

        for (int k = 0; k < 3; k++)
            p[k] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, k);
        if (ted4_view_pixel(&e->view, p, &pixel, &z[n]))
            n++;
    }
    qsort(z, n, sizeof *z, ted4_compare_floats);

    const size_t out = (size_t)(OUTLIERS * (float)n);

    e->nearest = n > 0 ? fmaxf(NEARER * z[out], e->view.near_z) : e->view.near_z;
    e->farthest = n > 0 ? fmaxf(FARTHER * z[n - 1 - out], 2.0f * e->nearest) : 2.0f * e->nearest;
    free(z);
    return 0;
}

int ted4_error_view_open(ted4_trainer *t, size_t item, ted4_error_view *e)
{
    const ted4_picture *pic = &t->data->pictures[item];
    const uint8_t *truth = ted4_trainer_seen(t, item);

    if (truth == NULL)
        return -1;
    if (ted4_trainer_draw(t, pic, &e->view, e->centre) != 0) {
        ted4_dataset_release(t->data, item);
        return -1;
    }
    const size_t n = (size_t)e->view.width * (size_t)e->view.height;

    e->rgb = malloc(3 * n);
    e->error = malloc(n);
    for (size_t i = 0; e->rgb != NULL && e->error != NULL && i < n; i++) {
        float sum = 0;

        for (size_t k = 0; k < 3; k++) {
            const float x = fminf(fmaxf(t->work.image[k * n + i], 0.0f), 1.0f);

            sum += fabsf(255.0f * x - (float)truth[3 * i + k]);
        }
        e->error[i] = (uint8_t)(sum / 3.0f);
    }
    if (e->rgb != NULL)
        memcpy(e->rgb, truth, 3 * n);
    ted4_dataset_release(t->data, item);
    if (e->rgb == NULL || e->error == NULL || depth_range(t, e) != 0)
        return ted4_trainer_fail(t, "no memory to look for what is missing");
    return 0;
}

void ted4_error_view_close(ted4_error_view *e)
{
    free(e->rgb);
    free(e->error);
    memset(e, 0, sizeof *e);
}
