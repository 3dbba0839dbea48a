/* scatter.c - see scatter.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/scatter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"
#include "data/depth_points.h"
#include "data/point_cloud.h"
#include "data/shown.h"
#include "data/source.h"
#include "data/sweep.h"
#include "data/useful.h"
#include "math/elementary.h"

/* A point lies in empty space if less than this share of the pictures that see it show foreground
 * there. The share is small because moving objects are visible at few times, and because what lies
 * far from objects coincides with them in few cameras. */
#define EMPTY         (1.0 / 16.0)
/* Range of depths tried, relative to the distance of the cameras from the point that they look at:
 * with a plain background, objects are at that point; in a room, walls may be far behind it. */
#define NEAREST       0.15
#define FARTHEST      3.0
#define FARTHEST_ROOM 4.0
/* With a plain background, cameras look at the objects: a point must lie in at least this share of
 * the pictures. */
#define LOOKED_AT     0.5
/* Range of depths of depth maps: their planes are few, and hardly anything is nearer. */
#define NEAREST_MAP   0.25
/* Depth maps suffice if they give at least so many points. */
#define ENOUGH        2048
/* Passes, in order. agreed: levels by which pictures may differ about a point (0: any depth is
 * accepted). tries: candidates per random point. wanted: total number of points after the pass. At
 * any depth, most points of a ray lie in empty space, so the last pass adds only enough points to
 * begin with. Points that came with the scene are judged by the second pass. */
static const struct {
    double agreed;
    size_t tries, wanted;
} pass[] = { { 4, 4, TED4_RANDOM_POINTS }, { 10, 8, TED4_RANDOM_POINTS }, { 0, 32, 2048 } };
enum { PASSES = sizeof pass / sizeof *pass, USEFUL_PASS = 1 };
/* Candidates per job, and pixels tried per candidate. */
enum { RUN = 1024, PIXELS = 32 };

typedef struct {
    const ted4_shown *shown;
    const ted4_scatter_options *options;
    ted4_sweep sweep;
    uint64_t first;       /* number of the first candidate of this round */
    int fewest;           /* least number of pictures that must see a point */
    float *point;         /* [RUNS * RUN][3] */
    uint8_t *rgb, *taken; /* [RUNS * RUN][3], [RUNS * RUN] */
} round_job;

enum { RUNS = 16 };

/* Chooses a foreground pixel of a picture at random. Returns 0 if none was found. */
static int choose_pixel(const round_job *j, uint64_t *state, size_t *picture, size_t *pixel)
{
    for (int k = 0; k < PIXELS; k++) {
        *picture = (size_t)(ted4_split_uniform(state) * (double)j->shown->n);

        const ted4_camera *c = &j->shown->data->pictures[j->shown->picture[*picture]].camera;

        *pixel =
            (size_t)(ted4_split_uniform(state) * (double)((size_t)c->width * (size_t)c->height));
        if (ted4_shown_at(j->shown, *picture, *pixel))
            return 1;
    }
    return 0;
}

/* Gives a point on the ray of a pixel at a random depth, uniform in the logarithm of depth. */
static void any_depth(const round_job *j, const ted4_camera *c, size_t pixel, double u,
                      double world[3])
{
    const double octaves = ted4_math_log2(j->sweep.farthest / j->sweep.nearest);

    ted4_sweep_point(c, pixel, j->sweep.nearest * ted4_math_exp2(octaves * u), world);
}

static int is_inside(const ted4_scatter_options *o, const float p[3])
{
    for (int k = 0; o->bounded && k < 3; k++)
        if (!(p[k] >= o->low[k] && p[k] <= o->high[k]))
            return 0;
    return 1;
}

