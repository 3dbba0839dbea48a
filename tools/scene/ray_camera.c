/* ray_camera.c - cameras on an arc around the middle of the scene, at two heights, and on a dome.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_camera.h"

#include "ray_math.h"

/* The rig: target, distance from it, and the ranges of azimuth (to either side) and elevation, in
 * turns. */
static const double target[3] = { 0.0, 0.15, 0.78 };
const double ted4_ray_radius = 3.7;
static const double azimuth = 38.0 / 360, low = 9.0 / 360, high = 27.0 / 360;

/* The tangent of half this angle, 0.5, is exact. */
const double ted4_ray_angle_x = 0.92729521800161223;
static const double half_width = 0.5;

/* The dome: target, distance, elevations and the golden angle, in turns. */
static const double dome_target[3] = { 0.0, 0.15, 0.4 };
static const double dome_radius = 3.9, dome_low = 0.03, dome_high = 0.19;
static const double golden = 0.38196601125010515;

/* Returns by how many of n heights, cyclically, each camera is above the previous one: about two
 * fifths of n, without a common divisor, so that all heights are used and no two neighbours share
 * one. */
static int stride(int n)
{
    for (int s = 2 * n / 5; s > 1; s--) {
        int a = n, b = s;

        while (b > 0) {
            const int rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1)
            return s;
    }
    return 1;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Aims the camera at a point from a distance, with azimuth (0: from the front) and elevation in
 * turns. */
static void look(ted4_ray_camera *c, const double at[3], double distance, double a, double e)
{
    const double back[3] = { ted4_ray_sin(a) * ted4_ray_cos(e), -ted4_ray_cos(a) * ted4_ray_cos(e),
                             ted4_ray_sin(e) };
    const double right[3] = { ted4_ray_cos(a), ted4_ray_sin(a), 0 };
    const double up[3] = { -ted4_ray_sin(a) * ted4_ray_sin(e), ted4_ray_cos(a) * ted4_ray_sin(e),
                           ted4_ray_cos(e) };

    for (int i = 0; i < 3; i++) {
        c->matrix[i][0] = right[i];
        c->matrix[i][1] = up[i];
        c->matrix[i][2] = back[i];
        c->matrix[i][3] = at[i] + distance * back[i];
        c->matrix[3][i] = 0;
    }
    c->matrix[3][3] = 1;
}

static void lens(ted4_ray_camera *c, int width, int height)
{
    c->width = width;
    c->height = height;
    c->focal = 0.5 * width / half_width;
    c->cx = 0.5 * width;
    c->cy = 0.5 * height;
    for (int i = 0; i < 9; i++)
        c->colour[i] = i % 4 == 0 ? 1 : 0;
}

/* Places a camera: u from 0 (left) to 1 (right), v from 0 (low) to 1 (high). */
static void place(ted4_ray_camera *c, double u, double v, int width, int height)
{
    lens(c, width, height);
    look(c, target, ted4_ray_radius, azimuth * (2 * u - 1), low + v * (high - low));
}

void ted4_ray_camera_dome(ted4_ray_camera *c, int i, int n, int width, int height)
{
    const double e = dome_low + (dome_high - dome_low) * (i * stride(n) % n + 0.5) / n;

    lens(c, width, height);
    look(c, dome_target, dome_radius, golden * i, e);
}

void ted4_ray_camera_train(ted4_ray_camera *c, int i, int n_train, int width, int height)
{
    place(c, n_train > 1 ? (double)i / (n_train - 1) : 0.5, i % 2, width, height);
}

void ted4_ray_camera_test(ted4_ray_camera *c, int i, int n_test, int n_train, int width, int height)
{
    const int gaps = n_train - 1;
    double u = (i + 0.5) / n_test;

    if (gaps >= n_test)
        u = ((2 * i + 1) * gaps / (2 * n_test) + 0.5) / gaps;
    place(c, u, 0.5, width, height);
}

double ted4_ray_project(const ted4_ray_camera *c, const double world[3], double pixel[2])
{
    double at[3], axis[3][3];

    for (int k = 0; k < 3; k++) {
        at[k] = world[k] - c->matrix[k][3];
        for (int i = 0; i < 3; i++)
            axis[i][k] = c->matrix[k][i];
    }
    const double depth = -dot(at, axis[2]);
    pixel[0] = c->cx + c->focal * dot(at, axis[0]) / depth;
    pixel[1] = c->cy - c->focal * dot(at, axis[1]) / depth;
    return depth;
}
