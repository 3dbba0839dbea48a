/* depth_room.h - pictures of a room in memory, with known depth: a wall, of which a part is plain,
 * a floor, and a ball that is elsewhere in each of two frames. Cameras stand on an arc and look at
 * the ball.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DEPTH_ROOM_H
#define TED4_DEPTH_ROOM_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "data/shown.h"
#include "train/math/random.h"

enum {
    ROOM_W = 96,
    ROOM_H = 64,
    ROOM_CAMERAS = 6,
    ROOM_FRAMES = 2,
    ROOM_PICTURES = ROOM_CAMERAS * ROOM_FRAMES
};
#define ROOM_FOCAL      90.0
#define ROOM_WALL       6.0 /* z of the wall */
#define ROOM_FLOOR      1.0 /* y of the floor */
#define ROOM_RADIUS     0.6
/* The wall is plain where PLAIN_FROM <= x < PLAIN_TO. */
#define ROOM_PLAIN_FROM 0.6
#define ROOM_PLAIN_TO   1.4

typedef struct {
    ted4_dataset data;
    ted4_picture picture[ROOM_PICTURES];
    uint8_t *rgb[ROOM_PICTURES];
    ted4_shown shown;
} room;

static const double room_ball[2][3] = { { -0.4, 0.2, 4.0 }, { 0.3, 0.2, 4.0 } };

/* Smooth noise in [0, 1). */
static inline double room_noise(double x, double y, uint64_t key)
{
    const double fx = floor(x), fy = floor(y), u = x - fx, v = y - fy;
    double sum = 0;

    for (int k = 0; k < 4; k++) {
        const int64_t a = (int64_t)fx + k % 2, b = (int64_t)fy + k / 2;

        sum += (k % 2 ? u : 1 - u) * (k / 2 ? v : 1 - v) *
               (double)ted4_uniform(key, (uint64_t)(a * 4096 + b + (1 << 24)));
    }
    return sum;
}

/* Depth along a ray d from the centre c, and the colour there. */
static inline double room_trace(const double c[3], const double d[3], int frame, double rgb[3])
{
    const double *ball = room_ball[frame];
    double near = (ROOM_WALL - c[2]) / d[2], along = 0, square = 0, dd = 0, p[3], x, y;
    int what = 0;

    for (int k = 0; k < 3; k++) {
        along += (ball[k] - c[k]) * d[k];
        square += (ball[k] - c[k]) * (ball[k] - c[k]);
        dd += d[k] * d[k];
    }
    const double inside = along * along - dd * (square - ROOM_RADIUS * ROOM_RADIUS);

    if (d[1] > 0 && (ROOM_FLOOR - c[1]) / d[1] < near) {
        near = (ROOM_FLOOR - c[1]) / d[1];
        what = 1;
    }
    if (inside > 0 && (along - sqrt(inside)) / dd < near) {
        near = (along - sqrt(inside)) / dd;
        what = 2;
    }
    for (int k = 0; k < 3; k++)
        p[k] = c[k] + near * d[k];
    x = what == 2 ? p[0] - ball[0] : p[0];
    y = what == 1 ? p[2] : p[1];
    for (int k = 0; k < 3; k++)
        rgb[k] = 60 + 40 * k + 100 * room_noise(6 * x, 6 * y, (uint64_t)(3 * what + k));
    if (what == 0 && p[0] >= ROOM_PLAIN_FROM && p[0] < ROOM_PLAIN_TO)
        for (int k = 0; k < 3; k++)
            rgb[k] = 90 + 30 * k;
    return near;
}

/* Distance of a point from the nearest surface, at any frame. */
static inline double room_beside(const float p[3])
{
    double best = fmin(fabs((double)p[2] - ROOM_WALL), fabs((double)p[1] - ROOM_FLOOR));

    for (int f = 0; f < ROOM_FRAMES; f++) {
        double square = 0;

        for (int k = 0; k < 3; k++)
            square += ((double)p[k] - room_ball[f][k]) * ((double)p[k] - room_ball[f][k]);
        best = fmin(best, fabs(sqrt(square) - ROOM_RADIUS));
    }
    return best;
}

static inline void room_camera(ted4_camera *c, int i)
{
    const double a = 0.12 * (i - 0.5 * (ROOM_CAMERAS - 1)), s = sin(a), o = cos(a);
    const double R[9] = { o, 0, s, 0, 1, 0, -s, 0, o };
    const double centre[3] = { 4 * s, i % 2 ? -0.2 : 0.1, 4 - 4 * o };

    *c = (ted4_camera) { .width = ROOM_W,
                         .height = ROOM_H,
                         .fx = ROOM_FOCAL,
                         .fy = ROOM_FOCAL,
                         .cx = 0.5 * ROOM_W,
                         .cy = 0.5 * ROOM_H };
    memcpy(c->R, R, sizeof R);
    for (int k = 0; k < 3; k++)
        c->t[k] = -(R[3 * k] * centre[0] + R[3 * k + 1] * centre[1] + R[3 * k + 2] * centre[2]);
}

/* The ray through the point (x, y) of picture i. */
static inline void room_ray(const room *r, int i, double x, double y, double c[3], double d[3])
{
    const ted4_camera *k = &r->picture[i].camera;
    const double at[3] = { (x - k->cx) / k->fx, (y - k->cy) / k->fy, 1 };

    for (int j = 0; j < 3; j++) {
        c[j] = -(k->R[j] * k->t[0] + k->R[3 + j] * k->t[1] + k->R[6 + j] * k->t[2]);
        d[j] = k->R[j] * at[0] + k->R[3 + j] * at[1] + k->R[6 + j] * at[2];
    }
}

static inline void room_paint(room *r, int i)
{
    enum { RAYS = 3 };

    for (int pixel = 0; pixel < ROOM_W * ROOM_H; pixel++) {
        double sum[3] = { 0, 0, 0 }, c[3], d[3], rgb[3];

        for (int s = 0; s < RAYS * RAYS; s++) {
            room_ray(r, i, pixel % ROOM_W + (s % RAYS + 0.5) / RAYS,
                     pixel / ROOM_W + (s / RAYS + 0.5) / RAYS, c, d);
            room_trace(c, d, (int)r->picture[i].frame, rgb);
            for (int k = 0; k < 3; k++)
                sum[k] += rgb[k] / (RAYS * RAYS);
        }
        for (int k = 0; k < 3; k++)
            r->rgb[i][3 * pixel + k] = (uint8_t)(sum[k] + 0.5);
    }
}

static inline void room_make(room *r)
{
    memset(r, 0, sizeof *r);
    r->data.pictures = r->picture;
    r->data.n_pictures = r->shown.n = ROOM_PICTURES;
    r->data.n_frames = ROOM_FRAMES;
    r->shown.data = &r->data;
    for (int i = 0; i < ROOM_PICTURES; i++) {
        r->picture[i].frame = (uint32_t)(i / ROOM_CAMERAS);
        r->picture[i].camera_id = (uint32_t)(i % ROOM_CAMERAS);
        room_camera(&r->picture[i].camera, i % ROOM_CAMERAS);
        r->rgb[i] = malloc((size_t)ROOM_W * ROOM_H * 3);
        r->shown.picture[i] = (size_t)i;
        r->shown.rgb[i] = r->rgb[i];
        room_paint(r, i);
    }
}

static inline void room_free(room *r)
{
    for (int i = 0; i < ROOM_PICTURES; i++)
        free(r->rgb[i]);
}

#endif
