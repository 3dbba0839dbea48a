/* views.c - see views.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "views.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera_path.h"
#include "cli.h"
#include "file_cameras.h"
#include "turn.h"

enum {
    STILL_STEPS = 30, /* pictures from key to key of a scene of one time */
    ORBIT_WIDTH = 1280,
    ORBIT_HEIGHT = 720, /* if the file has no cameras to take the size from */
};

/* An orbit around Gaussians: half the angle of view if the file has no cameras to take it from, and
 * how high the cameras stand, in radians; how much of the Gaussians' distances the circle leaves
 * inside the picture. */
static const double HALF_VIEW = 0.45, ELEVATION = 0.2, INSIDE = 0.8;

static int no_memory(const ted4_session *s)
{
    return ted4_session_failed(TED4_E_LIMIT_MEMORY, s);
}

/* Loads cameras of a JSON file; or, if its name is "file", those of a kind of the scene's file. */
static int load(ted4_session *s, const char *name, ted4_cams_kind kind, ted4_camera_list *l)
{
    char why[256];

    *l = (ted4_camera_list) { 0 };
    if (strcmp(name, "file") != 0) {
        if (ted4_camera_list_load(l, name, why, sizeof why) != 0)
            return ted4_session_refused(name, why);
        s->warned |= l->distorted;
        if (l->distorted)
            fprintf(stderr, "ted4dec: warning: %s: %s\n", name, TED4_CAMERA_LIST_DISTORTED);
        return TED4_EXIT_FINE;
    }
    if (ted4_file_cameras(s->data, s->size, kind, l) != 0)
        return no_memory(s);
    return l->n > 0 ? TED4_EXIT_FINE
                    : ted4_session_refused(s->set->input, kind == TED4_CAMS_PATH
                                                              ? "the file has no path of cameras"
                                                              : "the file has no cameras");
}

/* Returns the time of picture i of n when the scene plays once. */
static ted4_time playing(size_t i, size_t n)
{
    return n > 1 ? (ted4_time) { (uint32_t)i, (uint32_t)(n - 1) } : (ted4_time) { 0, 1 };
}

static double time_of_key(const ted4_session *s, const ted4_listed_camera *c)
{
    const ted4_time t = c->has_frame ? ted4_time_of_frame(c->frame, s->info.frames) : c->time;

    return (double)t.num / (double)t.den;
}

static int has_time(const ted4_listed_camera *c)
{
    return c->has_frame || c->time.den > 0;
}

/* Returns 1 if the times of the keys count, as in the player (player/page/path.js): all have one,
 * and they do not decrease. Otherwise warns if there are some. */
static int have_times(ted4_session *s, const ted4_camera_list *keys)
{
    const char *const name = strcmp(s->set->path, "file") == 0 ? s->set->input : s->set->path;
    size_t timed = 0, decreasing = 0;

    for (size_t i = 0; i < keys->n; i++)
        timed += (size_t)has_time(&keys->camera[i]);
    for (size_t i = 1; i < keys->n && timed == keys->n; i++)
        decreasing += time_of_key(s, &keys->camera[i]) < time_of_key(s, &keys->camera[i - 1]);
    if (timed == keys->n && decreasing == 0)
        return 1;
    if (timed > 0 && !s->set->has_time) {
        s->warned = 1;
        fprintf(stderr, "ted4dec: warning: %s: times are left out: %s\n", name,
                decreasing > 0 ? "they decrease" : "not all cameras have one");
    }
    return 0;
}

/* Returns the time of picture i of n of a path, between those of the keys. */
static ted4_time path_time(const ted4_session *s, const ted4_camera_list *keys, size_t i, size_t n)
{
    const double at = ted4_path_position(i, n, keys->n);
    const size_t last = keys->n - 1, k = at < (double)last ? (size_t)at : last,
                 next = k < last ? k + 1 : last;
    const double a = time_of_key(s, &keys->camera[k]), b = time_of_key(s, &keys->camera[next]);

    return ted4_time_of_part(a + (at - (double)k) * (b - a));
}

