/* ray_layout.h - names and contents of the files of each layout, except pictures. Depends on
 * ray_rig.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_LAYOUT_H
#define RAY_LAYOUT_H

#include <stdio.h>
#include "ray_rig.h"

enum { TED4_RAY_NAME = 80 };

/* Makes a name such as "cam07"; test cameras come first. */
void ted4_ray_camera_name(const ted4_ray_options *o, int number, char name[TED4_RAY_NAME]);

/* Makes the name of a picture's file in the scene's folder. */
void ted4_ray_picture_name(const ted4_ray_options *o, int number, int frame,
                           char name[TED4_RAY_NAME]);

typedef void ted4_ray_put(FILE *f, const ted4_ray_options *o, int number, int frame);

typedef struct {
    const char *name;
    ted4_ray_put *put;
    int number, frame;                        /* for put; unused in files of the whole scene */
    int (*wanted)(const ted4_ray_options *o); /* NULL: always wanted */
} ted4_ray_file;

/* Returns the files in the order to write them; the last entry has the name NULL. */
const ted4_ray_file *ted4_ray_layout_files(ted4_ray_layout l);

/* Makes the name of the camera file of one picture, which only hypernerf has. */
void ted4_ray_hypernerf_camera_name(const ted4_ray_options *o, int number, int frame,
                                    char name[TED4_RAY_NAME]);
ted4_ray_put ted4_ray_put_hypernerf_camera;

#endif
