/* transient.c - see transient.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "transient.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "space.h"

/* Colours agree within this many of 255, averaged over the channels. */
#define COLOUR_NEAR   28.0f
/* Share of the cameras that must agree at the best time, and how far from the best a time may be to count. */
#define BEST_AGREES   0.5f
#define NEAR_BEST     0.7f
/* A span of more than this share of all times is no transient. */
#define LONGEST_SHARE 0.5f
enum { CAMERAS_NEEDED = 3 };

typedef struct {
    ted4_trainer  *t;
    const uint8_t *pixels;
    ted4_view      view;
    const uint8_t *colour;      /* [n][3] of anchors */
    uint16_t      *hits, *seen; /* [n_frames][n] cameras that agree, cameras that look there */
} match_job;

/* Counts one picture. */
static void match(const match_job *j, uint32_t frame)
{
    const ted4_anchors *a = &j->t->anchors;
    const ted4_view    *v = &j->view;

    for (size_t i = 0; i < a->n; i++) {
        const float x = *ted4_cell(a, TED4_ROW_POSITION, i, 0),
                    y = *ted4_cell(a, TED4_ROW_POSITION, i, 1),
                    z = *ted4_cell(a, TED4_ROW_POSITION, i, 2);
        const float cz = v->R[6] * x + v->R[7] * y + v->R[8] * z + v->t[2];

        if (cz <= v->near_z)
            continue;
        const float u = v->fx * (v->R[0] * x + v->R[1] * y + v->R[2] * z + v->t[0]) / cz + v->cx;
        const float w = v->fy * (v->R[3] * x + v->R[4] * y + v->R[5] * z + v->t[1]) / cz + v->cy;

        if (!(u >= 0 && w >= 0 && u < (float)v->width && w < (float)v->height))
            continue;
        const uint8_t *p = j->pixels + 3 * ((size_t)w * (size_t)v->width + (size_t)u);
        const uint8_t *c = j->colour + 3 * i;
        const int      far = abs(p[0] - c[0]) + abs(p[1] - c[1]) + abs(p[2] - c[2]);

        j->seen[frame * a->n + i]++;
        if ((float)far < 3.0f * COLOUR_NEAR)
            j->hits[frame * a->n + i]++;
    }
}

static int match_pictures(match_job *j)
{
    ted4_trainer *t = j->t;

    for (size_t i = 0; i < t->data->n_pictures; i++) {
        const ted4_picture *pic = &t->data->pictures[i];
        float               centre[3];

        if (pic->is_test)
            continue;
        for (size_t k = i + 1; k < t->data->n_pictures && k <= i + TED4_DATASET_AHEAD; k++)
            if (!t->data->pictures[k].is_test)
                ted4_dataset_ahead(t->data, k);
        j->pixels = ted4_dataset_pixels(t->data, i, &t->message);
        if (j->pixels == NULL)
            return -1;
        ted4_space_view(&t->layout.head, &pic->camera, &j->view, centre);
        match(j, pic->frame);
        ted4_dataset_release(t->data, i);
    }
    return 0;
}

/* Colour of the initial point nearest to each anchor. */
static void nearest_colours(const ted4_trainer *t, const float *points, uint8_t *colour)
{
    for (size_t i = 0; i < t->anchors.n; i++) {
        float  p[3], best = INFINITY;
        size_t at = 0;

        for (int k = 0; k < 3; k++)
            p[k] = *ted4_cell(&t->anchors, TED4_ROW_POSITION, i, k);
        for (size_t n = 0; n < t->data->n_points; n++) {
            const float x = points[3 * n] - p[0], y = points[3 * n + 1] - p[1],
                        z = points[3 * n + 2] - p[2];
            const float d = x * x + y * y + z * z;

            if (d < best) {
                best = d;
                at = n;
            }
        }
        memcpy(colour + 3 * i, t->data->point_rgb + 3 * at, 3);
    }
}

static float agreement(const match_job *j, uint32_t frame, size_t i)
{
    const size_t at = frame * j->t->anchors.n + i;

    return j->seen[at] >= CAMERAS_NEEDED ? (float)j->hits[at] / (float)j->seen[at] : 0.0f;
}

/* The run of times around the best one in which the colour is found, as a span; 0: not a transient. */
static int find_span(const match_job *j, size_t i, uint32_t *from, uint32_t *to)
{
    const uint32_t n = j->t->data->n_frames;
    uint32_t       best = 0, count = 0;
    float          top = 0;

    for (uint32_t f = 0; f < n; f++) {
        const float s = agreement(j, f, i);

        if (s > top) {
            top = s;
            best = f;
        }
    }
    for (uint32_t f = 0; f < n; f++)
        count += agreement(j, f, i) >= NEAR_BEST * top;
    if (top < BEST_AGREES || (float)count > LONGEST_SHARE * (float)n)
        return 0;
    *from = *to = best;
    while (*from > 0 && agreement(j, *from - 1, i) >= NEAR_BEST * top)
        --*from;
    while (*to + 1 < n && agreement(j, *to + 1, i) >= NEAR_BEST * top)
        ++*to;
    return 1;
}

/* Two frames of fading on each side leave the neighbouring times a say in where it came from and goes. */
static void set_span(ted4_trainer *t, size_t i, uint32_t from, uint32_t to)
{
    const int   first = t->layout.first[TED4_TAU];
    const float frame = 1.0f / (float)(t->data->n_frames - 1);

    *ted4_cell(&t->anchors, TED4_ROW_VALUE, i, first) = (float)from * frame;
    *ted4_cell(&t->anchors, TED4_ROW_VALUE, i, first + 1) = log2f(2.0f * frame);
    *ted4_cell(&t->anchors, TED4_ROW_VALUE, i, first + 2) = (float)to * frame;
    *ted4_cell(&t->anchors, TED4_ROW_VALUE, i, first + 3) = log2f(2.0f * frame);
}

int ted4_is_transient(const ted4_trainer *t, size_t i)
{
    const int first = t->layout.first[TED4_TAU];

    return first >= 0 && *ted4_cell(&t->anchors, TED4_ROW_VALUE, i, first + 2) -
                             *ted4_cell(&t->anchors, TED4_ROW_VALUE, i, first) < 1.0f;
}

int ted4_seed_transients(ted4_trainer *t)
{
    const size_t n = t->anchors.n, frames = t->data->n_frames;
    match_job    j = { .t = t };
    int          bad;

    if (t->layout.first[TED4_TAU] < 0 || frames < 2 || t->data->random_points ||
        t->data->point_rgb == NULL)
        return 0;
    float   *points = malloc((t->data->n_points + 1) * 3 * sizeof *points);
    uint8_t *colour = malloc(3 * n + 1);

    j.colour = colour;
    j.hits = calloc(frames * n + 1, sizeof *j.hits);
    j.seen = calloc(frames * n + 1, sizeof *j.seen);
    bad = points == NULL || colour == NULL || j.hits == NULL || j.seen == NULL;
    if (bad) {
        ted4_trainer_fail(t, "no memory to look for transients");
    } else {
        for (size_t i = 0; i < t->data->n_points; i++)
            ted4_space_point(&t->layout.head, t->data->points + 3 * i, points + 3 * i);
        nearest_colours(t, points, colour);
        bad = match_pictures(&j) != 0;
    }
    for (size_t i = 0; !bad && i < n; i++) {
        uint32_t from, to;

        if (find_span(&j, i, &from, &to))
            set_span(t, i, from, to);
    }
    free(points);
    free(colour);
    free(j.hits);
    free(j.seen);
    return bad ? -1 : 0;
}
