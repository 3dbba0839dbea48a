/* ray_camera.h - the fixed rig of cameras of the project's scenes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_CAMERA_H
#define RAY_CAMERA_H

/* Pinhole, square pixels. OpenGL axes: right, up, backwards. */
typedef struct {
    int width, height;
    double focal;        /* in pixels, as all lengths of pictures */
    double cx, cy;       /* principal point; as placed, the middle of the picture */
    double matrix[4][4]; /* camera to world */
    float colour[9]; /* row-major: linear light to what the camera takes it for; a unit matrix as
                        placed */
} ted4_ray_camera;

/* Horizontal field of view in radians; distance from the middle of the scene in units. */
extern const double ted4_ray_angle_x, ted4_ray_radius;

/* Camera i of n on the arc. Training cameras go up and down in turn; test cameras stand between
 * two of them where n_train > n_test. */
void ted4_ray_camera_train(ted4_ray_camera *c, int i, int n_train, int width, int height);
void ted4_ray_camera_test(ted4_ray_camera *c, int i, int n_test, int n_train, int width,
                          int height);

/* Camera i of n all about the small things of the scene "toys" and above them, a golden angle
 * further each. */
void ted4_ray_camera_dome(ted4_ray_camera *c, int i, int n, int width, int height);

/* World point to pixel coordinates (centres at + 0.5); returns the depth, not positive when it
 * lies behind. */
double ted4_ray_project(const ted4_ray_camera *c, const double world[3], double pixel[2]);

#endif
