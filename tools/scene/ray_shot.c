/* ray_shot.c - see ray_shot.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_shot.h"

#include <stdlib.h>
#include <string.h>

/* Multiplies a value by alpha, in bytes. */
static uint8_t part(int value, int alpha)
{
    return (uint8_t)((value * alpha + 127) / 255);
}

/* Converts a cut-out pixel to the form in which the file stores it. */
static void lay(const ted4_ray_options *o, uint8_t *p)
{
    const ted4_ray_background b = ted4_ray_around(o);
    const int alpha = p[3];

    for (int k = 0; k < 3; k++) {
        if (b == RAY_WHITE)
            p[k] = (uint8_t)(part(p[k], alpha) + 255 - alpha);
        else if (b == RAY_BLACK || o->ways.premultiplied)
            p[k] = part(p[k], alpha);
    }
    if (b != RAY_CLEAR)
        p[3] = 255;
}

static void draw(const ted4_ray_options *o, const ted4_ray_world *w, const ted4_ray_camera *c,
                 uint8_t *rgba)
{
    const size_t n = (size_t)c->width * (size_t)c->height;

    if (ted4_ray_around(o) > RAY_ROOM) {
        ted4_ray_cut_out(w, c, rgba);
        for (size_t i = 0; i < n; i++)
            lay(o, rgba + 4 * i);
        return;
    }
    /* Three bytes per pixel are spread to four, beginning at the end. */
    ted4_ray_render(w, c, rgba);
    for (size_t i = n; i-- > 0;) {
        uint8_t rgb[3];

        memcpy(rgb, rgba + 3 * i, 3);
        memcpy(rgba + 4 * i, rgb, 3);
        rgba[4 * i + 3] = 255;
    }
}

void ted4_ray_shot(const ted4_ray_options *o, int number, int frame, uint8_t *rgba)
{
    ted4_ray_camera c;
    ted4_ray_world w;

    ted4_ray_camera_of(o, number, &c);
    ted4_ray_expose(o, number, frame, &c);
    ted4_ray_world_of(o, frame, &w);
    draw(o, &w, &c, rgba);
}

/* Removes from w the solids that are not in other. Solids consist of numbers of four bytes, without
 * gaps. */
static void keep_common(ted4_ray_world *w, const ted4_ray_world *other)
{
    int n = 0;

    for (int i = 0; i < w->n; i++) {
        int found = 0;

        for (int k = 0; k < other->n && !found; k++)
            found = memcmp(&w->object[i], &other->object[k], sizeof w->object[i]) == 0;
        if (found)
            w->object[n++] = w->object[i];
    }
    w->n = n;
}

int ted4_ray_mask(const ted4_ray_options *o, int number, int frame, uint8_t *mask)
{
    enum { SEEN = 8 };
    ted4_ray_world whole, still, other;
    ted4_ray_camera c;

    ted4_ray_camera_of(o, number, &c);
    const size_t n = (size_t)c.width * (size_t)c.height;
    uint8_t *const a = malloc(8 * n), *const b = a + 4 * n;
    if (a == NULL)
        return -1;
    ted4_ray_world_of(o, frame, &whole);
    still = whole;
    for (int j = 0; j < o->n_frames; j++) {
        ted4_ray_world_of(o, j, &other);
        keep_common(&still, &other);
    }
    draw(o, &whole, &c, a);
    draw(o, &still, &c, b);
    for (size_t i = 0; i < n; i++) {
        int most = 0;

        for (size_t k = 4 * i; k < 4 * i + 4; k++)
            most = abs(a[k] - b[k]) > most ? abs(a[k] - b[k]) : most;
        mask[i] = most >= SEEN ? 255 : 0;
    }
    free(a);
    return 0;
}
