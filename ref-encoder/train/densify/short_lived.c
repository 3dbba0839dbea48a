/* short_lived.c - finds short-lived anchors, and sets the span of their activation
 * (short_lived.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "short_lived.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "photo_votes.h"
#include "train/model/normalise.h"

/* points: the initial points, normalised. Of each anchor: place, its position, and colour, that of
 * the initial point nearest to it. */
typedef struct {
    ted4_trainer *trainer;
    float *points, *place;
    uint8_t *colour;
} description;

/* Describes one anchor. All points are looked at, so that this takes longer than reading the
 * pictures if the points are many; anchors are shared among the threads. */
static void describe(void *arg, size_t i)
{
    const description *d = arg;
    const ted4_trainer *t = d->trainer;
    float *p = d->place + 3 * i, best = INFINITY;
    size_t at = 0;

    for (int k = 0; k < 3; k++)
        p[k] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, k);
    for (size_t n = 0; n < t->data->n_points; n++) {
        const float x = d->points[3 * n] - p[0], y = d->points[3 * n + 1] - p[1],
                    z = d->points[3 * n + 2] - p[2];
        const float square = x * x + y * y + z * z;

        if (square < best) {
            best = square;
            at = n;
        }
    }
    memcpy(d->colour + 3 * i, t->data->point_rgb + 3 * at, 3);
}

int ted4_is_short_lived(const ted4_trainer *t, size_t i)
{
    const int first = t->layout.first[TED4_TAU];

    return first >= 0 && *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first + 2) -
                                 *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first) <
                             1.0f;
}

/* Sets the spans of n anchors from the first on. place, colour: of these anchors. */
static int set_spans(ted4_trainer *t, size_t first, const float *place, const uint8_t *colour,
                     size_t n)
{
    ted4_photo_votes s;
    const int bad = ted4_photo_votes_count(&s, t, place, colour, n) != 0;

    for (size_t i = 0; !bad && i < n; i++) {
        ted4_span span;

        if (ted4_photo_votes_span(&s, i, ted4_photo_votes_best(&s, i), &span))
            ted4_span_set(t, first + i, &span);
    }
    ted4_photo_votes_free(&s);
    return bad ? -1 : 0;
}

int ted4_init_short_lived(ted4_trainer *t, size_t most)
{
    const size_t n = t->anchors.n;
    int bad;

    if (t->layout.first[TED4_TAU] < 0 || t->data->n_frames < 2 || t->data->random_points ||
        t->data->point_rgb == NULL || ted4_most_cameras(t->data) < TED4_CAMERAS_NEEDED)
        return 0;
    description d = { t, malloc((t->data->n_points + 1) * 3 * sizeof *d.points),
                      malloc((n + 1) * 3 * sizeof *d.place), malloc(3 * n + 1) };

    bad = d.points == NULL || d.place == NULL || d.colour == NULL;
    if (bad) {
        ted4_trainer_fail(t, "no memory to look for transients");
    } else {
        for (size_t i = 0; i < t->data->n_points; i++)
            ted4_normalise_point(&t->layout.head, t->data->points + 3 * i, d.points + 3 * i);
        ted4_parallel_for(t->parallel, n, describe, &d);
    }
    for (size_t first = 0; !bad && first < n; first += most)
        bad = set_spans(t, first, d.place + 3 * first, d.colour + 3 * first,
                        n - first < most ? n - first : most) != 0;
    free(d.points);
    free(d.place);
    free(d.colour);
    return bad ? -1 : 0;
}