static int try_candidate(const round_job *j, uint64_t i, float point[3], uint8_t rgb[3])
{
    /* Each candidate has random numbers of its own, whichever thread tries it. Any states do that
     * differ, because the generator mixes them. Only the low 24 bits of the seed count. */
    uint64_t state = (uint64_t)j->options->seed << 40 ^ i << 8;
    const double u = ted4_split_uniform(&state);
    size_t k, pixel;
    double world[3];
    int seen, shown;

    if (!choose_pixel(j, &state, &k, &pixel))
        return 0;
    if (!(j->sweep.agreed > 0))
        any_depth(j, &j->shown->data->pictures[j->shown->picture[k]].camera, pixel, u, world);
    else if (!ted4_sweep_pixel(&j->sweep, k, pixel, u, world))
        return 0;
    for (int c = 0; c < 3; c++)
        point[c] = (float)world[c];
    if (!is_inside(j->options, point))
        return 0;
    memcpy(rgb, j->shown->rgb[k] + 3 * pixel, 3);
    ted4_shown_count(j->shown, world, &seen, &shown);

    const double share = seen > 0 ? (double)shown / (double)seen : 0;

    return seen >= j->fewest && share >= EMPTY && ted4_split_uniform(&state) < share * share;
}

static void try_run(void *arg, size_t run)
{
    const round_job *j = arg;

    for (size_t i = run * RUN; i < (run + 1) * RUN; i++)
        j->taken[i] = (uint8_t)try_candidate(j, j->first + i, j->point + 3 * i, j->rgb + 3 * i);
}

/* Fills the cloud from *n on by pass k. before: number of candidates tried in earlier passes.
 * Returns 0, or -1 if memory runs out. */
static int scatter(round_job *j, const ted4_parallel *p, size_t k, uint64_t before,
                   ted4_point_cloud *c, size_t *n)
{
    const uint64_t end = before + (uint64_t)pass[k].tries * TED4_RANDOM_POINTS;

    j->sweep.agreed = pass[k].agreed;
    j->point = malloc((size_t)RUNS * RUN * 3 * sizeof *j->point);
    j->rgb = malloc((size_t)RUNS * RUN * 3);
    j->taken = malloc((size_t)RUNS * RUN);

    int bad = j->point == NULL || j->rgb == NULL || j->taken == NULL;

    for (j->first = before; !bad && *n < pass[k].wanted && j->first < end; j->first += RUNS * RUN) {
        ted4_parallel_for(p, RUNS, try_run, j);
        for (size_t i = 0; i < (size_t)RUNS * RUN && *n < pass[k].wanted; i++)
            if (j->taken[i]) {
                memcpy(c->xyz + 3 * *n, j->point + 3 * i, 3 * sizeof *c->xyz);
                memcpy(c->rgb + 3 * (*n)++, j->rgb + 3 * i, 3);
            }
    }
    free(j->point);
    free(j->rgb);
    free(j->taken);
    return bad ? -1 : 0;
}

/* Sets the range of depths from the distance of the cameras. Returns 0, or -1 with *m filled. */
static int begin_sweep(ted4_sweep *w, const ted4_shown *s, ted4_message *m)
{
    double centre[3], half;

    if (ted4_view_box(s->data, centre, &half) != 0)
        return ted4_say_no_memory(m);

    const double ahead = half / TED4_VIEW_BOX_HALF_SIDE;

    ted4_sweep_begin(w, s, ahead, NEAREST * ahead, (s->plain ? FARTHEST : FARTHEST_ROOM) * ahead);
    return 0;
}

/* Takes over the points of a cloud. */
static void use(ted4_dataset *d, const ted4_point_cloud *c, int are_random)
{
    free(d->points);
    free(d->point_rgb);
    d->points = c->xyz;
    d->point_rgb = c->rgb;
    d->n_points = c->n;
    d->random_points = are_random;
}

/* Returns whether a point of a depth map lies inside the bounds and, with a plain background, where
 * enough pictures show foreground. */
static int is_wanted(const void *user, const float xyz[3])
{
    const round_job *j = user;
    const double world[3] = { (double)xyz[0], (double)xyz[1], (double)xyz[2] };
    int seen, shown;

    if (!is_inside(j->options, xyz))
        return 0;
    if (!j->shown->plain)
        return 1;
    ted4_shown_count(j->shown, world, &seen, &shown);
    return seen >= j->fewest && (double)shown >= EMPTY * (double)seen;
}

/* Replaces the points by those of depth maps, if these are enough. Returns 0, or -1 if memory ran
 * out. */
