/* sheet.c - see sheet.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "sheet.h"

#include <stdlib.h>
#include <string.h>

void ted4_sheet_error(const uint8_t *a, const uint8_t *b, size_t n, uint8_t *out)
{
    for (size_t i = 0; i < n; i++) {
        const int d = TED4_ERROR_GAIN * (a[i] > b[i] ? a[i] - b[i] : b[i] - a[i]);

        out[i] = (uint8_t)(d < 255 ? d : 255);
    }
}

/* Pictures that may be shown: those of one split that have the size of its first picture. */
typedef struct {
    const ted4_dataset *d;
    int test;
    size_t first;
} show;

static int is_shown(const show *s, size_t i)
{
    const ted4_picture *p = &s->d->pictures[i];
    const ted4_camera *a = &p->camera, *b = &s->d->pictures[s->first].camera;

    return (p->is_test != 0) == (s->test != 0) && a->width == b->width && a->height == b->height;
}

/* Is picture i the first one of its camera that may be shown? */
static int opens(const show *s, size_t i)
{
    for (size_t k = 0; k < i; k++)
        if (s->d->pictures[k].camera_id == s->d->pictures[i].camera_id && is_shown(s, k))
            return 0;
    return is_shown(s, i);
}

/* Returns the first picture of the n-th camera that has pictures to show. */
static size_t camera_at(const show *s, size_t n)
{
    size_t i = 0;

    while (!opens(s, i) || n-- > 0)
        i++;
    return i;
}

/* Orders the pictures of first's camera by time, and returns the r-th of n evenly spaced ones. */
static size_t at_time(const show *s, size_t first, size_t r, size_t n)
{
    const ted4_picture *all = s->d->pictures;
    size_t of_camera = 0;

    for (size_t i = 0; i < s->d->n_pictures; i++)
        of_camera += all[i].camera_id == all[first].camera_id && is_shown(s, i);

    const size_t wanted = n > 1 ? r * (of_camera - 1) / (n - 1) : (of_camera - 1) / 2;

    for (size_t i = 0; i < s->d->n_pictures; i++) {
        size_t before = 0;

        if (all[i].camera_id != all[first].camera_id || !is_shown(s, i))
            continue;
        for (size_t k = 0; k < s->d->n_pictures; k++)
            before += all[k].camera_id == all[first].camera_id && is_shown(s, k) &&
                      (all[k].frame < all[i].frame || (all[k].frame == all[i].frame && k < i));
        if (before == wanted)
            return i;
    }
    return first;
}

/* Returns the wanted picture, or another one if item, [n], already contains it. */
static size_t other(const show *s, size_t wanted, const size_t *item, size_t n)
{
    size_t i = wanted, at = 0;

    for (;;) {
        size_t same = 0;

        for (size_t k = 0; k < n; k++)
            same += item[k] == i;
        if (same == 0)
            return i;
        while (!is_shown(s, at))
            at++;
        i = at++;
    }
}

size_t ted4_sheet_choose(const ted4_dataset *d, int test, size_t most, size_t *item)
{
    show s = { d, test, 0 };
    size_t n = 0, cameras = 0;

    while (s.first < d->n_pictures && (d->pictures[s.first].is_test != 0) != (test != 0))
        s.first++;
    if (s.first == d->n_pictures)
        return 0;
    for (size_t i = 0; i < d->n_pictures; i++) {
        n += is_shown(&s, i) != 0;
        cameras += opens(&s, i) != 0;
    }

    const size_t rows = n < most ? n : most;

    for (size_t r = 0; r < rows; r++) {
        const int many = cameras >= rows;
        const size_t k = many ? (rows > 1 ? r * (cameras - 1) / (rows - 1) : 0) : r % cameras;
        const size_t turns = many ? rows : (rows - k + cameras - 1) / cameras;

        item[r] = other(&s, at_time(&s, camera_at(&s, k), many ? r : r / cameras, turns), item, r);
    }
    return rows;
}

int ted4_sheet_init(ted4_sheet *s, int width, int height, int rows)
{
    *s = (ted4_sheet) { width, height, rows, NULL };
    s->rgb = calloc((size_t)width * (size_t)height, 3 * TED4_SHEET_COLUMNS * (size_t)rows);
    return s->rgb == NULL ? -1 : 0;
}

void ted4_sheet_finish(ted4_sheet *s)
{
    free(s->rgb);
    s->rgb = NULL;
}

void ted4_sheet_put(ted4_sheet *s, int row, const uint8_t *truth, const uint8_t *ours)
{
    const size_t line = (size_t)s->width * 3;

    for (size_t y = 0; y < (size_t)s->height; y++) {
        uint8_t *const to = s->rgb +
                            ((size_t)row * (size_t)s->height + y) * line * TED4_SHEET_COLUMNS;

        memcpy(to, truth + y * line, line);
        memcpy(to + line, ours + y * line, line);
        ted4_sheet_error(truth + y * line, ours + y * line, line, to + 2 * line);
    }
}