/* Makes room for n cameras in *l and n views in *view, the caller's. Returns an exit code. */
static int make_room(const ted4_session *s, size_t n, ted4_camera_list *l, ted4_view **view)
{
    l->camera = calloc(n, sizeof *l->camera);
    *view = calloc(n, sizeof **view);
    l->n = l->camera != NULL ? n : 0;
    return l->camera != NULL && *view != NULL ? TED4_EXIT_FINE : no_memory(s);
}

/* Checks that the scene has the frames of the keys, and that n pictures are not too many. Returns
 * an exit code. */
static int check_path(const ted4_session *s, const ted4_camera_list *keys, size_t n)
{
    char why[128];

    for (size_t i = 0; i < keys->n; i++)
        if (keys->camera[i].has_frame && keys->camera[i].frame >= s->info.frames)
            return ted4_session_refused(s->set->path, "a frame that the scene does not have");
    if (n <= TED4_MAX_VIEWS)
        return TED4_EXIT_FINE;
    snprintf(why, sizeof why, "the path would have %zu pictures; --views says how many, at most %d",
             n, TED4_MAX_VIEWS);
    return ted4_session_refused(s->set->input, why);
}

static int make_path(ted4_session *s)
{
    const ted4_settings *const set = s->set;
    ted4_camera_list keys;
    ted4_view *view = NULL;
    int code = load(s, set->path, TED4_CAMS_PATH, &keys);
    const size_t gaps = keys.n > 1 ? keys.n - 1 : 1;
    const size_t n = set->views > 0       ? (size_t)set->views
                     : s->info.frames > 1 ? s->info.frames
                                          : STILL_STEPS * gaps + 1;

    if (code == TED4_EXIT_FINE)
        code = check_path(s, &keys, n);
    if (code == TED4_EXIT_FINE)
        code = make_room(s, n, &s->cameras, &view);
    if (code == TED4_EXIT_FINE) {
        const int timed = have_times(s, &keys);

        ted4_path_between(&keys, n, view);
        for (size_t i = 0; i < n; i++)
            s->cameras.camera[i] =
                (ted4_listed_camera) { .view = view[i],
                                       .time = timed ? path_time(s, &keys, i, n) : playing(i, n) };
    }
    free(view);
    ted4_camera_list_free(&keys);
    return code;
}

/* ---- around the scene ---- */

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* The centre of the opaque Gaussians at the first time, by medians, and the distance within which
 * a share of INSIDE of them lie. Returns an exit code. */
static int look_at_gaussians(ted4_session *s, double centre[3], double *distance)
{
    const ted4_query q = { 0, 1, { s->info.origin[0], s->info.origin[1], s->info.origin[2] } };
    ted4_gaussians g;
    const ted4_status status = ted4_recon_query(s->recon, &q, &s->parallel, &g);
    double *const v = status == TED4_OK ? malloc((g.n + 1) * sizeof *v) : NULL;
    size_t n = 0;

    if (v == NULL)
        return status != TED4_OK ? ted4_session_failed(status, s) : no_memory(s);
    for (int c = 0; c < 3; c++) {
        n = 0;
        for (size_t i = 0; i < g.n; i++)
            if (g.opacity[i] > 0.1f)
                v[n++] = (double)g.mean[c][i];
        qsort(v, n, sizeof *v, by_value);
        centre[c] = n > 0 ? v[n / 2] : (double)s->info.origin[c];
    }
    n = 0;
    for (size_t i = 0; i < g.n; i++) {
        double square = 0.0;

        for (int c = 0; c < 3; c++)
            square += pow((double)g.mean[c][i] - centre[c], 2.0);
        if (g.opacity[i] > 0.1f)
            v[n++] = sqrt(square);
    }
    qsort(v, n, sizeof *v, by_value);
    *distance = n > 0 ? v[(size_t)(INSIDE * (double)(n - 1))] : ldexp(1.0, s->info.exponent);
    free(v);
    return TED4_EXIT_FINE;
}

