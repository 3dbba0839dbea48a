/* sv_seed.c - finds what moves before one or two cameras, and plants anchors there (sv_seed.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "sv_seed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cell_view.h"
#include "seed_anchor.h"
#include "train/state/arrangement.h"
#include "viewpoints.h"

/* So many pictures before and after a picture tell at which depth something is. */
enum { BESIDE = 3, RING = 2 * BESIDE + 1 };
/* Motion and errors of the depth move what a picture shows by at most this many cells in another
 * picture. */
#define MOST_CELLS 6
/* Tested depths, evenly spaced in their inverses, from the rendered depth towards the camera. */
enum { DEPTHS = 24 };
/* The first tested depth, as a share of the rendered one: in front of what hides it now. */
#define IN_FRONT 0.97f
/* A nearer depth must explain the other pictures with so much less motion, in cells per frame. */
#define CLEARLY  0.1f
/* Cells of at most so many apart are searched, so that even a small budget reaches every picture.
 */
enum { WIDEST = 32 };

/* Offsets in cells, at most MOST_CELLS long, in order of length. */
typedef struct {
    int n, x[169], y[169];
    float length[169];
} disk;

static void fill_disk(disk *d)
{
    d->n = 0;
    for (int square = 0; square <= MOST_CELLS * MOST_CELLS; square++)
        for (int y = -MOST_CELLS; y <= MOST_CELLS; y++)
            for (int x = -MOST_CELLS; x <= MOST_CELLS; x++) {
                if (x * x + y * y != square)
                    continue;
                d->x[d->n] = x;
                d->y[d->n] = y;
                d->length[d->n++] = sqrtf((float)square);
            }
}

typedef struct {
    uint32_t frame, item;
} shot;

/* The training pictures in the order of their frames, and cells of some of them. */
typedef struct {
    shot *shot; /* owned: [n] */
    size_t n;
    ted4_cell_view view[RING]; /* of picture i in view[i % RING] */
    size_t open;               /* pictures before this one have been opened */
    disk disk;
} film;

static void free_film(film *f)
{
    for (int i = 0; i < RING; i++)
        ted4_cell_view_close(&f->view[i]);
    free(f->shot);
}

static int compare_shots(const void *x, const void *y)
{
    const shot *a = x, *b = y;

    if (a->frame != b->frame)
        return a->frame < b->frame ? -1 : 1;
    return a->item < b->item ? -1 : a->item > b->item;
}

/* Returns 0, or -1 if memory ran out. */
static int list_pictures(film *f, const ted4_dataset *d)
{
    f->shot = malloc((d->n_pictures + 1) * sizeof *f->shot);
    if (f->shot == NULL)
        return -1;
    for (size_t i = 0; i < d->n_pictures; i++)
        if (!d->pictures[i].is_test)
            f->shot[f->n++] = (shot) { d->pictures[i].frame, (uint32_t)i };
    qsort(f->shot, f->n, sizeof *f->shot, compare_shots);
    fill_disk(&f->disk);
    return 0;
}

int ted4_sv_seed_applies(const ted4_trainer *t)
{
    const uint32_t most = ted4_most_cameras(t->data);

    return t->layout.first[TED4_TAU] >= 0 && t->data->n_frames >= 2 && most > 0 &&
           most < TED4_CAMERAS_NEEDED && ted4_has_viewpoints(t);
}

/* Opens the pictures up to BESIDE after picture i. Returns 0, or -1 with t->message filled. */
static int advance(film *f, ted4_trainer *t, size_t i)
{
    for (; f->open < f->n && f->open <= i + BESIDE; f->open++) {
        ted4_cell_view *v = &f->view[f->open % RING];

        ted4_cell_view_close(v);
        if (ted4_cell_view_open(t, f->shot[f->open].item, 1, v) != 0)
            return -1;
    }
    return 0;
}

/* Returns how far, in cells, the nearest cell of another picture that misses something of that
 * colour, too, lies from the one at which the picture sees p; more than MOST_CELLS if there is
 * none, or if p is outside the picture: a point near a camera is outside all others. */
