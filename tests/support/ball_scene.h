/* ball_scene.h - a scene of three balls on black, 32x24: pictures, cameras and points, written into
 * a temporary folder. The blue ball can move.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BALL_SCENE_H
#define TED4_BALL_SCENE_H

#include <math.h>

#include "tiny_scene.h"

enum { BALL_W = 32, BALL_H = 24, BALL_CAMERAS = 4, BALLS = 3, BALL_POINTS = 70 };

#define BALL_FOCAL 34.0

typedef struct {
    double centre[3], radius, colour[3];
} ball;

/* Ball i at a time in [0, 1]. */
static inline ball ball_at(int i, double time)
{
    static const ball all[BALLS] = { { { 0, 0, 0 }, 0.55, { 220, 60, 40 } },
                                     { { 0.8, -0.1, 0.3 }, 0.35, { 50, 200, 80 } },
                                     { { -0.8, -0.5, -0.2 }, 0.3, { 60, 90, 230 } } };
    ball b = all[i];

    if (i == 2)
        b.centre[1] += time;
    return b;
}

/* The columns right, up and backward of camera i, which stands on an arc around the scene. */
static inline void ball_camera(int i, double axis[3][3], double centre[3])
{
    const double a = 0.5 * (i - 0.5 * (BALL_CAMERAS - 1)), e = i % 2 ? 0.3 : -0.1;
    const double all[3][3] = { { cos(a), 0, -sin(a) },
                               { -sin(a) * sin(e), cos(e), -cos(a) * sin(e) },
                               { sin(a) * cos(e), sin(e), cos(a) * cos(e) } };

    memcpy(axis, all, sizeof all);
    for (int k = 0; k < 3; k++)
        centre[k] = 3.2 * axis[2][k];
}

/* Colour along a ray from the camera's centre; d has unit length. */
static inline void ball_trace(const double *centre, const double *d, double time, double *rgb)
{
    double nearest = 1e9;

    memset(rgb, 0, 3 * sizeof *rgb);
    for (int i = 0; i < BALLS; i++) {
        const ball b = ball_at(i, time);
        double along = 0, square = 0, light = 0;

        for (int k = 0; k < 3; k++) {
            along += (b.centre[k] - centre[k]) * d[k];
            square += (b.centre[k] - centre[k]) * (b.centre[k] - centre[k]);
        }
        const double inside = b.radius * b.radius - (square - along * along);
        const double depth = along - sqrt(fmax(inside, 0));

        if (inside <= 0 || depth >= nearest)
            continue;
        nearest = depth;
        light = (centre[1] + depth * d[1] - b.centre[1]) / b.radius;
        for (int k = 0; k < 3; k++)
            rgb[k] = b.colour[k] * (0.7 + 0.3 * light);
    }
}

/* Renders a picture with four rays per pixel. */
static inline void ball_picture(const tiny_folder *f, const char *name, int camera, double time)
{
    uint8_t px[BALL_W * BALL_H * 3];
    double axis[3][3], centre[3];

    ball_camera(camera, axis, centre);
    for (int i = 0; i < BALL_W * BALL_H; i++) {
        double sum[3] = { 0, 0, 0 };

        for (int s = 0; s < 4; s++) {
            const double x = (i % BALL_W + 0.25 + 0.5 * (s % 2) - 0.5 * BALL_W) / BALL_FOCAL;
            const double y = (0.5 * BALL_H - i / BALL_W - 0.25 - 0.5 * (s / 2)) / BALL_FOCAL;
            const double n = sqrt(x * x + y * y + 1);
            double d[3], rgb[3];

            for (int k = 0; k < 3; k++)
                d[k] = (x * axis[0][k] + y * axis[1][k] - axis[2][k]) / n;
            ball_trace(centre, d, time, rgb);
            for (int k = 0; k < 3; k++)
                sum[k] += 0.25 * rgb[k];
        }
        for (int k = 0; k < 3; k++)
            px[3 * i + k] = (uint8_t)(sum[k] + 0.5);
    }
    tiny_png(f, name, BALL_W, BALL_H, PNG_FORMAT_RGB, px);
}

static inline void ball_points(const tiny_folder *f, int moving)
{
    static tiny_string s;

    s.n = 0;
    tiny_add(&s,
             "ply\nformat ascii 1.0\nelement vertex %d\n"
             "property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
             "property uchar green\nproperty uchar blue\nend_header\n",
             BALLS * BALL_POINTS);
    for (int i = 0; i < BALLS * BALL_POINTS; i++) {
        const int k = i / BALLS;
        const ball b = ball_at(i % BALLS, moving ? 0.25 * (k % 5) : 0);
        const double z = 1 - 2 * (k + 0.5) / BALL_POINTS, r = sqrt(1 - z * z), a = 2.4 * k;

        tiny_add(&s, "%.4f %.4f %.4f %d %d %d\n", b.centre[0] + b.radius * r * cos(a),
                 b.centre[1] + b.radius * r * sin(a), b.centre[2] + b.radius * z, (int)b.colour[0],
                 (int)b.colour[1], (int)b.colour[2]);
    }
    tiny_text(f, "points.ply", s.text);
}

/* Writes the scene, in which every camera sees every frame. moving: how far the blue ball moves, as
 * a multiple of its usual path (0: it stands still). */
static inline void ball_scene(const tiny_folder *f, int frames, int moving)
{
    static tiny_string s;

    s.n = 0;
    tiny_add(&s,
             "{\"fl_x\": %g, \"w\": %d, \"h\": %d, \"fps\": 5, "
             "\"ply_file_path\": \"points.ply\", \"frames\": [",
             BALL_FOCAL, BALL_W, BALL_H);
    for (int i = 0; i < frames * BALL_CAMERAS; i++) {
        const int camera = i % BALL_CAMERAS, frame = i / BALL_CAMERAS;
        const double time = frames > 1 ? (double)frame / (frames - 1) : 0;
        double axis[3][3], centre[3];
        char name[64];

        snprintf(name, sizeof name, "images/c%d_f%d.png", camera, frame);
        ball_picture(f, name, camera, moving * time);
        ball_camera(camera, axis, centre);
        tiny_add(&s, "%s{\"file_path\": \"%s\", ", i > 0 ? "," : "", name);
        if (frames > 1)
            tiny_add(&s, "\"time\": %.17g, ", time);
        tiny_add(&s, "\"transform_matrix\": [");
        for (int k = 0; k < 3; k++)
            tiny_add(&s, "[%.9f,%.9f,%.9f,%.9f],", axis[0][k], axis[1][k], axis[2][k], centre[k]);
        tiny_add(&s, "[0,0,0,1]]}");
    }
    tiny_add(&s, "]}");
    tiny_text(f, "transforms.json", s.text);
    ball_points(f, moving);
}

#endif
