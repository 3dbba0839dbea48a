/* view_box.c - finds where the cameras of a scene look; see source.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/source.h"

#include <math.h>
#include <stdlib.h>
#include "data/data_util.h"
#include "math/compare.h"

/* Mean squared sine between axes below which their crossing means nothing. */
#define PARALLEL 1e-4

typedef struct {
    double centre[3], forward[3], spread;
} mean_camera;

/* Counts the pictures for training, which precede the held-out ones; only they are used here. */
static size_t n_train(const ted4_dataset *d)
{
    size_t n = 0;

    while (n < d->n_pictures && !d->pictures[n].is_test)
        n++;
    return n;
}

static mean_camera average(const ted4_dataset *d, size_t n_pictures)
{
    mean_camera a = { { 0, 0, 0 }, { 0, 0, 0 }, 0 };
    const double n = (double)n_pictures;
    double c[3], length = 0;

    for (size_t i = 0; i < n_pictures; i++) {
        const ted4_camera *k = &d->pictures[i].camera;
        ted4_pose_centre(k->R, k->t, c);
        for (int j = 0; j < 3; j++) {
            a.centre[j] += c[j] / n;
            a.forward[j] += k->R[6 + j] / n;
        }
    }
    for (size_t i = 0; i < n_pictures; i++) {
        const ted4_camera *k = &d->pictures[i].camera;
        ted4_pose_centre(k->R, k->t, c);
        for (int j = 0; j < 3; j++)
            a.spread += (c[j] - a.centre[j]) * (c[j] - a.centre[j]) / n;
    }
    a.spread = sqrt(a.spread);
    for (int j = 0; j < 3; j++)
        length += a.forward[j] * a.forward[j];
    length = sqrt(length);
    for (int j = 0; j < 3 && length > 0; j++)
        a.forward[j] /= length;
    return a;
}

/* Gives the least-squares solution of sum of (I - f f^T) x = sum of (I - f f^T) c over the axes c +
 * s f. Returns 0, or -1 if the axes do not determine x. */
static int crossing(const ted4_dataset *d, size_t n, double x[3])
{
    double A[9] = { 0 }, b[3] = { 0, 0, 0 }, c[3];

    for (size_t i = 0; i < n; i++) {
        const ted4_camera *k = &d->pictures[i].camera;
        const double *f = k->R + 6;
        ted4_pose_centre(k->R, k->t, c);
        for (int r = 0; r < 3; r++)
            for (int s = 0; s < 3; s++) {
                const double v = ((r == s) - f[r] * f[s]) / (double)n;
                A[3 * r + s] += v;
                b[r] += v * c[s];
            }
    }
    /* The determinant is the product of three eigenvalues whose sum is 2. The smallest is the mean
     * squared sine of the angles between the axes and their mean. */
    if (ted4_det3(A) < PARALLEL)
        return -1;
    return ted4_solve3(A, b, x);
}

static int is_ahead(const ted4_dataset *d, size_t n, const double x[3])
{
    size_t ahead = 0;

    for (size_t i = 0; i < n; i++) {
        const ted4_camera *k = &d->pictures[i].camera;
        ahead += k->R[6] * x[0] + k->R[7] * x[1] + k->R[8] * x[2] + k->t[2] > 0;
    }
    return 2 * ahead > n;
}

int ted4_view_box(const ted4_dataset *d, double centre[3], double *half)
{
    const size_t n = n_train(d);
    const mean_camera mean = average(d, n);
    double *distances = malloc(n * sizeof *distances), c[3];

    if (distances == NULL)
        return -1;
    if (crossing(d, n, centre) != 0 || !is_ahead(d, n, centre))
        for (int j = 0; j < 3; j++)
            centre[j] = mean.centre[j] + fmax(mean.spread, 1) * mean.forward[j];
    for (size_t i = 0; i < n; i++) {
        const ted4_camera *k = &d->pictures[i].camera;
        ted4_pose_centre(k->R, k->t, c);
        distances[i] = ted4_distance3(c, centre);
    }
    qsort(distances, n, sizeof *distances, ted4_compare_doubles);
    *half = TED4_VIEW_BOX_HALF_SIDE * distances[n / 2];
    free(distances);
    return 0;
}
