/* flicker.c - see flicker.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/flicker.h"

#include <math.h>
#include <stdlib.h>

#include "data/source.h"
#include "math/compare.h"

typedef struct {
    uint32_t camera, frame;
    double level;
} look;

static int compare_appearance(const void *x, const void *y)
{
    const look *a = x, *b = y;

    if (a->camera != b->camera)
        return a->camera < b->camera ? -1 : 1;
    return a->frame < b->frame ? -1 : a->frame > b->frame;
}

double ted4_dataset_flicker(const ted4_dataset *d)
{
    look *l = malloc((d->n_pictures + 1) * sizeof *l);
    double *off = malloc((d->n_pictures + 1) * sizeof *off), median = 0;
    size_t n = 0, m = 0;

    for (size_t i = 0; l != NULL && i < d->n_pictures; i++)
        if (!d->pictures[i].is_test)
            l[n++] = (look) { d->pictures[i].camera_id, d->pictures[i].frame, d->sources[i].level };
    if (l != NULL)
        qsort(l, n, sizeof *l, compare_appearance);
    for (size_t i = 1; off != NULL && i + 1 < n; i++)
        if (l[i - 1].camera == l[i + 1].camera && l[i - 1].frame + 1 == l[i].frame &&
            l[i].frame + 1 == l[i + 1].frame)
            off[m++] = fabs(l[i].level - 0.5 * (l[i - 1].level + l[i + 1].level));
    if (m > 0) {
        qsort(off, m, sizeof *off, ted4_compare_doubles);
        median = off[m / 2];
    }
    if (l == NULL || off == NULL)
        median = NAN;
    free(l);
    free(off);
    return median;
}
