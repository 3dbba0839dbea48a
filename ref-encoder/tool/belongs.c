/* belongs.c - see belongs.h. The same scene may be loaded with other random points than it was trained with, or with bounds that somebody set, so cubes need not be
 * equal.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "belongs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "train/space.h"

/* Of frames a second, relative; of cubes' exponents. */
#define OTHER_RATE 0.01
enum { OTHER_SIZE = 4 };

static int cubes_meet(const ted4_info *file, const ted4_header *h)
{
    const double reach = ldexp(1.0, file->exponent) + ldexp(1.0, h->exponent);
    int          meet = 1;

    for (int k = 0; k < 3; k++)
        meet &= fabs((double)file->origin[k] - (double)h->origin[k]) < reach;
    return meet;
}

int ted4_belongs_scene(const ted4_info *file, const ted4_dataset *d, char *why, size_t why_size)
{
    const double rate = file->rate_den > 0 ? (double)file->rate_num / (double)file->rate_den : 0.0;
    ted4_header  h = { 0 };

    ted4_space_make(&h, d);
    if (file->frames != d->n_frames)
        snprintf(why, why_size, "%u time%s in the file, %u in the scene (--max-frames reads the first ones)", (unsigned)file->frames,
                 file->frames == 1 ? "" : "s", (unsigned)d->n_frames);
    else if (d->n_frames > 1 && d->rate > 0 && rate > 0 && fabs(rate / d->rate - 1.0) > OTHER_RATE)
        snprintf(why, why_size, "%.4g frames a second in the file, %.4g in the scene", rate, d->rate);
    else if (d->n_points > 0 && !cubes_meet(file, &h))
        snprintf(why, why_size, "it lies around %.4g, %.4g, %.4g, the scene around %.4g, %.4g, %.4g", (double)file->origin[0], (double)file->origin[1],
                 (double)file->origin[2], (double)h.origin[0], (double)h.origin[1], (double)h.origin[2]);
    else if (d->n_points > 0 && abs(file->exponent - h.exponent) > OTHER_SIZE)
        snprintf(why, why_size, "its cube is %.4g wide, the scene's %.4g", ldexp(2.0, file->exponent), ldexp(2.0, h.exponent));
    else
        return 1;
    return 0;
}

void ted4_belongs_add(ted4_belongs_sum *s, const uint8_t *truth, const uint8_t *drawn, size_t pixels)
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
    snprintf(why, why_size, "its pictures are %.1f dB further from the scene's than one colour for each of these", 10.0 * log10(s->drawn / fmax(s->mean, 1.0)));
    return 0;
}
