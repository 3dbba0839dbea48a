/* depth_points.c - see depth_points.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/depth_points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "data/data_util.h"

/* Two maps agree about a cell if their inverse depths differ by at most so many planes. */
#define AGREED 1.5
/* The share of the maps that see a point which must agree: it may be hidden in others. */
#define SHARE  0.5

typedef struct {
    size_t item;    /* of the shown pictures */
    float *inverse; /* owned: [cells], as ted4_depth_map gives it */
    float *good;    /* owned: [cells] mean with those of the maps that confirm it; 0: none does */
    int failed;
} map;

typedef struct {
    const ted4_sweep *w;
    ted4_reduced reduced[TED4_SHOWN_MOST];
    map map[TED4_DEPTH_MAPS];
    size_t n; /* of maps */
} maps;

static const ted4_picture *picture(const maps *m, size_t item)
{
    return &m->w->shown->data->pictures[m->w->shown->picture[item]];
}

static size_t cells_of(const ted4_reduced *r)
{
    return (size_t)r->camera.width * (size_t)r->camera.height;
}

/* Lists the different frames of the shown pictures, in their order. */
static uint32_t list_frames(const maps *m, uint32_t frame[TED4_SHOWN_MOST])
{
    uint32_t n = 0;

    for (size_t i = 0; i < m->w->shown->n; i++) {
        uint32_t k = 0;

        while (k < n && frame[k] != picture(m, i)->frame)
            k++;
        if (k == n)
            frame[n++] = picture(m, i)->frame;
    }
    return n;
}

/* Chooses all pictures of evenly spaced frames, or of these evenly spaced ones if a single frame
 * has more than TED4_DEPTH_MAPS. */
static void choose(maps *m)
{
    uint32_t frame[TED4_SHOWN_MOST];
    const size_t pictures = m->w->shown->n, frames = list_frames(m, frame);
    const size_t each = frames > 0 ? (pictures + frames - 1) / frames : 1;
    const size_t wanted = each < TED4_DEPTH_MAPS ? TED4_DEPTH_MAPS / each : 1;
    const size_t taken = wanted < frames ? wanted : frames;
    size_t item[TED4_SHOWN_MOST], n = 0;

    for (size_t i = 0; i < pictures; i++) {
        size_t k = 0;

        while (k < taken && frame[(2 * k + 1) * frames / (2 * taken)] != picture(m, i)->frame)
            k++;
        if (k < taken)
            item[n++] = i;
    }
    m->n = n < TED4_DEPTH_MAPS ? n : TED4_DEPTH_MAPS;
    for (size_t i = 0; i < m->n; i++)
        m->map[i].item = item[i * n / m->n];
}

static void make_map(void *arg, size_t i)
{
    maps *m = arg;
    map *own = &m->map[i];
    const ted4_reduced *helper[TED4_SWEEP_HELPERS], *r = &m->reduced[own->item];
    const int n = m->w->n_helpers[own->item];

    for (int h = 0; h < n; h++)
        helper[h] = &m->reduced[m->w->helper[own->item][h]];
    own->inverse = malloc(cells_of(r) * sizeof *own->inverse);
    own->good = calloc(cells_of(r), sizeof *own->good);
    own->failed = own->inverse == NULL || own->good == NULL ||
                  ted4_depth_map(m->w, r, helper, n, own->inverse) != 0;
}

/* Returns what another map says of a point: 1 if it confirms it, -1 if it sees through it, 0 if it
 * says nothing, as where something hides the point. *ratio: the map's inverse depth there as a
 * multiple of that of the point, if it is confirmed. */
static int judge(const maps *m, const map *other, const double p[3], double *ratio)
{
    const ted4_reduced *r = &m->reduced[other->item];
    const ted4_camera *c = &r->camera;
    const double step = AGREED * ted4_depth_step(m->w);
    double q[3];

    for (int k = 0; k < 3; k++)
        q[k] = c->R[3 * k] * p[0] + c->R[3 * k + 1] * p[1] + c->R[3 * k + 2] * p[2] + c->t[k];
    if (!(q[2] > 0))
        return 0;

    const double x = c->fx * q[0] / q[2] + c->cx, y = c->fy * q[1] / q[2] + c->cy;

    if (!(x >= 0 && y >= 0 && x < c->width && y < c->height))
        return 0;

    const double found = (double)other->inverse[(size_t)y * (size_t)c->width + (size_t)x];

    if (!(found > 0) || found > 1 / q[2] + step)
        return 0;
    *ratio = found * q[2];
    return found >= 1 / q[2] - step ? 1 : -1;
}

/* Returns whether map k may judge map i: if the helpers of i are of its own frame, only maps of
 * that frame may, so that what moves has depths, too. */
static int may_judge(const maps *m, size_t k, size_t i)
{
    const size_t item = m->map[i].item;
    const uint32_t frame = picture(m, item)->frame;
    const int same = m->w->n_helpers[item] > 0 && picture(m, m->w->helper[item][0])->frame == frame;

    return k != i && (!same || picture(m, m->map[k].item)->frame == frame);
}

