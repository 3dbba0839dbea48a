/* camera_colour_init.c - fits the initial colour maps by alternating two steps
 * (camera_colour_init.h). The colour of each point is, channel by channel, the median over the
 * cameras of what they see there with their maps undone. The map of each camera is the weighted
 * least squares fit from those colours to what it sees. Where something occludes the point, a
 * camera sees another colour; therefore the weights are Tukey's biweight of the difference, whose
 * width narrows from round to round. At the end, the given colours of the points determine what
 * all cameras have in common.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "camera_colour_init.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/elementary.h"
#include "train/loss/colour_fit.h"
#include "train/model/normalise.h"
#include "view_geometry.h"

/* At most so many pictures of a camera are used. What the camera sees at a point is their median,
 * channel by channel. Odd. */
enum { MOST_SAMPLES = 5 };
/* Upper bound of points times cameras; more points are thinned out evenly. */
enum { MOST = 4 << 20 };
/* Number of rounds, and the differences, of 255, from which on the weight is 0 in the first and in
 * the last round. Tints as large as the first are still found; the last leaves noise of a few
 * levels. */
enum { ROUNDS = 8 };
#define WIDEST    56.0
#define NARROWEST 14.0
/* If the sum of weights is smaller, a camera keeps its map. */
#define FEWEST    100.0
/* If the cameras differ by less than this, of 255, the difference may be noise of the fit
 * (measured: 0.2 to 1 where no camera has a tint), and the maps are not used. */
#define ALIKE     2.0
/* If the gain of the initial points is larger than this, or smaller than its inverse, their
 * colours do not come from the pictures, but are, for example, albedo or linear light. */
#define MOST_GAIN 1.25
/* Darker channels of points, of 1, do not count for the gain: noise of a few levels of 255 would
 * make their ratio too uncertain. */
#define DARK      0.15f

