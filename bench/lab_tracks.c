/* lab_tracks.c - computes where the anchors of a decoded file are at every time of its scene, and
 * whether they are drawn: see lab_facts.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "lab_facts.h"
#include "math/compare.h"
#include "tool/cli.h"
#include "train/model/normalise.h"

/* Computes lab_tracks.size, or the side of the file's space if there are no usable points. Returns
 * -1 without memory. */
static double scene_size(const lab_session *s)
{
    const size_t n = s->data.n_points;
    float *const x = malloc((n + 1) * sizeof *x);
    double size = 0;

    if (x == NULL)
        return -1;
    for (size_t c = 0; c < 3 && n > 0; c++) {
        for (size_t i = 0; i < n; i++)
            x[i] = s->data.points[3 * i + c];
        qsort(x, n, sizeof *x, ted4_compare_floats);
        size = fmax(size, (double)x[(n - 1) * 99 / 100] - (double)x[(n - 1) / 100]);
    }
    free(x);
    return size > 0 ? size : ldexp(2.0, s->info.exponent);
}

static int fill_rigs(const lab_session *s, lab_tracks *t)
{
    for (size_t i = 0; i < s->data.n_pictures; i++)
        t->rig[s->data.pictures[i].frame].n += !s->data.pictures[i].is_test;
    for (size_t time = 0; time < t->n_times; time++) {
        t->rig[time].camera = malloc((t->rig[time].n + 1) * sizeof *t->rig[time].camera);
        if (t->rig[time].camera == NULL)
            return -1;
        t->rig[time].n = 0;
    }
    for (size_t i = 0; i < s->data.n_pictures; i++) {
        const ted4_picture *const p = &s->data.pictures[i];
        lab_rig *const rig = &t->rig[p->frame];

        if (!p->is_test)
            rig->camera[rig->n++] = &p->camera;
    }
    return 0;
}

static int reserve(const lab_session *s, lab_tracks *t)
{
    const size_t n = s->info.n_anchors, times = s->data.n_frames > 0 ? s->data.n_frames : 1;

    memset(t, 0, sizeof *t);
    t->n = n;
    t->n_times = times;
    t->near_z = ldexp(TED4_VIEW_NEAR, s->info.exponent);
    t->size = scene_size(s);
    t->centre = calloc(times * n * 3 + 1, sizeof *t->centre);
    t->drawn = calloc(times * n + 1, 1);
    t->rig = calloc(times, sizeof *t->rig);
    return t->size < 0 || t->centre == NULL || t->drawn == NULL || t->rig == NULL ||
                   fill_rigs(s, t) != 0
               ? -1
               : 0;
}

/* Stores the Gaussians of one time in the tracks. */
static void take_time(const lab_session *s, const ted4_gaussians *g, size_t time, lab_tracks *t)
{
    float *const centre = t->centre + 3 * time * t->n;
    uint8_t *const drawn = t->drawn + time * t->n;
    size_t n = 0;

    /* The records of an anchor are consecutive. */
    for (size_t i = 0; i < g->n; i++) {
        const size_t anchor = g->id[i] / s->info.n_offsets;

        n = i > 0 && g->id[i - 1] / s->info.n_offsets == anchor ? n + 1 : 1;
        for (size_t c = 0; c < 3; c++)
            centre[3 * anchor + c] += (g->mean[c][i] - centre[3 * anchor + c]) / (float)n;
        drawn[anchor] |= g->opacity[i] >= TED4_RASTER_ALPHA_MIN;
    }
}

/* What has been observed for each Gaussian so far. */
enum { WAS_SEEN = 1, WAS_FULL = 2, WAS_THIN = 4, WAS_HUGE = 8 };

static void take_extremes(const lab_session *s, const ted4_gaussians *g, uint8_t *met)
{
    const float unit = ldexpf(1.0f, s->info.exponent);

    for (size_t i = 0; i < g->n; i++) {
        met[i] |= (g->opacity[i] > 0 ? WAS_SEEN : 0) | (g->opacity[i] >= 1.0f ? WAS_FULL : 0);
        for (int c = 0; c < 3; c++)
            met[i] |= (g->scale[c][i] < 0x1p-20f * unit ? WAS_THIN : 0) |
                      (g->scale[c][i] > unit ? WAS_HUGE : 0);
    }
}

/* A time that the decoder refuses has no cameras, so that it counts nowhere. */
static int take_query(lab_session *s, size_t time, lab_tracks *t, lab_gaussians *g, uint8_t *met)
{
    ted4_query q = { .num = (uint32_t)time, .den = t->n_times > 1 ? (uint32_t)t->n_times - 1 : 1 };
    const ted4_header world = { 0 };
    ted4_gaussians records;
    ted4_view view;

    if (t->rig[time].n > 0)
        ted4_normalise_view(&world, t->rig[time].camera[0], &view, q.camera);

    const ted4_status status = ted4_recon_query(s->recon, &q, NULL, &records);

    if (status == TED4_E_REC_NONFINITE) {
        g->refused++;
        t->rig[time].n = 0;
        return TED4_EXIT_FINE;
    }
    if (status != TED4_OK)
        return lab_failed("query", ted4_status_id(status));
    take_time(s, &records, time, t);
    take_extremes(s, &records, met);
    return TED4_EXIT_FINE;
}

int lab_make_tracks(lab_session *s, lab_tracks *t, lab_gaussians *g)
{
    uint8_t *const met = calloc(s->info.n_gaussians + 1, 1);
    int code = TED4_EXIT_FINE;

    *g = (lab_gaussians) { .gaussians = s->info.n_gaussians };
    if (reserve(s, t) != 0 || met == NULL)
        code = lab_failed("tracks", "out of memory");
    for (size_t time = 0; time < t->n_times && code == TED4_EXIT_FINE; time++)
        code = take_query(s, time, t, g, met);
    for (size_t i = 0; i < g->gaussians && code == TED4_EXIT_FINE; i++) {
        g->dead += (met[i] & WAS_SEEN) == 0;
        g->full += (met[i] & WAS_FULL) != 0;
        g->thin += (met[i] & WAS_THIN) != 0;
        g->huge += (met[i] & WAS_HUGE) != 0;
    }
    free(met);
    return code;
}

void lab_free_tracks(lab_tracks *t)
{
    for (size_t time = 0; t->rig != NULL && time < t->n_times; time++)
        free(t->rig[time].camera);
    free(t->rig);
    free(t->centre);
    free(t->drawn);
    memset(t, 0, sizeof *t);
}