static float away(const disk *d, const ted4_cell_view *v, const float p[3], const uint8_t colour[3])
{
    int column, row;

    if (!ted4_cell_of(v, p, &column, &row))
        return MOST_CELLS + 1;
    for (int k = 0; k < d->n; k++) {
        const int x = column + d->x[k], y = row + d->y[k];

        if (x < 0 || y < 0 || x >= v->columns || y >= v->rows)
            continue;

        const size_t at = (size_t)y * (size_t)v->columns + (size_t)x;

        if (v->error[at] >= TED4_MISSING / 2 && ted4_colour_agrees(v->rgb + 3 * at, colour))
            return d->length[k];
    }
    return MOST_CELLS + 1;
}

/* Returns the mean motion, in cells per frame, with which the pictures beside picture i show p. In
 * the same frame nothing has moved, so a distance there counts twice. */
static float motion(const film *f, size_t i, const float p[3], const uint8_t colour[3])
{
    const size_t from = i > BESIDE ? i - BESIDE : 0;
    float sum = 0, n = 0;

    for (size_t k = from; k < f->n && k <= i + BESIDE; k++) {
        const float frames = fabsf((float)f->shot[k].frame - (float)f->shot[i].frame);

        if (k == i)
            continue;
        sum += away(&f->disk, &f->view[k % RING], p, colour) / fmaxf(frames, 0.5f);
        n++;
    }
    return n > 0 ? sum / n : 0;
}

/* Finds the depth of a cell of picture i at which the least motion explains the pictures beside it.
 * Returns 0 if the cell's ray misses the space of the scene, else 1. */
static int find_depth(const film *f, size_t i, int column, int row, ted4_place *best)
{
    const ted4_cell_view *own = &f->view[i % RING];
    const size_t at = (size_t)row * (size_t)own->columns + (size_t)column;
    const float far = IN_FRONT * own->depth[at];
    float least = INFINITY;

    memcpy(best->colour, own->rgb + 3 * at, 3);
    for (int k = 0; k < DEPTHS; k++) {
        const float part = (float)k / (float)(DEPTHS - 1);
        const float z = 1.0f / ((1.0f - part) / far + part / fminf(own->nearest, far));
        float p[3];

        ted4_cell_point(own, column, row, z, p);
        if (fabsf(p[0]) > 1.0f || fabsf(p[1]) > 1.0f || fabsf(p[2]) > 1.0f)
            continue;

        const float m = motion(f, i, p, best->colour);

        if (m > least - CLEARLY)
            continue;
        least = m;
        memcpy(best->point, p, sizeof p);
        best->size = z * (float)own->step / own->view.fx;
    }
    best->frame = f->shot[i].frame;
    best->score = (float)own->error[at] / 255.0f;
    return least < INFINITY;
}

/* Finds in the square of side cells at (column, row) the cell of largest error, and returns
 * whether the mean error says that something is missing there. */
static int missing(const ted4_cell_view *v, int column, int row, int side, int *worst_column,
                   int *worst_row)
{
    int sum = 0, n = 0, worst = -1;

    for (int y = row; y < row + side && y < v->rows; y++)
        for (int x = column; x < column + side && x < v->columns; x++) {
            const int e = v->error[(size_t)y * (size_t)v->columns + (size_t)x];

            sum += e;
            n++;
            if (e <= worst)
                continue;
            worst = e;
            *worst_column = x;
            *worst_row = y;
        }
    return sum >= TED4_MISSING * n;
}

/* Adds to count[s] how many squares of s + 1 cells miss something, over all pictures. Returns 0, or
 * -1 with t->message filled. */
static int count_missing(const film *f, ted4_trainer *t, size_t count[WIDEST])
{
    memset(count, 0, WIDEST * sizeof *count);
    for (size_t i = 0; i < f->n; i++) {
        ted4_cell_view v = { 0 };
        int x, y;

        if (ted4_cell_view_open(t, f->shot[i].item, 0, &v) != 0) {
            ted4_cell_view_close(&v);
            return -1;
        }
        for (int s = 0; s < WIDEST; s++)
            for (int row = 0; row < v.rows; row += s + 1)
                for (int column = 0; column < v.columns; column += s + 1)
                    count[s] += missing(&v, column, row, s + 1, &x, &y);
        ted4_cell_view_close(&v);
    }
    return 0;
}

/* Returns the picture before picture i (step -1), or after it (step 1), that is of another frame;
 * the first or the last picture if there is none. */
