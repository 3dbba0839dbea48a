/* view_box.c - finds where the cameras of a scene look; see source.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/source.h"

#include <math.h>
#include <stdlib.h>
#include "data/data_util.h"
#include "math/compare.h"

/* Mean squared sine between axes below which their crossing means nothing. */
#define PARALLEL 1e-4

/* Cameras that look at something miss their common point by much less than they are apart. The axes
 * of cameras that turn about themselves, at places that differ by chance, pass a common point as
 * far away as the centres are spread at right angles to them: by 0.8 of the spread. */
#define MISS 0.5

/* Length of the mean of the viewing directions below which the cameras look all around. Directions
 * that fill a half space have a mean of this length. */
#define ALL_AROUND 0.5

/* forward: unit vector, or 0 if the cameras look all around. spread: root mean square distance of
 * the cameras from centre. */
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
    for (int j = 0; j < 3; j++)
        a.forward[j] = length < ALL_AROUND ? 0 : a.forward[j] / length;
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

/* Returns whether x is what the cameras look at: it lies in front of more than half of them, and
 * their axes pass it closely. */
static int is_looked_at(const ted4_dataset *d, size_t n, const double x[3], double spread)
{
    size_t ahead = 0;
    double miss = 0;

    for (size_t i = 0; i < n; i++) {
        const ted4_camera *k = &d->pictures[i].camera;
        double at[3];
        for (int r = 0; r < 3; r++)
            at[r] = k->R[3 * r] * x[0] + k->R[3 * r + 1] * x[1] + k->R[3 * r + 2] * x[2] + k->t[r];
        ahead += at[2] > 0;
        miss += (at[0] * at[0] + at[1] * at[1]) / (double)n;
    }
    return 2 * ahead > n && sqrt(miss) < MISS * spread;
}

/* Returns the median distance from x of the places at depth s on all axes; s = 0 is the camera
 * itself. distances: room for n. */
static double median_distance(const ted4_dataset *d, size_t n, double s, const double x[3],
                              double *distances)
{
    double c[3];

    for (size_t i = 0; i < n; i++) {
        const ted4_camera *k = &d->pictures[i].camera;
        ted4_pose_centre(k->R, k->t, c);
        for (int j = 0; j < 3; j++)
            c[j] += s * k->R[6 + j];
        distances[i] = ted4_distance3(c, x);
    }
    qsort(distances, n, sizeof *distances, ted4_compare_doubles);
    return distances[n / 2];
}

int ted4_view_box(const ted4_dataset *d, double centre[3], double *half)
{
    const size_t n = n_train(d);
    const mean_camera mean = average(d, n);
    const double depth = fmax(mean.spread, 1);
    double *distances = malloc(n * sizeof *distances), far = 0;

    if (distances == NULL)
        return -1;
    if (crossing(d, n, centre) != 0 || !is_looked_at(d, n, centre, mean.spread)) {
        for (int j = 0; j < 3; j++)
            centre[j] = mean.centre[j] + depth * mean.forward[j];
        far = median_distance(d, n, depth, centre, distances);
    }
    far = fmax(far, median_distance(d, n, 0, centre, distances));
    *half = TED4_VIEW_BOX_HALF_SIDE * far;
    free(distances);
    return 0;
}
