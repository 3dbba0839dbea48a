/* moving_pixels.c - see moving_pixels.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "moving_pixels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "data/data_util.h"

/* Returns the number of pictures of a camera that stands still, or 0 if it moves. */
static size_t count_still(const ted4_dataset *d, uint32_t camera)
{
    const ted4_camera *first = NULL;
    size_t n = 0;

    for (size_t i = 0; i < d->n_pictures; i++) {
        if (d->pictures[i].camera_id != camera)
            continue;
        if (first == NULL)
            first = &d->pictures[i].camera;
        if (!ted4_camera_same(first, &d->pictures[i].camera))
            return 0;
        n++;
    }
    return n;
}

/* Pictures of one camera whose pixels are held. */
typedef struct {
    size_t picture[TED4_MOVING_PICTURES], n;
    const uint8_t *rgb[TED4_MOVING_PICTURES];
} held_pictures;

/* Holds pictures spread evenly over the n of the camera. */
static int hold(ted4_dataset *d, uint32_t camera, size_t n, held_pictures *h, ted4_message *m)
{
    const size_t wanted = n < TED4_MOVING_PICTURES ? n : TED4_MOVING_PICTURES;
    size_t at = 0;

    for (size_t i = 0; i < d->n_pictures && h->n < wanted; i++) {
        if (d->pictures[i].camera_id != camera || at++ != h->n * n / wanted)
            continue;
        h->picture[h->n] = i;
        h->rgb[h->n] = ted4_dataset_pixels(d, i, m);
        if (h->rgb[h->n] == NULL)
            return -1;
        h->n++;
    }
    return 0;
}

/* Returns the middle of n values at the same place of n pictures; the upper one of two. */
static uint8_t middle(const held_pictures *h, size_t at)
{
    uint8_t sorted[TED4_MOVING_PICTURES];

    for (size_t k = 0; k < h->n; k++) {
        const uint8_t value = h->rgb[k][at];
        size_t to = k;

        for (; to > 0 && sorted[to - 1] > value; to--)
            sorted[to] = sorted[to - 1];
        sorted[to] = value;
    }
    return sorted[h->n / 2];
}

static int find_median(ted4_dataset *d, uint32_t camera, uint8_t **median, ted4_message *m)
{
    const size_t n = count_still(d, camera);
    held_pictures h = { .n = 0 };
    int code;

    if (n < TED4_MOVING_FEWEST)
        return 0;
    code = hold(d, camera, n, &h, m);
    if (code == 0) {
        const ted4_camera *const c = &d->pictures[h.picture[0]].camera;
        const size_t size = (size_t)c->width * (size_t)c->height * 3;

        *median = malloc(size);
        if (*median == NULL) {
            snprintf(m->text, sizeof m->text, "%s: out of memory", d->pictures[h.picture[0]].path);
            code = -1;
        }
        for (size_t at = 0; *median != NULL && at < size; at++)
            (*median)[at] = middle(&h, at);
    }
    for (size_t k = 0; k < h.n; k++)
        ted4_dataset_release(d, h.picture[k]);
    return code;
}

int ted4_moving_medians(ted4_dataset *d, int is_test, uint8_t ***median, ted4_message *m)
{
    int code = 0;

    *median = calloc(d->n_cameras, sizeof **median);
    if (*median == NULL) {
        snprintf(m->text, sizeof m->text, "out of memory");
        return -1;
    }
    for (uint32_t k = 0; k < d->n_cameras && code == 0; k++)
        for (size_t i = 0; i < d->n_pictures; i++)
            if (d->pictures[i].camera_id == k && d->pictures[i].is_test == is_test) {
                code = find_median(d, k, &(*median)[k], m);
                break;
            }
    return code;
}

void ted4_moving_free(uint8_t **median, uint32_t n_cameras)
{
    for (uint32_t k = 0; median != NULL && k < n_cameras; k++)
        free(median[k]);
    free(median);
}

void ted4_moving_add(ted4_moving_sum *s, const uint8_t *median, const uint8_t *truth,
                     const uint8_t *ours, size_t pixels, uint8_t *mask)
{
    for (size_t i = 0; i < 3 * pixels; i += 3) {
        int most = 0;

        for (size_t c = i; c < i + 3; c++)
            most = abs(truth[c] - median[c]) > most ? abs(truth[c] - median[c]) : most;
        if (mask != NULL)
            memset(mask + i, most > TED4_MOVING_LEVELS ? 255 : 0, 3);
        if (most <= TED4_MOVING_LEVELS)
            continue;
        s->pixels++;
        for (size_t c = i; c < i + 3; c++) {
            const double e = (truth[c] - ours[c]) / 255.0;

            s->square += e * e;
        }
    }
    s->views++;
}

double ted4_moving_psnr(const ted4_moving_sum *s)
{
    return s->pixels == 0 ? (double)NAN : -10.0 * log10(s->square / (3.0 * (double)s->pixels));
}