static size_t other_frame(const film *f, size_t i, int step)
{
    const size_t end = step > 0 ? f->n - 1 : 0;
    size_t k = i;

    while (k != end && f->shot[k].frame == f->shot[i].frame)
        k = step > 0 ? k + 1 : k - 1;
    return k;
}

/* Returns the distance of two frames, and 1 if there is none, as at the ends of the sequence. */
static uint32_t frames_between(uint32_t a, uint32_t b)
{
    return b > a ? b - a : 1;
}

/* The span of what picture i shows: from the picture before it to the picture after it, so that
 * frames without a training picture are covered, and motion is seen at two times at least. */
static ted4_span span_of(const film *f, size_t i)
{
    const size_t first = other_frame(f, i, -1), last = other_frame(f, i, 1);

    return (ted4_span) {
        f->shot[first].frame,
        f->shot[last].frame,
        frames_between(f->shot[other_frame(f, first, -1)].frame, f->shot[first].frame),
        frames_between(f->shot[last].frame, f->shot[other_frame(f, last, 1)].frame),
    };
}

/* What is to become an anchor. */
typedef struct {
    ted4_place place;
    ted4_span span;
} new_anchor;

/* The squares that miss something, over all pictures, and the anchors that are made of them: of all
 * squares, or of as many as the budget allows, evenly spread. */
typedef struct {
    int side;            /* of a square, in cells */
    size_t squares, met; /* in all pictures; so far */
    new_anchor *item;    /* owned: [most] */
    size_t n, most;
} selection;

/* Returns whether the next square becomes an anchor. */
static int is_chosen(selection *h)
{
    const size_t before = h->met * h->most / h->squares;

    h->met++;
    return h->met * h->most / h->squares > before;
}

/* Adds what picture i misses to the selection. */
static void search_picture(const film *f, size_t i, selection *h)
{
    const ted4_cell_view *v = &f->view[i % RING];
    const ted4_span span = span_of(f, i);

    for (int row = 0; row < v->rows; row += h->side)
        for (int column = 0; column < v->columns; column += h->side) {
            ted4_place p;
            int x = 0, y = 0;

            if (!missing(v, column, row, h->side, &x, &y) || !is_chosen(h) ||
                !find_depth(f, i, x, y, &p))
                continue;
            p.size *= (float)h->side;
            h->item[h->n++] = (new_anchor) { p, span };
        }
}

/* Chooses the squares so that at most most of them miss something, if that can be, and makes room
 * for the anchors. Returns 0, or -1 with t->message filled. */
static int prepare(const film *f, ted4_trainer *t, size_t most, selection *h)
{
    size_t count[WIDEST];

    if (count_missing(f, t, count) != 0)
        return -1;
    for (h->side = 1; h->side < WIDEST && count[h->side - 1] > most;)
        h->side++;
    h->squares = count[h->side - 1];
    h->most = most < h->squares ? most : h->squares;
    h->item = malloc((h->most + 1) * sizeof *h->item);
    return h->item == NULL ? ted4_trainer_fail(t, "no memory for new anchors") : 0;
}

/* Turns the selection into anchors. Returns 0, or -1 with t->message filled. */
static int plant(ted4_trainer *t, const selection *h)
{
    ted4_seeding s = { 0 };
    int bad = ted4_seeding_begin(t, &s) != 0;

    for (size_t i = 0; !bad && i < h->n; i++)
        bad = ted4_seeding_add(t, &s, &h->item[i].place, &h->item[i].span) != 0;
    bad = bad || ted4_seeding_settle(t, &s) != 0 || ted4_arrange_anchors(t) != 0;
    ted4_seeding_finish(&s);
    return bad ? -1 : 0;
}

int ted4_sv_seed(ted4_trainer *t, size_t most)
{
    film f = { 0 };
    selection h = { 0 };
    int bad = 0;

    if (list_pictures(&f, t->data) != 0)
        bad = ted4_trainer_fail(t, "no memory for new anchors");
    bad = bad || prepare(&f, t, most, &h) != 0;
    for (size_t i = 0; !bad && i < f.n; i++) {
        bad = advance(&f, t, i) != 0;
        if (!bad)
            search_picture(&f, i, &h);
    }
    bad = bad || plant(t, &h) != 0;
    free_film(&f);
    free(h.item);
    return bad ? -1 : 0;
}
