/* sweep.c - see sweep.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"

/* Smallest distance of two cameras, relative to the distance of the scene. */
#define APART    0.05
/* Depths whose patch difference exceeds the best by at most so many levels are equally good. */
#define EQUAL    1.5
/* If the centre pixels differ by more than so many times the limit, the patches are not
 * compared. */
#define HOPELESS 3.0
enum { FEWEST = 2 };

static const ted4_picture *picture(const ted4_shown *s, size_t i)
{
    return &s->data->pictures[s->picture[i]];
}

/* Inserts picture k into the list of the nearest helpers of picture i, sorted by distance. */
static void insert(ted4_sweep *w, size_t i, size_t k, double far, double *list)
{
    int at = w->n_helpers[i];

    if (at == TED4_SWEEP_HELPERS && far >= list[at - 1])
        return;
    if (at < TED4_SWEEP_HELPERS)
        w->n_helpers[i]++;
    else
        at--;
    for (; at > 0 && list[at - 1] > far; at--) {
        list[at] = list[at - 1];
        w->helper[i][at] = w->helper[i][at - 1];
    }
    list[at] = far;
    w->helper[i][at] = (uint8_t)k;
}

static void choose(ted4_sweep *w, const double (*centre)[3], size_t i, double apart, int same_time)
{
    double list[TED4_SWEEP_HELPERS];

    w->n_helpers[i] = 0;
    for (size_t k = 0; k < w->shown->n; k++) {
        const double far = ted4_distance3(centre[i], centre[k]);

        if (far >= apart &&
            (!same_time || picture(w->shown, i)->frame == picture(w->shown, k)->frame))
            insert(w, i, k, far, list);
    }
}

void ted4_sweep_begin(ted4_sweep *w, const ted4_shown *s, double ahead, double nearest,
                      double farthest)
{
    double centre[TED4_SHOWN_MOST][3];

    memset(w, 0, sizeof *w);
    w->shown = s;
    w->nearest = nearest;
    w->farthest = farthest;
    for (size_t i = 0; i < s->n; i++)
        ted4_pose_centre(picture(s, i)->camera.R, picture(s, i)->camera.t, centre[i]);
    for (size_t i = 0; i < s->n; i++) {
        choose(w, (const double(*)[3])centre, i, APART * ahead, 1);
        if (w->n_helpers[i] < FEWEST)
            choose(w, (const double(*)[3])centre, i, APART * ahead, 0);
    }
}

void ted4_sweep_point(const ted4_camera *c, size_t pixel, double z, double world[3])
{
    const double x = (double)(pixel % (size_t)c->width) + 0.5 - c->cx;
    const double y = (double)(pixel / (size_t)c->width) + 0.5 - c->cy;
    const double at[3] = { x / c->fx * z - c->t[0], y / c->fy * z - c->t[1], z - c->t[2] };

    for (int k = 0; k < 3; k++)
        world[k] = c->R[k] * at[0] + c->R[3 + k] * at[1] + c->R[6 + k] * at[2];
}

static int off(const uint8_t *a, const uint8_t *b)
{
    return abs(a[0] - b[0]) + abs(a[1] - b[1]) + abs(a[2] - b[2]);
}

/* Colours of a pixel and its four neighbours. Outside the picture the pixel itself is repeated. */
typedef struct {
    uint8_t rgb[5][3];
} patch;

static void take_patch(const ted4_camera *c, const uint8_t *rgb, size_t pixel, patch *p)
{
    const size_t width = (size_t)c->width, x = pixel % width, y = pixel / width;
    const size_t at[5] = { pixel, x > 0 ? pixel - 1 : pixel, x + 1 < width ? pixel + 1 : pixel,
                           y > 0 ? pixel - width : pixel,
                           y + 1 < (size_t)c->height ? pixel + width : pixel };

    for (int k = 0; k < 5; k++)
        memcpy(p->rgb[k], rgb + 3 * at[k], 3);
}

/* Mean absolute difference of two patches, in levels. */
static double patch_off(const patch *a, const patch *b)
{
    int sum = 0;

    for (int k = 0; k < 5; k++)
        sum += off(a->rgb[k], b->rgb[k]);
    return sum / 15.0;
}

/* Mean of the smaller half of x, at least two values. The other half may see an occluder in front
 * of the point. */
static double better_half(double *x, int n)
{
    const int half = n / 2 > FEWEST ? n / 2 : FEWEST;
    double sum = 0;

    for (int i = 1; i < n; i++)
        for (int k = i; k > 0 && x[k - 1] > x[k]; k--) {
            const double y = x[k];

            x[k] = x[k - 1];
            x[k - 1] = y;
        }
    for (int i = 0; i < half; i++)
        sum += x[i];
    return sum / half;
}

/* Mean patch difference of the better half of the helpers at a point. Infinite if fewer than two
 * helpers see the point, or if their centre pixels alone differ too much. */
static double cost(const ted4_sweep *w, size_t i, const patch *mine, const double world[3])
{
    double each[TED4_SWEEP_HELPERS];
    size_t at[TED4_SWEEP_HELPERS];
    int n = 0, helpers[TED4_SWEEP_HELPERS];

    for (int h = 0; h < w->n_helpers[i]; h++) {
        const size_t k = w->helper[i][h];

        if (!ted4_shown_pixel(w->shown, k, world, &at[n]))
            continue;
        each[n] = off(mine->rgb[0], w->shown->rgb[k] + 3 * at[n]) / 3.0;
        helpers[n++] = (int)k;
    }
    if (n < FEWEST || better_half(each, n) > HOPELESS * w->agreed)
        return INFINITY;
    for (int h = 0; h < n; h++) {
        const size_t k = (size_t)helpers[h];
        patch other;

        take_patch(&picture(w->shown, k)->camera, w->shown->rgb[k], at[h], &other);
        each[h] = patch_off(mine, &other);
    }
    return better_half(each, n);
}

int ted4_sweep_agrees(const ted4_sweep *w, size_t i, size_t pixel, const double world[3])
{
    patch mine;

    take_patch(&picture(w->shown, i)->camera, w->shown->rgb[i], pixel, &mine);
    return cost(w, i, &mine, world) <= w->agreed;
}

int ted4_sweep_pixel(const ted4_sweep *w, size_t i, size_t pixel, double u, double world[3])
{
    const ted4_camera *c = &picture(w->shown, i)->camera;
    patch mine;
    double depth[TED4_SWEEP_DEPTHS], found[TED4_SWEEP_DEPTHS], best = INFINITY;
    int n = 0;

    take_patch(c, w->shown->rgb[i], pixel, &mine);
    for (int k = 0; k < TED4_SWEEP_DEPTHS; k++) {
        const double part = (k + 0.5) / TED4_SWEEP_DEPTHS;

        depth[k] = 1 / ((1 - part) / w->nearest + part / w->farthest);
        ted4_sweep_point(c, pixel, depth[k], world);
        found[k] = cost(w, i, &mine, world);
        best = fmin(best, found[k]);
    }
    if (!(best <= w->agreed))
        return 0;
    for (int k = 0; k < TED4_SWEEP_DEPTHS; k++)
        if (found[k] <= best + EQUAL)
            depth[n++] = depth[k];
    ted4_sweep_point(c, pixel, depth[(int)(u * n)], world);
    return 1;
}
