/* ray_camera.h - the fixed rig of cameras of the project's scenes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_CAMERA_H
#define RAY_CAMERA_H

/* A pinhole camera with square pixels. OpenGL axes: right, up, backwards. */
typedef struct {
    int width, height;
    double focal;        /* in pixels, like all lengths in pictures */
    double cx, cy;       /* principal point; initially the middle of the picture */
    double matrix[4][4]; /* camera to world */
    float colour[9];     /* row-major: maps linear light to the camera's colours; initially the unit
                            matrix */
} ted4_ray_camera;

/* Horizontal field of view in radians, and distance from the middle of the scene in units. */
extern const double ted4_ray_angle_x, ted4_ray_radius;

/* Place camera i of n on the arc. Training cameras alternate between two heights; if n_train >
 * n_test, each test camera stands between two training cameras. */
void ted4_ray_camera_train(ted4_ray_camera *c, int i, int n_train, int width, int height);
void ted4_ray_camera_test(ted4_ray_camera *c, int i, int n_test, int n_train, int width,
                          int height);

/* Places camera i of n around and above the small things of the scene "toys", each turned by a
 * golden angle from the previous one. */
void ted4_ray_camera_dome(ted4_ray_camera *c, int i, int n, int width, int height);

/* Projects a world point to pixel coordinates (pixel centres are at + 0.5). Returns the depth,
 * which is not positive for a point behind the camera. */
double ted4_ray_project(const ted4_ray_camera *c, const double world[3], double pixel[2]);

#endif
