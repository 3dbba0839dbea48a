/* ray_rig.h - the cameras of a scene, as they are and as its files state them. Depends on
 * ray_set.h, ray_camera.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_RIG_H
#define RAY_RIG_H

#include "ray_set.h"

/* Cameras are numbered: training cameras from 0, then test cameras. ted4_ray_camera_of fills *c
 * with the camera that takes the pictures, in the coordinates of the room and with its colours.
 * ted4_ray_camera_stated fills *c with the camera that the files state, in the coordinates of the
 * files; for training cameras it has a pose error. */
void ted4_ray_camera_of(const ted4_ray_options *o, int number, ted4_ray_camera *c);
void ted4_ray_camera_stated(const ted4_ray_options *o, int number, ted4_ray_camera *c);

/* Returns the exposure of a camera at a time, by which its colours are multiplied in linear light.
 * That of a training camera goes up or down by o->drift stops from the first time to the last, in
 * half a period of a cosine, about its middle; if there are two or more of them, the mean logarithm
 * over the training cameras is 0 at every time. Test cameras have exposure 1, unless they are
 * training cameras. */
double ted4_ray_exposure(const ted4_ray_options *o, int number, int frame);

/* Multiplies the colours of a camera by its exposure at a time. */
void ted4_ray_expose(const ted4_ray_options *o, int number, int frame, ted4_ray_camera *c);

/* Returns 1 if a training camera looks away from the scene. */
int ted4_ray_is_blind(const ted4_ray_options *o, int number);

/* Converts a point of the room to the coordinates of the files. */
void ted4_ray_mapped(const ted4_ray_options *o, const double room[3], double file[3]);

/* Returns the ratio of lengths in the files to lengths in the room. */
double ted4_ray_scale(const ted4_ray_options *o);

/* Returns, in the coordinates of the files, the position at which a training camera, as stated,
 * sees the point p of the room. */
vec3 ted4_ray_point_stated(const ted4_ray_options *o, int number, vec3 p);

/* Returns the pose error of a training camera: turn (rotation vector, radians) and move (units of
 * the room). Each camera is turned by o->pose_error, and moved by the length of that angle at the
 * distance of the middle. If there are two or more training cameras, their mean is then subtracted.
 */
void ted4_ray_pose_error(const ted4_ray_options *o, int number, double turn[3], double move[3]);

/* Returns 1 if a layout lists what is held out. Readers of other layouts hold out pictures by their
 * own rules, also pictures of training cameras. */
int ted4_ray_has_lists(ted4_ray_layout l);

/* Returns 1 if a time is held out: training cameras have no picture of it. It is never the first or
 * the last time, and no time in layouts without lists. */
int ted4_ray_is_held(const ted4_ray_options *o, int frame);

/* Return 1 if the picture of that camera and time is listed, or if it is listed but missing. In
 * layouts with lists, cameras of a scene with rounds take one picture each in every round. */
int ted4_ray_is_taken(const ted4_ray_options *o, int number, int frame);
int ted4_ray_is_missing(const ted4_ray_options *o, int number, int frame);

/* Returns the first time of a camera's clip. */
int ted4_ray_start(const ted4_ray_options *o, int number);

/* Returns what surrounds the things. */
ted4_ray_background ted4_ray_around(const ted4_ray_options *o);

/* Makes the world at a time, with or without the room. */
void ted4_ray_world_of(const ted4_ray_options *o, int frame, ted4_ray_world *w);

#endif
