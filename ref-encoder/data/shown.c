/* shown.c - see shown.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/shown.h"

#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"

/* A pixel is background if no channel is more than NEAR levels off. The background is plain if at
 * least the share PLAIN_SHARE of the border pixels is background. */
enum { NEAR = 8 };
#define PLAIN_SHARE 0.5
/* Border colours are counted in a histogram with bins of 16 levels per channel. */
enum { BUCKET = 16, SIDE = 256 / BUCKET, BUCKETS = SIDE * SIDE * SIDE };

typedef struct {
    uint64_t n, sum[3];
} bucket;

/* Is the pixel in the outermost rows or columns? */
static int is_edge(const ted4_camera *c, size_t pixel)
{
    const size_t x = pixel % (size_t)c->width, y = pixel / (size_t)c->width;

    return x == 0 || y == 0 || x + 1 == (size_t)c->width || y + 1 == (size_t)c->height;
}

static size_t n_pixels(const ted4_camera *c)
{
    return (size_t)c->width * (size_t)c->height;
}

static int is_near(const uint8_t *a, const uint8_t *b)
{
    for (int k = 0; k < 3; k++)
        if (abs(a[k] - b[k]) > NEAR)
            return 0;
    return 1;
}

static void count_colours(bucket *count, const ted4_camera *c, const uint8_t *rgb)
{
    for (size_t i = 0; i < n_pixels(c); i++) {
        const uint8_t *x = rgb + 3 * i;

        if (!is_edge(c, i))
            continue;
        bucket *b = &count[(x[0] / BUCKET * SIDE + x[1] / BUCKET) * SIDE + x[2] / BUCKET];

        b->n++;
        for (int k = 0; k < 3; k++)
            b->sum[k] += x[k];
    }
}

static void mark(ted4_shown *s, size_t k, uint64_t *edges, uint64_t *near)
{
    const ted4_camera *c = &s->data->pictures[s->picture[k]].camera;

    for (size_t i = 0; i < n_pixels(c); i++) {
        const int is_background = is_near(s->rgb[k] + 3 * i, s->background);

        *edges += (uint64_t)is_edge(c, i);
        *near += (uint64_t)(is_background && is_edge(c, i));
        s->bits[k][i / 64] |= (uint64_t)!is_background << i % 64;
    }
}

/* Returns 0, or -1 with *m filled. */
static int read_all(ted4_shown *s, ted4_message *m)
{
    for (size_t k = 0; k < s->n; k++) {
        for (size_t next = k + 1; next < s->n && next <= k + TED4_DATASET_AHEAD; next++)
            ted4_dataset_ahead(s->data, s->picture[next]);
        s->rgb[k] = ted4_dataset_pixels(s->data, s->picture[k], m);
        if (s->rgb[k] == NULL)
            return -1;
    }
    return 0;
}

static size_t bytes_of(const ted4_dataset *d, size_t picture)
{
    return 3 * n_pixels(&d->pictures[picture].camera);
}

static int by_frame(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;

    return (x > y) - (x < y);
}

/* Lists the frames that have training pictures in frame[n_pictures], in order. Returns how many. */
static size_t list_frames(const ted4_dataset *d, uint32_t *frame)
{
    size_t n = 0, kept = 0;

    for (size_t i = 0; i < d->n_pictures; i++)
        if (!d->pictures[i].is_test)
            frame[n++] = d->pictures[i].frame;
    qsort(frame, n, sizeof *frame, by_frame);
    for (size_t i = 0; i < n; i++)
        if (kept == 0 || frame[kept - 1] != frame[i])
            frame[kept++] = frame[i];
    return kept;
}

/* Lists the training pictures of every step-th of n_frames frames in picture[n_pictures]. Returns
 * how many there are, and their total size in *bytes. */
static size_t choose(const ted4_dataset *d, const uint32_t *frame, size_t n_frames, size_t step,
                     size_t *picture, size_t *bytes)
{
    size_t n = 0;

    *bytes = 0;
    for (size_t i = 0; i < d->n_pictures; i++) {
        if (d->pictures[i].is_test)
            continue;
        const uint32_t *const at =
            bsearch(&d->pictures[i].frame, frame, n_frames, sizeof *frame, by_frame);

        if ((size_t)(at - frame) % step != 0)
            continue;
        *bytes += bytes_of(d, i);
        picture[n++] = i;
    }
    return n;
}

/* Chooses the smallest step of frames within both limits, or as many evenly spaced pictures of a
 * single frame as they allow, at least one. Returns 0, or -1 if memory ran out. */
