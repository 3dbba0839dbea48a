/* fit_colours.c - see fit_colours.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "fit_colours.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "train/loss/colour_fit.h"

/* Sums over pixels of products of bytes, exact in 64 bits: of (r, g, b, 1) of ours with itself and
 * with (r, g, b) of the truth. */
typedef struct {
    uint64_t ours[4][4], truth[4][3], pixels;
} sums;

static void add_picture(sums *s, const uint8_t *truth, const uint8_t *ours, size_t pixels)
{
    for (size_t i = 0; i < 3 * pixels; i += 3) {
        const uint32_t x[4] = { ours[i], ours[i + 1], ours[i + 2], 1 };

        for (int r = 0; r < 4; r++) {
            for (int c = 0; c <= r; c++)
                s->ours[r][c] += x[r] * x[c];
            for (size_t c = 0; c < 3; c++)
                s->truth[r][c] += x[r] * truth[i + c];
        }
    }
    s->pixels += pixels;
}

/* Bytes become colours of 0 .. 1, which leaves the constant 1 as it is. */
static void solve(const sums *s, ted4_colour_map map)
{
    const double unit[4] = { 1 / 255.0, 1 / 255.0, 1 / 255.0, 1 };
    ted4_colour_sums n = { .weight = (double)s->pixels };

    for (int r = 0; r < 4; r++) {
        for (int c = 0; c <= r; c++)
            n.left[r][c] = unit[r] * unit[c] * (double)s->ours[r][c];
        for (int c = 0; c < 3; c++)
            n.right[r][c] =
                unit[r] * unit[c] *
                ((double)s->truth[r][c] - (double)s->ours[r > c ? r : c][r > c ? c : r]);
    }
    ted4_colour_solve(&n, map);
}

/* Adds training picture i to the sums of its camera. */
static int take(ted4_dataset *d, size_t i, ted4_fit_draw draw, void *user, sums *s, ted4_message *m)
{
    const ted4_camera *const c = &d->pictures[i].camera;
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    uint8_t *const ours = malloc(3 * pixels);
    const uint8_t *truth;
    int code = -1;

    if (ours == NULL) {
        snprintf(m->text, sizeof m->text, "%s: out of memory", d->pictures[i].path);
    } else if ((code = draw(user, i, ours)) == 0) {
        truth = ted4_dataset_pixels(d, i, m);
        if (truth == NULL) {
            code = -1;
        } else {
            add_picture(s, truth, ours, pixels);
            ted4_dataset_release(d, i);
        }
    }
    free(ours);
    return code;
}

/* Returns the number of pictures of a camera with this is_test. */
static size_t count(const ted4_dataset *d, uint32_t camera, int is_test)
{
    size_t n = 0;

    for (size_t i = 0; i < d->n_pictures; i++)
        n += d->pictures[i].camera_id == camera && d->pictures[i].is_test == is_test;
    return n;
}

static int fit_camera(ted4_dataset *d, uint32_t camera, ted4_fit_draw draw, void *user,
                      ted4_fitted_colours *to, ted4_message *m)
{
    const size_t n = count(d, camera, 0), wanted = n < TED4_FIT_PICTURES ? n : TED4_FIT_PICTURES;
    size_t at = 0;
    sums s = { 0 };
    int code = 0;

    for (size_t i = 0; i < d->n_pictures && to->pictures < wanted && code == 0; i++) {
        if (d->pictures[i].is_test || d->pictures[i].camera_id != camera ||
            at++ != to->pictures * n / wanted)
            continue;
        to->pictures++;
        code = take(d, i, draw, user, &s, m);
    }
    if (code == 0 && wanted > 0)
        solve(&s, to->map);
    return code;
}

int ted4_fit_colours(ted4_dataset *d, int is_test, ted4_fit_draw draw, void *user,
                     ted4_fitted_colours *of, ted4_message *m)
{
    int code = 0;

    memset(of, 0, d->n_cameras * sizeof *of);
    for (uint32_t k = 0; k < d->n_cameras && code == 0; k++)
        if (count(d, k, is_test) > 0)
            code = fit_camera(d, k, draw, user, &of[k], m);
    return code;
}

double ted4_fitted_psnr(const ted4_colour_map map, const uint8_t *truth, const uint8_t *ours,
                        size_t pixels)
{
    double square = 0;

    for (size_t i = 0; i < 3 * pixels; i += 3)
        for (size_t c = 0; c < 3; c++) {
            double x = (double)ours[i + c] + 255.0 * (double)map[TED4_COLOUR_ROW_V + c];

            for (size_t r = 0; r < 3; r++)
                x += (double)ours[i + r] * (double)map[3 * r + c];

            const double e = (fmin(fmax(x, 0), 255) - truth[i + c]) / 255.0;

            square += e * e;
        }
    return -10.0 * log10(square / (3.0 * (double)pixels));
}
