/* frame_times.c - maps the times of pictures, in any unit, to frame indices on a uniform grid
 * (spec: frame j of F is t = j / (F - 1)).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <math.h>
#include <stdlib.h>
#include "data/data_util.h"
#include "math/compare.h"

/* Times are scaled so that the first is 0 and the last is 1. */
#define SAME_TIME   2e-6 /* two roundings of one time to six digits differ by 1e-6 */
#define UNIFORM     1e-3 /* largest distance from j / (n - 1) that counts as uniform, */
#define MOST_OFF    0.25 /* but at most so many steps: a missing time shifts others by up to half */
#define ON_GRID     0.02 /* largest distance from a position of a finer grid, in steps */
#define GRID_EFFORT 4    /* the step of the finest grid tried is the smallest gap divided by this */

/* Keeps the largest time of a group, so that no time of the group exceeds it. */
size_t ted4_distinct_times(double *t, size_t n)
{
    size_t k = 0;

    qsort(t, n, sizeof *t, ted4_compare_doubles);
    const double same = SAME_TIME * (t[n - 1] - t[0]);
    double first = t[0]; /* start of the group */
    for (size_t i = 0; i < n; i++) {
        if (t[i] - first > same) {
            first = t[i];
            k++;
        }
        t[k] = t[i];
    }
    return k + 1;
}

/* Sorts t[n], maps it to [0, 1] and removes duplicates. Returns how many times remain. */
static size_t distinct(double *t, size_t n, double *origin, double *range)
{
    size_t k = 0;

    qsort(t, n, sizeof *t, ted4_compare_doubles);
    *origin = t[0];
    *range = t[n - 1] - t[0];
    for (size_t i = 0; i < n; i++) {
        const double u = *range > 0 ? (t[i] - *origin) / *range : 0;
        if (k == 0 || u - t[k - 1] > SAME_TIME)
            t[k++] = u;
    }
    return k;
}

/* Is every time near its own position of the grid with the given number of steps? */
static int fits(const double *u, size_t n, double steps, double tolerance)
{
    double before = -1;

    for (size_t j = 0; j < n; j++) {
        const double at = u[j] * steps, near = floor(at + 0.5);
        if (fabs(at - near) > tolerance || near <= before)
            return 0;
        before = near;
    }
    return 1;
}

/* Returns by how much the grid with the given number of steps moves the time that it moves most. A
 * result above most may be too small. */
static double farthest(const double *u, size_t n, double steps, double most)
{
    double far = 0;

    for (size_t j = 0; j < n && far <= most; j++)
        far = fmax(far, fabs(u[j] - floor(u[j] * steps + 0.5) / steps));
    return far;
}

/* Returns the number of steps, finest at most, of the grid that moves times least and leaves them
 * apart, as the finest one does. Times that were rounded to few digits have such a grid, the one
 * from which they were rounded. */
static double nearest_steps(const double *u, size_t n, double finest)
{
    double best = finest, least = farthest(u, n, finest, 1);

    for (double steps = finest - 1; steps >= (double)(n - 1); steps--) {
        const double far = farthest(u, n, steps, least);

        if (far <= least && fits(u, n, steps, 0.5)) {
            best = steps;
            least = far;
        }
    }
    return best;
}

/* Returns the number of steps of the coarsest grid that holds all times. If there is none, the step
 * is no finer than the smallest gap, and all times move to the nearest position. If the format does
 * not have that many, returns the most that it has: times nearer than half a step then become one
 * frame. */
static uint32_t find_steps(const double *u, size_t n)
{
    const double off = fmin(UNIFORM, MOST_OFF / (double)(n - 1));
    double gap = 1;
    int uniform = 1;

    for (size_t j = 0; j < n; j++) {
        uniform = uniform && fabs(u[j] - (double)j / (double)(n - 1)) <= off;
        gap = j > 0 ? fmin(gap, u[j] - u[j - 1]) : gap;
    }
    if (uniform && n <= TED4_MAX_FRAMES)
        return (uint32_t)(n - 1);
    const double most = fmin(ceil(GRID_EFFORT / gap), TED4_MAX_FRAMES - 1);
    for (double steps = (double)(n - 1); steps <= most; steps++)
        if (fits(u, n, steps, ON_GRID))
            return (uint32_t)steps;
    const double finest = ceil(1 / gap - ON_GRID);
    return finest < TED4_MAX_FRAMES && fits(u, n, finest, 0.5)
               ? (uint32_t)nearest_steps(u, n, finest)
               : TED4_MAX_FRAMES - 1;
}

/* Index of the distinct time nearest to v. */
static size_t nearest(const double *u, size_t n, double v)
{
    size_t low = 0, high = n - 1;

    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (u[middle] <= v)
            low = middle;
        else
            high = middle;
    }
    return v - u[low] <= u[high] - v ? low : high;
}

int ted4_frame_times(const double *time, size_t n, uint32_t *frame, uint32_t *n_frames,
                     ted4_message *m)
{
    double *u = malloc(n * sizeof *u), origin, range;

    if (u == NULL)
        return ted4_say_no_memory(m);
    for (size_t i = 0; i < n; i++)
        u[i] = time[i];
    const size_t k = distinct(u, n, &origin, &range);
    const uint32_t steps = k > 1 ? find_steps(u, k) : 0;
    const int is_uniform = steps + 1 == k;
    for (size_t i = 0; i < n; i++) {
        const double v = range > 0 ? (time[i] - origin) / range : 0;
        const size_t j = nearest(u, k, v);
        frame[i] = is_uniform ? (uint32_t)j : (uint32_t)(u[j] * steps + 0.5);
    }
    free(u);
    *n_frames = steps + 1;
    return 0;
}