/* Puts the principal point of a lens into the middle of its picture. Returns half the angle of view
 * across the picture, in radians, in the direction in which that is smaller. */
static double centre_lens(ted4_view *lens)
{
    const double x = 0.5 * lens->width, y = 0.5 * lens->height;

    lens->cx = (float)x;
    lens->cy = (float)y;
    return atan(fmin(x / (double)lens->fx, y / (double)lens->fy));
}

/* Sets a circle from which a lens has the Gaussians in its picture. half_view: half its angle of
 * view, in radians. Returns an exit code. */
static int circle_of_gaussians(ted4_session *s, double half_view, ted4_orbit *o)
{
    double reach = 0.0;
    const int code = look_at_gaussians(s, o->centre, &reach);
    const double distance = fmax(reach, 1e-6) / sin(half_view);

    o->radius = distance * cos(ELEVATION);
    o->height = distance * sin(ELEVATION);
    return code;
}

static int make_orbit(ted4_session *s)
{
    static const float down[3] = { 0.0f, -1.0f, 0.0f };
    const float *const asked = ted4_session_up(s), *const known = s->up;
    const float *const up = ted4_has_direction(asked)   ? asked
                            : ted4_has_direction(known) ? known
                                                        : down;
    const size_t n = (size_t)s->set->orbit;
    const float focal = (float)(ORBIT_HEIGHT / 2 / tan(HALF_VIEW));
    ted4_orbit o = { .lens = { .width = ORBIT_WIDTH,
                               .height = ORBIT_HEIGHT,
                               .fx = focal,
                               .fy = focal,
                               .cx = ORBIT_WIDTH / 2.0f,
                               .cy = ORBIT_HEIGHT / 2.0f } };
    ted4_camera_list taken;
    ted4_view *view = NULL;
    int code = ted4_file_cameras(s->data, s->size, TED4_CAMS_TAKEN, &taken) == 0 ? TED4_EXIT_FINE
                                                                                 : no_memory(s);

    for (int k = 0; k < 3; k++)
        o.up[k] = (double)up[k];
    if (taken.n > 0)
        o.lens = taken.camera[0].view;
    if (code == TED4_EXIT_FINE && taken.n > 0 && ted4_orbit_pivot(&taken, o.centre) == 0)
        ted4_orbit_of_cameras(&taken, &o);
    else if (code == TED4_EXIT_FINE)
        code = circle_of_gaussians(s, taken.n > 0 ? centre_lens(&o.lens) : HALF_VIEW, &o);
    if (code == TED4_EXIT_FINE)
        code = make_room(s, n, &s->cameras, &view);
    if (code == TED4_EXIT_FINE) {
        ted4_orbit_around(&o, n, view);
        for (size_t i = 0; i < n; i++)
            s->cameras.camera[i] = (ted4_listed_camera) { .view = view[i], .time = playing(i, n) };
    }
    free(view);
    ted4_camera_list_free(&taken);
    return code;
}

int ted4_views_make(ted4_session *s)
{
    const ted4_settings *const set = s->set;
    int code = TED4_EXIT_FINE;

    if (set->cameras != NULL)
        code = load(s, set->cameras, TED4_CAMS_TAKEN, &s->cameras);
    else if (set->path != NULL)
        code = make_path(s);
    else if (set->orbit > 0)
        code = make_orbit(s);
    for (size_t i = 0; i < s->cameras.n; i++) {
        ted4_listed_camera *const c = &s->cameras.camera[i];

        if (set->has_time) {
            c->has_frame = 0;
            c->time = s->time;
        } else if (!c->has_frame && c->time.den == 0) {
            c->time = (ted4_time) { 0, 1 };
        }
    }
    return code;
}
