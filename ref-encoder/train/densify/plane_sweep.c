/* plane_sweep.c - finds places that the model fails to render, by plane sweeping (plane_sweep.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "plane_sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/math/voxel_set.h"
#include "math/elementary.h"
#include "error_view.h"
#include "photo_votes.h"
#include "sweep_depths.h"
#include "view_geometry.h"

/* Distance of consecutive depths: at most so many pixels in any other picture. */
#define PIXELS_APART 1.5f
enum { FEWEST_DEPTHS = 16, MOST_DEPTHS = 512 };

typedef struct {
    const ted4_sweep_view *views; /* borrowed: [n] pictures of the frame */
    size_t n, self;
    int step;          /* distance of the tested pixels */
    ted4_place *found; /* [rows][columns], with score 0 where nothing was found */
    int columns;
} search_job;

/* Returns approximately by how many pixels a point at inverse depth 1/z moves in the other picture
 * when 1/z changes by 1. */
static float parallax(const ted4_sweep_view *a, const ted4_sweep_view *b)
{
    float square = 0;

    for (int k = 0; k < 3; k++)
        square += (a->centre[k] - b->centre[k]) * (a->centre[k] - b->centre[k]);
    return sqrtf(square) * fmaxf(b->view.fx, b->view.fy);
}

static void count_depths(ted4_sweep_view *views, size_t n, size_t self)
{
    float farthest = 0;

    for (size_t i = 0; i < n; i++)
        farthest = fmaxf(farthest, parallax(&views[self], &views[i]));

    const float range = 1.0f / views[self].nearest - 1.0f / views[self].farthest;
    const float wanted = ceilf(range * farthest / PIXELS_APART);

    views[self].depths = (int)fmaxf(FEWEST_DEPTHS, fminf(wanted, MOST_DEPTHS));
}

void ted4_sweep_depths(const ted4_sweep_ray *r, int first, ted4_swept_depths *d)
{
    TED4_IN_USE(ted4_sweep_depths)(r, first, d);
}

/* Takes the best of some depths, if it is better than what was found. At least half of the cameras
 * that see a point must confirm it. error: of the pixel, in (0, 1]; step: distance of the tested
 * pixels, seen with focal length fx. */
static void take_best(const ted4_swept_depths *d, float error, float step, float fx,
                      ted4_place *best)
{
    for (int k = 0; k < TED4_DEPTHS; k++) {
        const float score = d->score[k] * error;

        if (d->agree[k] + 1 < TED4_CAMERAS_NEEDED || 2 * d->agree[k] < d->seen[k] ||
            score <= best->score)
            continue;
        for (int c = 0; c < 3; c++)
            best->point[c] = d->p[c][k];
        best->size = d->z[k] * step / fx;
        best->score = score;
    }
}

/* Finds the depth of a pixel that the other cameras confirm best. */
static void sweep(const search_job *j, int column, int row, ted4_place *best)
{
    const ted4_sweep_view *own = &j->views[j->self];
    const ted4_view *view = &own->view;
    const uint32_t pixel = own->pixel[(size_t)row * (size_t)view->width + (size_t)column];
    ted4_sweep_ray ray = { .views = j->views, .n = j->n, .self = j->self, .pixel = pixel };
    ted4_swept_depths d;

    ted4_view_ray(view, column, row, ray.ray);
    for (int k = 0; k < own->depths; k += TED4_DEPTHS) {
        ted4_sweep_depths(&ray, k, &d);
        take_best(&d, (float)(pixel >> 24) / 255.0f, (float)j->step, view->fx, best);
    }
    for (int c = 0; c < 3; c++)
        best->colour[c] = (uint8_t)(pixel >> 8 * c);
}

static void search_row(void *arg, size_t r)
{
    const search_job *j = arg;
    const ted4_sweep_view *own = &j->views[j->self];
    const int width = own->view.width, row = (int)r * j->step + j->step / 2;

    for (int c = 0; c < j->columns; c++) {
        ted4_place *place = &j->found[r * (size_t)j->columns + (size_t)c];
        const int column = c * j->step + j->step / 2;

        memset(place, 0, sizeof *place);
        if (row < own->view.height && column < width &&
            own->pixel[(size_t)row * (size_t)width + (size_t)column] >> 24 >= TED4_MISSING)
            sweep(j, column, row, place);
    }
}

static int put(ted4_places *l, const ted4_place *p)
{
    if (l->n == l->capacity) {
        const size_t size = l->capacity + l->capacity / 2 + 1024;
        ted4_place *item = realloc(l->item, size * sizeof *item);

        if (item == NULL)
            return -1;
        l->item = item;
        l->capacity = size;
    }
    l->item[l->n++] = *p;
    return 0;
}

/* Adds the places that one camera of the frame misses to the list. Returns 0, or -1 if memory ran
 * out. */