static void check_map(void *arg, size_t i)
{
    maps *m = arg;
    const map *own = &m->map[i];
    const ted4_reduced *r = &m->reduced[own->item];

    for (size_t cell = 0; cell < cells_of(r); cell++) {
        int yes = 0, no = 0;
        double p[3], sum = 1;

        if (!(own->inverse[cell] > 0))
            continue;
        ted4_sweep_point(&r->camera, cell, 1 / (double)own->inverse[cell], p);
        for (size_t k = 0; k < m->n; k++) {
            double ratio = 0;
            const int says = may_judge(m, k, i) ? judge(m, &m->map[k], p, &ratio) : 0;

            yes += says > 0;
            no += says < 0;
            sum += says > 0 ? ratio : 0;
        }
        if (yes > 0 && yes >= SHARE * (yes + no))
            own->good[cell] = (float)((double)own->inverse[cell] * sum / (yes + 1));
    }
}

/* Makes and checks all maps. Returns 0, or -1 if memory ran out. */
static int make_maps(maps *m, const ted4_parallel *p)
{
    int bad = 0;

    for (size_t i = 0; !bad && i < m->w->shown->n; i++)
        bad = ted4_reduce(&m->reduced[i], m->w->shown, i) != 0;
    if (bad)
        return -1;
    choose(m);
    ted4_parallel_for(p, m->n, make_map, m);
    for (size_t i = 0; i < m->n; i++)
        bad |= m->map[i].failed;
    if (!bad)
        ted4_parallel_for(p, m->n, check_map, m);
    return bad ? -1 : 0;
}

static void free_maps(maps *m)
{
    for (size_t i = 0; i < TED4_SHOWN_MOST; i++)
        ted4_reduced_free(&m->reduced[i]);
    for (size_t i = 0; i < m->n; i++) {
        free(m->map[i].inverse);
        free(m->map[i].good);
    }
    free(m);
}

/* A point, and a random number that orders all of them. */
typedef struct {
    uint64_t order;
    uint32_t map, cell;
    float xyz[3];
} candidate;

static int compare(const void *x, const void *y)
{
    const candidate *a = x, *b = y;

    if (a->order != b->order)
        return a->order < b->order ? -1 : 1;
    if (a->map != b->map)
        return a->map < b->map ? -1 : 1;
    return (a->cell > b->cell) - (a->cell < b->cell);
}

/* Lists the confirmed cells that are wanted, in random order. Owned by the caller; NULL if memory
 * ran out. */
static candidate *list(const maps *m, const ted4_depth_wanted *o, size_t *n)
{
    candidate *c;
    size_t most = 0;

    for (size_t i = 0; i < m->n; i++)
        most += cells_of(&m->reduced[m->map[i].item]);
    c = malloc((most + 1) * sizeof *c);
    *n = 0;
    for (size_t i = 0; c != NULL && i < m->n; i++)
        for (size_t k = 0; k < cells_of(&m->reduced[m->map[i].item]); k++) {
            uint64_t state = (uint64_t)o->seed << 40 ^ (uint64_t)i << 24 ^ (uint64_t)k;
            double world[3];

            if (!(m->map[i].good[k] > 0))
                continue;
            ted4_sweep_point(&m->reduced[m->map[i].item].camera, k, 1 / (double)m->map[i].good[k],
                             world);
            for (int j = 0; j < 3; j++)
                c[*n].xyz[j] = (float)world[j];
            if (!o->keep(o->user, c[*n].xyz))
                continue;
            c[*n].map = (uint32_t)i;
            c[*n].cell = (uint32_t)k;
            c[(*n)++].order = (uint64_t)(ted4_split_uniform(&state) * 0x1p53);
        }
    if (c != NULL)
        qsort(c, *n, sizeof *c, compare);
    return c;
}

int ted4_depth_points(ted4_point_cloud *c, const ted4_sweep *w, const ted4_depth_wanted *o,
                      const ted4_parallel *p)
{
    maps *m = calloc(1, sizeof *m);
    candidate *all = NULL;
    size_t n = 0;
    int bad = m == NULL;

    memset(c, 0, sizeof *c);
    if (bad)
        return -1;
    m->w = w;
    bad = make_maps(m, p) != 0 || (all = list(m, o, &n)) == NULL ||
          ted4_point_cloud_alloc(c, n < o->most ? n : o->most) != 0;
    for (size_t i = 0; !bad && i < c->n; i++) {
        memcpy(c->xyz + 3 * i, all[i].xyz, sizeof all[i].xyz);
        memcpy(c->rgb + 3 * i, m->reduced[m->map[all[i].map].item].cell + 4 * (size_t)all[i].cell,
               3);
    }
    free_maps(m);
    free(all);
    return bad ? -1 : 0;
}
