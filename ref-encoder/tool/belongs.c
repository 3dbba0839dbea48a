/* belongs.c - see belongs.h. Initial points are not compared with the position of the file's cube,
 * because the encoder may have replaced them, or have used bounds set by the user.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "belongs.h"

#include <math.h>
#include <stdio.h>

#include "tool/plural.h"

/* Frame rates that differ by more than this, relatively, are different. */
#define OTHER_RATE 0.01
/* Test points per axis of the file's cube; the share of all pictures that must show at least one of
 * these points. */
enum { PLACES = 9 };
#define SEEN 0.5

static int is_seen(const ted4_camera *c, const double x[3])
{
    double p[3];

    for (int i = 0; i < 3; i++)
        p[i] = c->R[3 * i] * x[0] + c->R[3 * i + 1] * x[1] + c->R[3 * i + 2] * x[2] + c->t[i];
    if (!(p[2] > 0))
        return 0;

    const double u = c->fx * p[0] / p[2] + c->cx, v = c->fy * p[1] / p[2] + c->cy;

    return u >= 0 && u <= c->width && v >= 0 && v <= c->height;
}

static int stands_inside(const ted4_info *file, const ted4_camera *c)
{
    int inside = 1;

    for (int i = 0; i < 3; i++) {
        const double centre = -(c->R[i] * c->t[0] + c->R[3 + i] * c->t[1] + c->R[6 + i] * c->t[2]);

        inside &= fabs(centre - (double)file->origin[i]) < ldexp(1.0, file->exponent);
    }
    return inside;
}

/* Does the camera see any part of the cube in which the anchors of the file lie? */
static int sees_cube(const ted4_info *file, const ted4_camera *c)
{
    int seen = stands_inside(file, c);

    for (int k = 0; !seen && k < PLACES * PLACES * PLACES; k++) {
        const int place[3] = { k % PLACES, k / PLACES % PLACES, k / (PLACES * PLACES) };
        double x[3];

        for (int i = 0; i < 3; i++)
            x[i] = (double)file->origin[i] +
                   ldexp(2.0 * place[i] / (PLACES - 1) - 1.0, file->exponent);
        seen = is_seen(c, x);
    }
    return seen;
}

int ted4_belongs_scene(const ted4_info *file, const ted4_dataset *d, char *why, size_t why_size)
{
    const double rate = file->rate_den > 0 ? (double)file->rate_num / (double)file->rate_den : 0.0;
    size_t seeing = 0;

    for (size_t i = 0; i < d->n_pictures; i++)
        seeing += sees_cube(file, &d->pictures[i].camera) != 0;
    if (file->frames != d->n_frames)
        snprintf(why, why_size,
                 "%u time%s in the file, %u in the scene (--max-frames reads the first ones)",
                 (unsigned)file->frames, ted4_s(file->frames), (unsigned)d->n_frames);
    else if (d->n_frames > 1 && d->rate > 0 && rate > 0 && fabs(rate / d->rate - 1.0) > OTHER_RATE)
        snprintf(why, why_size, "%.4g frames per second in the file, %.4g in the scene", rate,
                 d->rate);
    else if ((double)seeing < SEEN * (double)d->n_pictures)
        snprintf(why, why_size, "only %zu of %zu picture%s look%s at where it lies", seeing,
                 d->n_pictures, ted4_s(d->n_pictures), seeing == 1 ? "s" : "");
    else
        return 1;
    return 0;
}

int ted4_belongs_size(const ted4_camera_list *taken, const ted4_dataset *d, int want_test,
                      char *why, size_t why_size)
{
    const ted4_camera *c = NULL;

    for (size_t i = d->n_pictures; i-- > 0;) {
        if (d->pictures[i].is_test != want_test)
            continue;
        c = &d->pictures[i].camera;
        for (size_t k = 0; k < taken->n; k++)
            if (taken->camera[k].view.width == c->width &&
                taken->camera[k].view.height == c->height)
                return 1;
    }
    if (c == NULL || taken->n == 0)
        return 1;
    snprintf(why, why_size,
             "these pictures have %dx%d pixels, those of its training %dx%d: give --downscale as "
             "the training did, or --trained-downscale",
             c->width, c->height, taken->camera[0].view.width, taken->camera[0].view.height);
    return 0;
}

void ted4_belongs_add(ted4_belongs_sum *s, const uint8_t *truth, const uint8_t *drawn,
                      size_t pixels)
{
    for (size_t c = 0; c < 3; c++) {
        double sum = 0, squares = 0, errors = 0;

        for (size_t i = 0; i < pixels; i++) {
            const double x = truth[3 * i + c], e = x - (double)drawn[3 * i + c];

            sum += x;
            squares += x * x;
            errors += e * e;
        }
        s->drawn += errors;
        s->mean += fmax(squares - sum * sum / (double)pixels, 0.0);
    }
}

int ted4_belongs_pictures(const ted4_belongs_sum *s, char *why, size_t why_size)
{
    if (!(s->drawn > s->mean))
        return 1;
    snprintf(why, why_size,
             "its pictures are %.1f dB further from the scene's than one colour for each of these",
             10.0 * log10(s->drawn / fmax(s->mean, 1.0)));
    return 0;
}
