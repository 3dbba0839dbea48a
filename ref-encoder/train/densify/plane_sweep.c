/* plane_sweep.c - finds places that the model fails to render, by plane sweeping (plane_sweep.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "plane_sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/math/voxel_set.h"
#include "math/elementary.h"
#include "photo_votes.h"
#include "error_view.h"

/* Distance of consecutive depths: at most so many pixels in any other picture. */
#define PIXELS_APART 1.5f
enum { FEWEST_DEPTHS = 16, MOST_DEPTHS = 512 };
/* One picture of the frame. */
typedef struct {
    ted4_error_view at;
    int depths; /* number of tested depths */
} sweep_view;

typedef struct {
    const sweep_view *views;
    size_t n, self;
    int step;          /* distance of the tested pixels */
    ted4_place *found; /* [rows][columns], with score 0 where nothing was found */
    int columns;
} search_job;

/* Returns approximately by how many pixels a point at inverse depth 1/z moves in the other picture
 * when 1/z changes by 1. */
static float parallax(const ted4_error_view *a, const ted4_error_view *b)
{
    float square = 0;

    for (int k = 0; k < 3; k++)
        square += (a->centre[k] - b->centre[k]) * (a->centre[k] - b->centre[k]);
    return sqrtf(square) * fmaxf(b->view.fx, b->view.fy);
}

static void count_depths(sweep_view *views, size_t n, size_t self)
{
    float farthest = 0;

    for (size_t i = 0; i < n; i++)
        farthest = fmaxf(farthest, parallax(&views[self].at, &views[i].at));

    const float range = 1.0f / views[self].at.nearest - 1.0f / views[self].at.farthest;
    const float wanted = ceilf(range * farthest / PIXELS_APART);

    views[self].depths = (int)fmaxf(FEWEST_DEPTHS, fminf(wanted, MOST_DEPTHS));
}

/* Returns how well the other picture confirms the point, in (0, 1], or 0 if it does not.
 * *observed: whether the point lies in that picture. */
static float confirm(const ted4_error_view *e, const float p[3], const uint8_t colour[3],
                     int *observed)
{
    size_t pixel;
    float depth;

    *observed = ted4_view_pixel(&e->view, p, &pixel, &depth);
    if (!*observed || e->error[pixel] < TED4_MISSING / 2 ||
        !ted4_colour_agrees(e->rgb + 3 * pixel, colour))
        return 0.0f;
    return 1.0f -
           (float)ted4_colour_far(e->rgb + 3 * pixel, colour) / (3.0f * TED4_COLOUR_NEAR + 1.0f);
}

/* Finds the depth of a pixel that the other cameras confirm best. At least half of those that see
 * the point must confirm it. */
static void sweep(const search_job *j, int column, int row, ted4_place *best)
{
    const ted4_error_view *own = &j->views[j->self].at;
    const size_t pixel = (size_t)row * (size_t)own->view.width + (size_t)column;
    const uint8_t *colour = own->rgb + 3 * pixel;
    const int depths = j->views[j->self].depths;

    for (int k = 0; k < depths; k++) {
        const float part = (float)k / (float)(depths - 1);
        const float z = 1.0f / ((1.0f - part) / own->nearest + part / own->farthest);
        float p[3], score = 0;
        int seen = 0, agree = 0;

        ted4_view_point(&own->view, column, row, z, p);
        if (fabsf(p[0]) > 1.0f || fabsf(p[1]) > 1.0f || fabsf(p[2]) > 1.0f)
            continue;
        for (size_t i = 0; i < j->n; i++) {
            int observed;

            if (i == j->self)
                continue;
            const float s = confirm(&j->views[i].at, p, colour, &observed);

            seen += observed;
            agree += s > 0;
            score += s;
        }
        score *= (float)own->error[pixel] / 255.0f;
        if (agree + 1 < TED4_CAMERAS_NEEDED || 2 * agree < seen || score <= best->score)
            continue;
        memcpy(best->point, p, sizeof p);
        best->size = z * (float)j->step / own->view.fx;
        best->score = score;
    }
    memcpy(best->colour, colour, 3);
}

static void search_row(void *arg, size_t r)
{
    const search_job *j = arg;
    const ted4_error_view *own = &j->views[j->self].at;
    const int row = (int)r * j->step + j->step / 2;

    for (int c = 0; c < j->columns; c++) {
        ted4_place *place = &j->found[r * (size_t)j->columns + (size_t)c];
        const int column = c * j->step + j->step / 2;

        memset(place, 0, sizeof *place);
        if (row < own->view.height && column < own->view.width &&
            own->error[(size_t)row * (size_t)own->view.width + (size_t)column] >= TED4_MISSING)
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
static int search_view(const ted4_trainer *t, sweep_view *views, size_t n, size_t self,
                       uint32_t frame, ted4_places *list)
{
    const int width = views[self].at.view.width, height = views[self].at.view.height;
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

/* Opens the training pictures of a frame in views[], or only counts them if views is NULL. Returns
 * their number. *bad becomes 1, with t->message filled, on failure. */
static size_t open_views(ted4_trainer *t, uint32_t frame, sweep_view *views, int *bad)
{
    size_t n = 0;

    for (size_t i = 0; !*bad && i < t->data->n_pictures; i++) {
        const ted4_picture *p = &t->data->pictures[i];

        if (p->is_test || p->frame != frame)
            continue;
        if (views != NULL)
            *bad = ted4_error_view_open(t, i, &views[n].at) != 0;
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

    sweep_view *views = calloc(n, sizeof *views);

    if (views == NULL)
        return ted4_trainer_fail(t, "no memory to look for what is missing");
    open_views(t, frame, views, &bad);
    for (size_t i = 0; !bad && i < n; i++)
        count_depths(views, n, i);
    for (size_t i = 0; !bad && i < n; i++)
        if (search_view(t, views, n, i, frame, list) != 0)
            bad = ted4_trainer_fail(t, "no memory to look for what is missing");

    const size_t share = ted4_mv_seed_capacity(t->data->n_frames) / t->data->n_frames;

    if (!bad && thin(list, first, share > 0 ? share : 1) != 0)
        bad = ted4_trainer_fail(t, "no memory to look for what is missing");
    for (size_t i = 0; i < n; i++)
        ted4_error_view_close(&views[i].at);
    free(views);
    return bad ? -1 : 0;
}