static int replace_by_depth(ted4_dataset *d, const round_job *j, const ted4_parallel *p, size_t *n)
{
    const ted4_depth_wanted wanted = { TED4_RANDOM_POINTS, j->options->seed, is_wanted, j };
    ted4_sweep w = j->sweep;
    ted4_point_cloud c;

    w.nearest *= NEAREST_MAP / NEAREST;
    if (ted4_depth_points(&c, &w, &wanted, p) != 0) {
        ted4_point_cloud_free(&c);
        return -1;
    }
    if (c.n < ENOUGH) {
        ted4_point_cloud_free(&c);
        return 0;
    }
    use(d, &c, 0);
    *n = c.n;
    return 0;
}

/* Replaces the points by scattered ones, if any are found: first where pictures agree about
 * colours, and then, if these are few, at any depth on the rays of foreground pixels. Returns 0, or
 * -1 if memory ran out. */
static int replace_by_rays(ted4_dataset *d, round_job *j, const ted4_parallel *p, size_t *n)
{
    ted4_point_cloud c;
    int bad = 0;

    if (ted4_point_cloud_alloc(&c, TED4_RANDOM_POINTS) != 0)
        return -1;
    for (size_t k = 0, before = 0; !bad && k < PASSES; before += pass[k++].tries)
        bad = scatter(j, p, k, (uint64_t)before * TED4_RANDOM_POINTS, &c, n) != 0;
    c.n = *n;
    if (bad || c.n == 0)
        ted4_point_cloud_free(&c);
    else
        use(d, &c, 1);
    return bad ? -1 : 0;
}

/* Replaces the points. Returns 0, or -1 with *m filled. */
static int replace(ted4_dataset *d, const ted4_sweep *w, const ted4_scatter_options *o,
                   const ted4_parallel *p, size_t *n, ted4_message *m)
{
    const ted4_shown *s = w->shown;
    round_job j = { .shown = s, .options = o, .sweep = *w };

    j.fewest = s->plain && s->n > 4 ? (int)(LOOKED_AT * (double)s->n) : s->n > 1 ? 2 : 1;
    if (replace_by_depth(d, &j, p, n) != 0 || (*n == 0 && replace_by_rays(d, &j, p, n) != 0))
        return ted4_say_no_memory(m);
    return 0;
}

/* Removes points outside the bounds. Returns how many. */
static size_t drop_outside(ted4_dataset *d, const ted4_scatter_options *o)
{
    const size_t before = d->n_points;
    size_t n = 0;

    for (size_t i = 0; i < before; i++) {
        if (!is_inside(o, d->points + 3 * i))
            continue;
        memmove(d->points + 3 * n, d->points + 3 * i, 3 * sizeof *d->points);
        memmove(d->point_rgb + 3 * n++, d->point_rgb + 3 * i, 3);
    }
    d->n_points = n;
    return before - n;
}

int ted4_dataset_scatter(ted4_dataset *d, const ted4_scatter_options *o, const ted4_parallel *p,
                         ted4_scattered *what, ted4_message *m)
{
    ted4_shown s;
    ted4_sweep w;
    int bad = ted4_shown_read(&s, d, m) != 0;

    memset(what, 0, sizeof *what);
    if (!bad && s.plain && !d->has_alpha)
        memcpy(d->background, s.background, sizeof d->background);

    const size_t outside = bad ? 0 : drop_outside(d, o);

    what->outside = d->random_points ? 0 : outside;
    if (!bad && s.n > 0) {
        bad = begin_sweep(&w, &s, m) != 0;
        w.agreed = pass[USEFUL_PASS].agreed;
        if (!bad &&
            (d->random_points || d->n_points == 0 || !ted4_points_are_useful(&w, o->seed))) {
            what->given = d->random_points ? 0 : d->n_points;
            bad = replace(d, &w, o, p, &what->scattered, m) != 0;
        }
    }
    if (!bad && d->n_points == 0)
        bad = ted4_say(m, "no initial point lies inside the bounds, and pictures show nothing "
                          "there");
    ted4_shown_free(&s);
    return bad ? -1 : 0;
}