static int choose_pictures(ted4_shown *s)
{
    const ted4_dataset *d = s->data;
    uint32_t *const frame = malloc((d->n_pictures + 1) * sizeof *frame);
    size_t *const all = malloc((d->n_pictures + 1) * sizeof *all);
    size_t n = 0, bytes = 0;

    if (frame != NULL && all != NULL) {
        const size_t n_frames = list_frames(d, frame);

        for (size_t step = 1; step == 1 || step <= n_frames; step++) {
            n = choose(d, frame, n_frames, step, all, &bytes);
            if (n <= TED4_SHOWN_MOST && bytes <= TED4_SHOWN_BYTES)
                break;
        }
        s->n = n < TED4_SHOWN_MOST ? n : TED4_SHOWN_MOST;
        for (;; s->n--) {
            bytes = 0;
            for (size_t k = 0; k < s->n; k++) {
                s->picture[k] = all[k * n / s->n];
                bytes += bytes_of(d, s->picture[k]);
            }
            if (s->n <= 1 || bytes <= TED4_SHOWN_BYTES)
                break;
        }
    }
    free(frame);
    free(all);
    return frame != NULL && all != NULL ? 0 : -1;
}

/* Gives the mean colour of the fullest bin. */
static void most_common(const bucket *count, uint8_t colour[3])
{
    const bucket *best = count;

    for (size_t i = 1; i < BUCKETS; i++)
        best = count[i].n > best->n ? &count[i] : best;
    for (int k = 0; k < 3; k++)
        colour[k] = (uint8_t)(best->n > 0 ? (best->sum[k] + best->n / 2) / best->n : 0);
}

/* Number of words in the mask of picture k. */
static size_t n_words(const ted4_shown *s, size_t k)
{
    return n_pixels(&s->data->pictures[s->picture[k]].camera) / 64 + 1;
}

static int allocate(ted4_shown *s)
{
    for (size_t k = 0; k < s->n; k++) {
        s->bits[k] = calloc(n_words(s, k), sizeof *s->bits[k]);
        if (s->bits[k] == NULL)
            return -1;
    }
    return 0;
}

int ted4_shown_read(ted4_shown *s, ted4_dataset *d, ted4_message *m)
{
    bucket *count = calloc(BUCKETS, sizeof *count);
    uint64_t edges = 0, near = 0;

    memset(s, 0, sizeof *s);
    s->data = d;
    if (count == NULL || choose_pictures(s) != 0 || allocate(s) != 0 || read_all(s, m) != 0) {
        const int no_memory = count == NULL || s->n == 0 || s->bits[s->n - 1] == NULL;

        free(count);
        return no_memory ? ted4_say_no_memory(m) : -1;
    }
    for (size_t k = 0; k < s->n; k++)
        count_colours(count, &d->pictures[s->picture[k]].camera, s->rgb[k]);
    most_common(count, s->background);
    free(count);
    for (size_t k = 0; k < s->n; k++)
        mark(s, k, &edges, &near);
    s->plain = edges > 0 && (double)near >= PLAIN_SHARE * (double)edges;
    for (size_t k = 0; !s->plain && k < s->n; k++)
        memset(s->bits[k], 0xff, n_words(s, k) * sizeof *s->bits[k]);
    return 0;
}

void ted4_shown_free(ted4_shown *s)
{
    for (size_t k = 0; k < s->n; k++) {
        free(s->bits[k]);
        if (s->rgb[k] != NULL)
            ted4_dataset_release(s->data, s->picture[k]);
    }
    memset(s, 0, sizeof *s);
}

int ted4_shown_pixel(const ted4_shown *s, size_t i, const double world[3], size_t *pixel)
{
    const ted4_camera *c = &s->data->pictures[s->picture[i]].camera;
    double p[3];

    for (int k = 0; k < 3; k++)
        p[k] = c->R[3 * k] * world[0] + c->R[3 * k + 1] * world[1] + c->R[3 * k + 2] * world[2] +
               c->t[k];

    const double x = c->fx * p[0] / p[2] + c->cx, y = c->fy * p[1] / p[2] + c->cy;

    if (!(p[2] > 0 && x >= 0 && y >= 0 && x < c->width && y < c->height))
        return 0;
    *pixel = (size_t)y * (size_t)c->width + (size_t)x;
    return 1;
}

void ted4_shown_count(const ted4_shown *s, const double world[3], int *seen, int *shown)
{
    *seen = *shown = 0;
    for (size_t k = 0; k < s->n; k++) {
        size_t pixel;

        if (!ted4_shown_pixel(s, k, world, &pixel))
            continue;
        *seen += 1;
        *shown += ted4_shown_at(s, k, pixel);
    }
}