typedef struct {
    ted4_trainer *t;
    size_t n, stride; /* points */
    size_t cameras;   /* of the dataset */
    uint8_t *seen;    /* [cameras][n] 0 or 1 */
    uint8_t *rgb;     /* [cameras][n][3] */
    float *point;     /* [n][3] colours of the scene, 0 .. 1 */
    uint8_t *shared;  /* [n] 1 if at least two cameras see the point */
    float *sorted;    /* [cameras] */
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

/* ---- observations ---- */

/* A picture is divided into depth_tiles by depth_tiles tiles, one per POINTS_PER_DEPTH_TILE
 * points. A point is taken to be hidden if it is deeper than the nearest point of its tile by more
 * than the share HIDDEN. */
enum { MOST_DEPTH_TILES = 64 };
#define POINTS_PER_DEPTH_TILE 8.0
#define HIDDEN                0.1f

/* Samples of one camera: rgb[n][MOST_SAMPLES][3] and count[n]. For the current picture: pixel[n]
 * and depth[n] of each point, the depth being 0 if the point is not in the picture, and the
 * nearest depth of each tile. */
typedef struct {
    uint8_t *rgb, *count;
    size_t *pixel;
    float *depth, nearest[MOST_DEPTH_TILES * MOST_DEPTH_TILES];
    size_t depth_tiles;
} samples;

static float *nearest_at(samples *l, const ted4_view *v, size_t pixel)
{
    const size_t w = (size_t)v->width, h = (size_t)v->height;

    return &l->nearest[pixel / w * l->depth_tiles / h * l->depth_tiles +
                       pixel % w * l->depth_tiles / w];
}

static void project(const match *m, const ted4_view *v, samples *l)
{
    for (size_t c = 0; c < l->depth_tiles * l->depth_tiles; c++)
        l->nearest[c] = INFINITY;
    for (size_t i = 0; i < m->n; i++) {
        float p[3], *nearest;

        l->depth[i] = 0;
        ted4_normalise_point(&m->t->layout.head, m->t->data->points + 3 * i * m->stride, p);
        if (!ted4_view_pixel(v, p, &l->pixel[i], &l->depth[i]))
            continue;
        nearest = nearest_at(l, v, l->pixel[i]);
        *nearest = fminf(*nearest, l->depth[i]);
    }
}

static int look(match *m, size_t item, samples *l)
{
    ted4_trainer *t = m->t;
    const ted4_picture *pic = &t->data->pictures[item];
    const uint8_t *pixels = ted4_dataset_pixels(t->data, item, &t->message);
    ted4_view v;
    float centre[3];

    if (pixels == NULL)
        return -1;
    ted4_normalise_view(&t->layout.head, &pic->camera, &v, centre);
    project(m, &v, l);
    for (size_t i = 0; i < m->n; i++)
        if (l->depth[i] > 0 && l->depth[i] <= (1.0f + HIDDEN) * *nearest_at(l, &v, l->pixel[i]))
            memcpy(l->rgb + 3 * (i * MOST_SAMPLES + l->count[i]++), pixels + 3 * l->pixel[i], 3);
    ted4_dataset_release(t->data, item);
    return 0;
}

static void settle(match *m, size_t camera, const samples *l)
{
    for (size_t i = 0; i < m->n; i++) {
        float x[MOST_SAMPLES];

        m->seen[camera * m->n + i] = l->count[i] > 0;
        for (size_t c = 0; c < 3 && l->count[i] > 0; c++) {
            for (size_t k = 0; k < l->count[i]; k++)
                x[k] = l->rgb[3 * (i * MOST_SAMPLES + k) + c];
            m->rgb[3 * (camera * m->n + i) + c] = (uint8_t)median(x, l->count[i]);
        }
    }
}

/* Returns the number of training pictures of a camera. */
static size_t count_pictures(const ted4_dataset *d, size_t camera)
{
    size_t n = 0;

    for (size_t i = 0; i < d->n_pictures; i++)
        n += !d->pictures[i].is_test && d->pictures[i].camera_id == camera;
    return n;
}

static int look_from(match *m, size_t camera, samples *l)
{
    const ted4_dataset *d = m->t->data;
    const size_t pictures = count_pictures(d, camera),
                 wanted = pictures < MOST_SAMPLES ? pictures : MOST_SAMPLES;
    size_t at = 0, taken = 0;

    memset(l->count, 0, m->n);
    for (size_t i = 0; i < d->n_pictures && taken < wanted; i++) {
        if (d->pictures[i].is_test || d->pictures[i].camera_id != camera)
            continue;
        if (at++ == taken * pictures / wanted) {
            taken++;
            if (look(m, i, l) != 0)
                return -1;
        }
    }
    settle(m, camera, l);
    return 0;
}

static int look_around(match *m)
{
    samples l = { malloc(3 * MOST_SAMPLES * m->n),
                  malloc(m->n),
                  malloc(m->n * sizeof *l.pixel),
                  malloc(m->n * sizeof *l.depth),
                  { 0 },
                  (size_t)fmin(ceil(sqrt((double)m->n / POINTS_PER_DEPTH_TILE)),
                               MOST_DEPTH_TILES) };
    int bad = 0;

    if (l.rgb == NULL || l.count == NULL || l.pixel == NULL || l.depth == NULL)
        bad = ted4_trainer_fail(m->t, "no memory to compare cameras");
    for (size_t k = 0; k < m->cameras && !bad; k++)
        if (ted4_colour_has(&m->t->colour, (uint32_t)k))
            bad = look_from(m, k, &l);
    free(l.rgb);
    free(l.count);
    free(l.pixel);
    free(l.depth);
    return bad;
}

/* ---- one round ---- */

typedef struct {
    double inverse[9], v[3];
    int usable;
} undo;

static void find_points(match *m, const undo *back)
{
    for (size_t i = 0; i < m->n; i++)
        for (size_t c = 0; c < 3; c++) {
            size_t seen = 0;

            for (size_t k = 0; k < m->cameras; k++) {
                const uint8_t *x = m->rgb + 3 * (k * m->n + i);
                double sum = 0;

                if (!back[k].usable || !m->seen[k * m->n + i])
                    continue;
                for (size_t j = 0; j < 3; j++)
                    sum += (x[j] / 255.0 - back[k].v[j]) * back[k].inverse[3 * j + c];
                m->sorted[seen++] = (float)sum;
            }
            m->shared[i] = seen >= 2;
            m->point[3 * i + c] = seen > 0 ? median(m->sorted, seen) : 0.0f;
        }
}

static void add_points(const match *m, size_t camera, const float *map, double width,
                       ted4_colour_sums *s)
{
    memset(s, 0, sizeof *s);
    for (size_t i = 0; i < m->n; i++) {
        const uint8_t *to = m->rgb + 3 * (camera * m->n + i);
        const double x[4] = { (double)m->point[3 * i], (double)m->point[3 * i + 1],
                              (double)m->point[3 * i + 2], 1.0 };
        double off = 0;

        if (!m->seen[camera * m->n + i] || !m->shared[i])
            continue;
        for (size_t c = 0; c < 3; c++) {
            double e = x[c] + (double)map[9 + c] - to[c] / 255.0;

            for (size_t j = 0; j < 3; j++)
                e += x[j] * (double)map[3 * j + c];
            off += e * e / 3.0;
        }
        const double near = 1.0 - off / (width * width), w = near > 0 ? near * near : 0.0;

        s->weight += w;
        for (size_t r = 0; r < 4; r++) {
            for (size_t c = 0; c < 4; c++)
                s->left[r][c] += w * x[r] * x[c];
            for (size_t c = 0; c < 3; c++)
                s->right[r][c] += w * x[r] * (to[c] / 255.0 - x[c]);
        }
    }
}

/* Fits the map of one camera. Leaves it unchanged if the camera sees too few points. */
static void fit(const match *m, size_t camera, double width)
{
    float *map = m->t->colour.value[camera];
    ted4_colour_sums s;

    add_points(m, camera, map, width, &s);
    if (s.weight >= FEWEST)
        ted4_colour_solve(&s, map);
}

/* Computes the colours of the points from the current maps. */
static void look_back(match *m, undo *back)
{
    const ted4_colour *colour = &m->t->colour;

    for (size_t k = 0; k < m->cameras; k++) {
        back[k].usable = ted4_colour_has(colour, (uint32_t)k) &&
                         ted4_colour_invert(colour->value[k], back[k].inverse) == 0;
        for (int c = 0; c < 3; c++)
            back[k].v[c] = (double)colour->value[k][9 + c];
    }
    find_points(m, back);
}

static void one_round(match *m, undo *back, double width)
{
    look_back(m, back);
    for (size_t k = 0; k < m->cameras; k++)
        if (back[k].usable)
            fit(m, k, width);
    ted4_colour_centre(&m->t->colour);
}

/* ---- what all cameras have in common ---- */

/* Finds the gain that all cameras share. The cameras alone do not determine it, but the given
 * colours of the initial points may: it is the median of their ratio to the colours that the
 * cameras see. Structure from motion gives points the colours of single cameras, so that the
 * ratios come in clusters; the median lies between them, where a fit with narrow weights would
 * settle on one. Changes nothing if hardly any point counts, or if the given colours mean something
 * else. */
static void find_gauge(match *m, undo *back, float *ratio)
{
    const float white = 255.0f;
    double gain[3];

    look_back(m, back);
    for (size_t c = 0; c < 3; c++) {
        size_t n = 0;

        for (size_t i = 0; i < m->n; i++)
            if (m->shared[i] && m->point[3 * i + c] > DARK)
                ratio[n++] = (float)m->t->data->point_rgb[3 * i * m->stride + c] / white /
                             m->point[3 * i + c];
        if ((double)n < FEWEST)
            return;
        gain[c] = (double)median(ratio, n);
        if (!(gain[c] < MOST_GAIN && gain[c] > 1.0 / MOST_GAIN))
            return;
    }
    ted4_colour_regauge(&m->t->colour, gain);
}

/* Returns whether the cameras differ by more than the error of the fit. The measure is the root
 * mean square, over cameras and points, of what the maps change. */
static int differ(const match *m)
{
    const ted4_colour *colour = &m->t->colour;
    double sum = 0, n = 0;

    for (size_t k = 0; k < m->cameras; k++)
        for (size_t i = 0; i < m->n && colour->corrected[k]; i++) {
            const float *x = m->point + 3 * i, *map = colour->value[k];

            for (size_t c = 0; c < 3 && m->shared[i]; c++) {
                const float d = x[0] * map[c] + x[1] * map[3 + c] + x[2] * map[6 + c] + map[9 + c];

                sum += (double)(d * d);
                n++;
            }
        }
    return n > 0 && sqrt(sum / n) >= ALIKE / 255.0;
}

static int work(match *m)
{
    ted4_colour *colour = &m->t->colour;
    undo *back = calloc(m->cameras, sizeof *back);
    float *ratio;
    int bad;

    m->seen = calloc(m->cameras, m->n);
    m->rgb = malloc(3 * m->cameras * m->n);
    m->point = malloc(3 * m->n * sizeof *m->point);
    m->shared = malloc(m->n);
    m->sorted = malloc(m->cameras * sizeof *m->sorted);
    ratio = malloc(m->n * sizeof *ratio);
    bad = back == NULL || m->seen == NULL || m->rgb == NULL || m->point == NULL ||
                  m->shared == NULL || m->sorted == NULL || ratio == NULL
              ? ted4_trainer_fail(m->t, "no memory to compare cameras")
              : look_around(m);
    for (int i = 0; i < ROUNDS && !bad; i++)
        one_round(m, back, WIDEST / 255.0 * ted4_math_pow(NARROWEST / WIDEST, i / (ROUNDS - 1.0)));
    colour->matched = !bad && differ(m);
    if (colour->matched)
        find_gauge(m, back, ratio);
    else
        memset(colour->value, 0, m->cameras * sizeof *colour->value);
    free(back);
    free(m->seen);
    free(m->rgb);
    free(m->point);
    free(m->shared);
    free(m->sorted);
    free(ratio);
    return bad;
}

int ted4_camera_colour_init(ted4_trainer *t)
{
    const size_t points = t->data->n_points, cameras = t->colour.n_cameras;
    match m = { .t = t, .cameras = cameras };

    if (cameras == 0 || points == 0 || t->data->random_points)
        return 0;
    m.stride = 1 + points * cameras / MOST;
    m.n = (points + m.stride - 1) / m.stride;
    return work(&m);
}
