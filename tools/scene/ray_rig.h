/* ray_rig.h - the cameras of a scene: as they are, and as its files state them.
 * Depends on ray_set.h, ray_camera.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_RIG_H
#define RAY_RIG_H

#include "ray_set.h"

/* Cameras have a number: training cameras from 0, then test cameras. These two fill *c with
 *   what takes the pictures: in the coordinates of the room, with its colours;
 *   what the files state: in their coordinates, and for training cameras with an error of pose. */
void ted4_ray_camera_of(const ted4_ray_options *o, int number, ted4_ray_camera *c);
void ted4_ray_camera_stated(const ted4_ray_options *o, int number, ted4_ray_camera *c);

/* Does a training camera look away from the scene? */
int ted4_ray_is_blind(const ted4_ray_options *o, int number);

/* A point of the room in the coordinates of the files. */
void ted4_ray_mapped(const ted4_ray_options *o, const double room[3], double file[3]);

/* How many times those of the room lengths in the files are. */
double ted4_ray_scale(const ted4_ray_options *o);

/* A point of the room that a training camera sees, in the coordinates of the files: where that
 * camera, as stated, sees it. */
vec3 ted4_ray_point_stated(const ted4_ray_options *o, int number, vec3 p);

/* Training camera: turn (rotation vector, radians) and move (units of the room) of its error of
 * pose. Before the mean over the training cameras is taken off, where there are two or more, each
 * is turned by o->pose_error and moved by what that angle is at the distance of the middle. */
void ted4_ray_pose_error(const ted4_ray_options *o, int number, double turn[3], double move[3]);

/* Does a layout list what is held out? Where it does not, readers hold out by rules of their own,
 * also pictures of training cameras. */
int ted4_ray_has_lists(ted4_ray_layout l);

/* Is a time held out: training cameras have no picture of it. Never the first or the last; none in
 * layouts without lists. */
int ted4_ray_is_held(const ted4_ray_options *o, int frame);

/* Is a picture of that camera and time listed? And is it, although listed, not there? */
int ted4_ray_is_taken(const ted4_ray_options *o, int number, int frame);
int ted4_ray_is_missing(const ted4_ray_options *o, int number, int frame);

/* The first time of a camera's clip. */
int ted4_ray_start(const ted4_ray_options *o, int number);

/* What is around the things. */
ted4_ray_background ted4_ray_around(const ted4_ray_options *o);

/* The world of a time, with or without the room. */
void ted4_ray_world_of(const ted4_ray_options *o, int frame, ted4_ray_world *w);

#endif
