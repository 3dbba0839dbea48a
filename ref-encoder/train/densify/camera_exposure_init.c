/* camera_exposure_init.c - see camera_exposure_init.h. The gain of a picture is the median, over
 * points and per channel, of the ratio of what it shows at a point to the median of what all
 * pictures of that camera show there. The median ignores what moves.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "camera_exposure_init.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/model/normalise.h"
#include "view_geometry.h"

/* At most so many pictures of a camera, and points, are used; more are thinned out evenly. */
enum { MOST_PICTURES = 64, MOST_POINTS = 2048 };
/* A picture in which fewer points count has no gain. */
enum { FEWEST = 30 };
/* Darker channels, of 255, do not count, because their ratios are uncertain; brighter ones may be
 * clipped. */
enum { DARKEST = 25, BRIGHTEST = 245 };
/* If gains change by less than this, the change may be one of what is seen, and exposures are not
 * corrected. Measured: at most 0.0005 in captures whose exposures are fixed, 0.003 where a lamp
 * flickers, 0.059 where exposures drift by half a stop. */
#define WORTH 0.01

typedef struct {
    ted4_trainer *t;
    size_t n, stride;  /* points */
    uint8_t (*rgb)[3]; /* [MOST_PICTURES][n] what pictures of a camera show */
    uint8_t *seen;     /* [MOST_PICTURES][n] 1: the point is in the picture */
    float *sorted;     /* [MOST_PICTURES or n, whichever is larger] */
    float *reference;  /* [n][3] medians over the pictures; 0: does not count */
    size_t item[MOST_PICTURES], n_items;
} match;

static int ascending(const void *x, const void *y)
{
    const float a = *(const float *)x, b = *(const float *)y;

    return a < b ? -1 : a > b;
}

static float median(float *x, size_t n)
{
    qsort(x, n, sizeof *x, ascending);
    return 0.5f * (x[(n - 1) / 2] + x[n / 2]);
}

/* Chooses training pictures of a camera. */
static void choose(match *m, uint32_t camera)
{
    const ted4_dataset *d = m->t->data;
    size_t pictures = 0, at = 0, wanted;

    for (size_t i = 0; i < d->n_pictures; i++)
        pictures += !d->pictures[i].is_test && d->pictures[i].camera_id == camera;
    wanted = pictures < MOST_PICTURES ? pictures : MOST_PICTURES;
    m->n_items = 0;
    for (size_t i = 0; i < d->n_pictures && m->n_items < wanted; i++)
        if (!d->pictures[i].is_test && d->pictures[i].camera_id == camera &&
            at++ == m->n_items * pictures / wanted)
            m->item[m->n_items++] = i;
}

static int look(match *m, size_t k)
{
    ted4_trainer *t = m->t;
    const uint8_t *pixels = ted4_dataset_pixels(t->data, m->item[k], &t->message);
    ted4_view v;
    float centre[3];

    if (pixels == NULL)
        return -1;
    ted4_normalise_view(&t->layout.head, &t->data->pictures[m->item[k]].camera, &v, centre);
    for (size_t i = 0; i < m->n; i++) {
        float p[3], depth;
        size_t pixel;

        ted4_normalise_point(&t->layout.head, t->data->points + 3 * i * m->stride, p);
        m->seen[k * m->n + i] = (uint8_t)ted4_view_pixel(&v, p, &pixel, &depth);
        if (m->seen[k * m->n + i])
            memcpy(m->rgb[k * m->n + i], pixels + 3 * pixel, 3);
    }
    ted4_dataset_release(t->data, m->item[k]);
    return 0;
}

static void find_references(match *m)
{
    for (size_t i = 0; i < m->n; i++)
        for (size_t c = 0; c < 3; c++) {
            size_t n = 0;
            float x;

            for (size_t k = 0; k < m->n_items; k++)
                if (m->seen[k * m->n + i])
                    m->sorted[n++] = m->rgb[k * m->n + i][c];
            x = n >= 2 ? median(m->sorted, n) : 0;
            m->reference[3 * i + c] = x >= DARKEST && x <= BRIGHTEST ? x : 0;
        }
}