static int search_view(const ted4_trainer *t, ted4_sweep_view *views, size_t n, size_t self,
                       uint32_t frame, ted4_places *list)
{
    const int width = views[self].view.width, height = views[self].view.height;
    const int step = ted4_view_spacing(width);
    const size_t columns = (size_t)((width + step - 1) / step),
                 rows = (size_t)((height + step - 1) / step);
    search_job j = { views, n, self, step, malloc(rows * columns * sizeof *j.found), (int)columns };
    int bad = j.found == NULL;

    if (!bad)
        ted4_parallel_for(t->parallel, rows, search_row, &j);
    for (size_t i = 0; !bad && i < rows * columns; i++)
        if (j.found[i].score > 0) {
            j.found[i].frame = frame;
            bad = put(list, &j.found[i]) != 0;
        }
    free(j.found);
    return bad ? -1 : 0;
}

int ted4_place_compare(const void *x, const void *y)
{
    const ted4_place *a = x, *b = y;

    if (a->score != b->score)
        return a->score > b->score ? -1 : 1;
    if (a->frame != b->frame)
        return a->frame < b->frame ? -1 : 1;
    for (int k = 0; k < 3; k++)
        if (a->point[k] != b->point[k])
            return a->point[k] < b->point[k] ? -1 : 1;
    if (a->size != b->size)
        return a->size < b->size ? -1 : 1;
    return memcmp(a->colour, b->colour, sizeof a->colour);
}

/* Keeps, from index first on, the place of highest score in each voxel, and of these at most most,
 * by score. Returns 0, or -1 if memory ran out. */
static int thin(ted4_places *l, size_t first, size_t most)
{
    ted4_voxel_set taken;
    size_t n = first;

    if (l->n == first)
        return 0;
    if (ted4_voxel_set_init(&taken, l->n - first) != 0)
        return -1;
    qsort(l->item + first, l->n - first, sizeof *l->item, ted4_place_compare);
    for (size_t i = first; i < l->n && n < first + most; i++) {
        const double voxel = ted4_math_exp2(ceil(ted4_math_log2((double)l->item[i].size)));

        if (ted4_voxel_set_add(&taken, ted4_voxel_key(l->item[i].point, voxel)))
            l->item[n++] = l->item[i];
    }
    l->n = n;
    ted4_voxel_set_finish(&taken);
    return 0;
}

/* Opens a training picture; its pixels are freed by the caller, in either case. Returns 0, or -1
 * with t->message filled. */
static int open_view(ted4_trainer *t, size_t item, ted4_sweep_view *s)
{
    ted4_error_view e = { 0 };
    int bad = ted4_error_view_open(t, item, &e) != 0;
    const size_t n = (size_t)e.view.width * (size_t)e.view.height;

    if (!bad && (s->pixel = malloc(n * sizeof *s->pixel)) == NULL)
        bad = ted4_trainer_fail(t, "no memory to look for what is missing");
    for (size_t i = 0; !bad && i < n; i++)
        s->pixel[i] = e.rgb[3 * i] | (uint32_t)e.rgb[3 * i + 1] << 8 |
                      (uint32_t)e.rgb[3 * i + 2] << 16 | (uint32_t)e.error[i] << 24;
    s->view = e.view;
    memcpy(s->centre, e.centre, sizeof s->centre);
    s->nearest = e.nearest;
    s->farthest = e.farthest;
    ted4_error_view_close(&e);
    return bad ? -1 : 0;
}

/* Opens the training pictures of a frame in views[], or only counts them if views is NULL. Returns
 * their number. *bad becomes 1, with t->message filled, on failure. */
static size_t open_views(ted4_trainer *t, uint32_t frame, ted4_sweep_view *views, int *bad)
{
    size_t n = 0;

    for (size_t i = 0; !*bad && i < t->data->n_pictures; i++) {
        const ted4_picture *p = &t->data->pictures[i];

        if (p->is_test || p->frame != frame)
            continue;
        if (views != NULL)
            *bad = open_view(t, i, &views[n]) != 0;
        n++;
    }
    return n;
}

int ted4_mv_seed_search(ted4_trainer *t, uint32_t frame, ted4_places *list)
{
    const size_t first = list->n;
    int bad = 0;
    const size_t n = open_views(t, frame, NULL, &bad);

    if (n < TED4_CAMERAS_NEEDED)
        return 0;

    ted4_sweep_view *views = calloc(n, sizeof *views);

    if (views == NULL)
        return ted4_trainer_fail(t, "no memory to look for what is missing");
    open_views(t, frame, views, &bad);
    for (size_t i = 0; !bad && i < n; i++)
        count_depths(views, n, i);
    for (size_t i = 0; !bad && i < n; i++)
        if (search_view(t, views, n, i, frame, list) != 0)
            bad = ted4_trainer_fail(t, "no memory to look for what is missing");

    const size_t share = ted4_photo_votes_capacity(t->data->n_frames) / t->data->n_frames;

    if (!bad && thin(list, first, share > 0 ? share : 1) != 0)
        bad = ted4_trainer_fail(t, "no memory to look for what is missing");
    for (size_t i = 0; i < n; i++)
        free(views[i].pixel);
    free(views);
    return bad ? -1 : 0;
}
