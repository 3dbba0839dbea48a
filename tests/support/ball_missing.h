/* ball_missing.h - the moving scene of balls without the initial points of the blue ball, so that
 * only the pictures show it, and the number of new anchors that lie on it. For test_mv_seed.c and
 * test_sv_seed.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BALL_MISSING_H
#define TED4_BALL_MISSING_H

#include "ball_trainer.h"
#include "test.h"
#include "train/densify/plane_sweep.h"
#include "train/densify/short_lived.h"

enum { BLUE = 2 };

static inline void ball_load_without_blue(tiny_folder *f, ted4_dataset *d, int frames, int speed)
{
    size_t n = 0;

    ball_load(f, d, frames, speed);
    for (size_t i = 0; i < d->n_points; i++) {
        if (d->point_rgb[3 * i + 2] > 200)
            continue;
        memmove(d->points + 3 * n, d->points + 3 * i, 3 * sizeof *d->points);
        memmove(d->point_rgb + 3 * n++, d->point_rgb + 3 * i, 3);
    }
    assert_int_equal(n, (BALLS - 1) * BALL_POINTS);
    d->n_points = n;
}

/* Distance, in radii, of a point in normalised space from the centre of the blue ball at a time in
 * [0, 1], if the ball moves speed times as far as usual. */
static inline double ball_radii(const ted4_trainer *t, const float *p, int speed, double time)
{
    const ball b = ball_at(BLUE, speed * time);
    double square = 0;

    for (int k = 0; k < 3; k++) {
        const double x = (double)t->layout.head.origin[k] +
                         ldexp((double)p[k], t->layout.head.exponent);

        square += (x - b.centre[k]) * (x - b.centre[k]);
    }
    return sqrt(square) / b.radius;
}

/* Counts the short-lived anchors, and asserts that none lives longer than longest, a share of the
 * duration. *near: those that lie on the ball at the middle of their lives. */
static inline size_t ball_count_short_lived(const ted4_trainer *t, int speed, float longest,
                                            size_t *near)
{
    const int first = t->layout.first[TED4_TAU];
    size_t n = 0;

    *near = 0;
    for (size_t i = 0; i < t->anchors.n; i++) {
        float p[3];

        if (!ted4_is_short_lived(t, i))
            continue;
        for (int k = 0; k < 3; k++)
            p[k] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, k);

        const float from = *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first);
        const float to = *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first + 2);

        assert_true(from < to);
        assert_true(to - from <= longest);
        *near += ball_radii(t, p, speed, 0.5 * (double)(from + to)) < 1.7;
        n++;
    }
    return n;
}

/* ---- anchors and the places at which they were planted ---- */

/* The place of anchor i; NULL: it is none of the list's. */
static inline const ted4_place *ball_place_of(const ted4_trainer *t, size_t i,
                                              const ted4_places *list)
{
    float p[3];

    for (int j = 0; j < 3; j++)
        p[j] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j);
    for (size_t k = 0; k < list->n; k++)
        if (memcmp(p, list->item[k].point, sizeof p) == 0)
            return &list->item[k];
    return NULL;
}

/* Whether the frame is one of those in which the votes found anchor i. Its span is wider by a
 * quarter of the distance to the next known frame on either side, and fades over 0.35 of that. */
static inline int ball_lives_at(const ted4_trainer *t, size_t i, uint32_t frame)
{
    const double frames = t->data->n_frames - 1.0;
    double tau[4];

    for (int c = 0; c < 4; c++)
        tau[c] = (double)*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                            t->layout.first[TED4_TAU] + c);
    return tau[0] * frames + 0.25 / 0.35 * exp2(tau[1]) * frames <= frame + 1e-3 &&
           frame - 1e-3 <= tau[2] * frames - 0.25 / 0.35 * exp2(tau[3]) * frames;
}

#endif