/* Sets gain[3] of picture k, less 1. Returns 0, or -1 if too few points count. */
static int find_gain(match *m, size_t k, float gain[3])
{
    for (size_t c = 0; c < 3; c++) {
        size_t n = 0;

        for (size_t i = 0; i < m->n; i++)
            if (m->seen[k * m->n + i] && m->reference[3 * i + c] > 0)
                m->sorted[n++] = m->rgb[k * m->n + i][c] / m->reference[3 * i + c];
        if (n < FEWEST)
            return -1;
        gain[c] = median(m->sorted, n) - 1;
    }
    return 0;
}

/* Sets the gains of a camera: at each knot the mean over pictures, by the weights of their times. A
 * knot without pictures gets the value of the one before it. */
static void fit(match *m, uint32_t camera)
{
    ted4_exposure *e = &m->t->colour.exposure;
    float *value = e->value + 3 * camera * e->n_knots;
    double sum[TED4_EXPOSURE_KNOTS][4] = { { 0 } };
    float gain[3];

    for (size_t k = 0; k < m->n_items; k++) {
        if (find_gain(m, k, gain) != 0)
            continue;
        for (size_t knot = 0; knot < e->n_knots; knot++) {
            const double w = ted4_exposure_weight(e, knot, m->t->data->pictures[m->item[k]].frame);

            for (size_t c = 0; c < 3; c++)
                sum[knot][c] += w * (double)gain[c];
            sum[knot][3] += w;
        }
    }
    for (size_t i = 0; i < 3 * e->n_knots; i++) {
        const double *s = sum[i / 3];

        value[i] = s[3] > 0 ? (float)(s[i % 3] / s[3]) : i >= 3 ? value[i - 3] : 0;
    }
}

static int fit_cameras(match *m)
{
    const ted4_colour *colour = &m->t->colour;

    for (uint32_t camera = 0; camera < colour->n_cameras; camera++) {
        if (!colour->corrected[camera])
            continue;
        choose(m, camera);
        for (size_t k = 0; k < m->n_items; k++)
            if (look(m, k) != 0)
                return -1;
        find_references(m);
        fit(m, camera);
    }
    return 0;
}

/* Returns the root mean square of the gains, less 1, near the pictures of cameras. */
static double change(const ted4_exposure *e)
{
    double sum = 0, n = 0;

    for (size_t i = 0; i < 3 * e->n_cameras * e->n_knots; i++)
        if (e->near[i / 3]) {
            sum += (double)e->value[i] * (double)e->value[i];
            n++;
        }
    return n > 0 ? sqrt(sum / n) : 0;
}

static int work(match *m)
{
    ted4_colour *colour = &m->t->colour;
    int bad = 0;

    m->rgb = malloc(MOST_PICTURES * m->n * sizeof *m->rgb);
    m->seen = malloc(MOST_PICTURES * m->n);
    m->sorted = malloc((m->n > MOST_PICTURES ? m->n : MOST_PICTURES) * sizeof *m->sorted);
    m->reference = malloc(3 * m->n * sizeof *m->reference);
    bad = m->rgb == NULL || m->seen == NULL || m->sorted == NULL || m->reference == NULL
              ? ted4_trainer_fail(m->t, "no memory to compare exposures")
              : fit_cameras(m);
    free(m->rgb);
    free(m->seen);
    free(m->sorted);
    free(m->reference);
    if (bad)
        return -1;
    ted4_exposure_centre(&colour->exposure);
    colour->exposure_change = change(&colour->exposure);
    if (!(colour->exposure_change >= WORTH))
        ted4_exposure_finish(&colour->exposure);
    return 0;
}

int ted4_camera_exposure_init(ted4_trainer *t)
{
    const size_t points = t->data->n_points;
    match m = { .t = t };

    if (!t->opt.exposure || t->colour.n_cameras == 0 || points == 0 || t->data->random_points)
        return 0;
    if (ted4_exposure_init(&t->colour.exposure, t->data, t->colour.corrected) != 0)
        return ted4_trainer_fail(t, "no memory for exposures");
    if (t->colour.exposure.n_knots == 0)
        return 0;
    m.stride = (points + MOST_POINTS - 1) / MOST_POINTS;
    m.n = (points + m.stride - 1) / m.stride;
    return work(&m);
}
