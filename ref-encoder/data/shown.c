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

/* Lists the training pictures of every step-th frame. Stores at most most of them, but returns how
 * many there are, and their total size in *bytes. */
static size_t choose(const ted4_dataset *d, uint32_t step, size_t *picture, size_t most,
                     size_t *bytes)
{
    size_t n = 0;

    *bytes = 0;
    for (size_t i = 0; i < d->n_pictures; i++) {
        if (d->pictures[i].is_test || d->pictures[i].frame % step != 0)
            continue;
        *bytes += 3 * n_pixels(&d->pictures[i].camera);
        if (n < most)
            picture[n] = i;
        n++;
    }
    return n;
}

/* Chooses the smallest frame step within both limits. If a single frame exceeds them, its first
 * pictures are used. */
static void choose_pictures(ted4_shown *s)
{
    uint32_t step = 1;
    size_t bytes;

    do
        s->n = choose(s->data, step, s->picture, TED4_SHOWN_MOST, &bytes);
    while ((s->n > TED4_SHOWN_MOST || bytes > TED4_SHOWN_BYTES) && step++ < s->data->n_frames);
    s->n = s->n < TED4_SHOWN_MOST ? s->n : TED4_SHOWN_MOST;
    for (; s->n > 1; s->n--) {
        bytes = 0;
        for (size_t k = 0; k < s->n; k++)
            bytes += 3 * n_pixels(&s->data->pictures[s->picture[k]].camera);
        if (bytes <= TED4_SHOWN_BYTES)
            break;
    }
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
    choose_pictures(s);
    if (count == NULL || allocate(s) != 0 || read_all(s, m) != 0) {
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
