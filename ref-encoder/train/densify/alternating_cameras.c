/* alternating_cameras.c - decides how many neighbouring frames are used with each frame if cameras
 * alternate (alternating_cameras.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "alternating_cameras.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/model/normalise.h"

/* Cameras are distinct if they are at least APART radians apart, as seen from the middle of the
 * scene. A camera that is nearer to the middle than NEAREST is treated as if it were at that
 * distance. */
#define APART   0.05f
#define NEAREST 0.25f
/* Limits of the reach, because moving parts move on during the neighbouring frames: at most
 * MOST_REACH frames on either side, and at most one in OF_FRAMES of all frames. */
enum { MOST_REACH = 4, OF_FRAMES = 8 };
/* This share of the frames that have a picture must have enough cameras around them. */
#define MOST_FRAMES 0.75
/* A window is searched for this many distinct cameras; more are not needed. */
enum { WANTED = TED4_CAMERAS_NEEDED + 1 };

int ted4_cameras_apart(const float a[3], const float b[3])
{
    float square = 0, far = NEAREST * NEAREST, other = 0;

    for (int k = 0; k < 3; k++) {
        square += (a[k] - b[k]) * (a[k] - b[k]);
        other += a[k] * a[k];
    }
    far = fmaxf(far, other);
    return square >= APART * APART * far;
}

/* The training pictures, sorted by frame: frame f has item[first[f]] to item[first[f + 1] - 1].
 * centre holds the centres of their cameras. */
typedef struct {
    uint32_t *first, *item; /* owned */
    float *centre;          /* owned: [n_pictures][3] */
    uint32_t n_frames;
} frames;

static void free_frames(frames *f)
{
    free(f->first);
    free(f->item);
    free(f->centre);
}

/* Returns 0, or -1 if memory ran out. */
static int list_frames(frames *f, const ted4_trainer *t)
{
    const ted4_dataset *d = t->data;

    f->n_frames = d->n_frames;
    f->first = calloc((size_t)d->n_frames + 2, sizeof *f->first);
    f->item = malloc((d->n_pictures + 1) * sizeof *f->item);
    f->centre = malloc((d->n_pictures + 1) * 3 * sizeof *f->centre);
    if (f->first == NULL || f->item == NULL || f->centre == NULL)
        return -1;
    for (size_t i = 0; i < d->n_pictures; i++) {
        ted4_view v;

        ted4_normalise_view(&t->layout.head, &d->pictures[i].camera, &v, f->centre + 3 * i);
        f->first[d->pictures[i].frame + 2] += !d->pictures[i].is_test;
    }
    for (uint32_t k = 0; k < d->n_frames; k++)
        f->first[k + 2] += f->first[k + 1];
    for (size_t i = 0; i < d->n_pictures; i++)
        if (!d->pictures[i].is_test)
            f->item[f->first[d->pictures[i].frame + 1]++] = (uint32_t)i;
    return 0;
}

/* Returns the number of distinct cameras of the pictures from one frame to another, at most
 * WANTED. */
static int cameras(const frames *f, uint32_t from, uint32_t to)
{
    const float *found[WANTED];
    int n = 0;

    for (uint32_t k = f->first[from]; k < f->first[to + 1] && n < WANTED; k++) {
        const float *c = f->centre + 3 * (size_t)f->item[k];
        int new = 1;

        for (int i = 0; i < n; i++)
            new &= ted4_cameras_apart(found[i], c);
        if (new)
            found[n++] = c;
    }
    return n;
}

/* Returns whether most frames have enough cameras within this reach. */
static int is_enough(const frames *f, uint32_t reach)
{
    uint32_t shown = 0, enough = 0;

    for (uint32_t k = 0; k < f->n_frames; k++) {
        const uint32_t from = k > reach ? k - reach : 0;
        const uint32_t to = k + reach < f->n_frames ? k + reach : f->n_frames - 1;

        if (f->first[k + 1] == f->first[k])
            continue;
        shown++;
        enough += cameras(f, from, to) == WANTED;
    }
    return shown > 0 && enough >= MOST_FRAMES * shown;
}

int ted4_alternating_reach(const ted4_trainer *t)
{
    frames f = { 0 };
    int reach = -1;

    if (list_frames(&f, t) == 0) {
        for (uint32_t k = 0; k < f.n_frames && reach < 0; k++)
            if (f.first[k + 1] - f.first[k] >= TED4_CAMERAS_NEEDED)
                reach = 0;
        for (uint32_t r = 1; r <= MOST_REACH && r * OF_FRAMES <= f.n_frames && reach < 0; r++)
            if (is_enough(&f, r))
                reach = (int)r;
    }
    free_frames(&f);
    return reach;
}
