/* ray_picture.h - a picture as a file of one of the kinds that other writers make.
 * Depends on ray_set.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_PICTURE_H
#define RAY_PICTURE_H

#include "ray_set.h"

/* ".png" or ".jpg" */
const char *ted4_ray_ending(const ted4_ray_options *o);

/* rgba [height][width][4]: alpha goes into the file only where the background is transparent. 0, or
 * -1 with *m filled. */
int ted4_ray_write_picture(const ted4_ray_options *o, const char *path, int width, int height,
                           const uint8_t *rgba, ted4_ray_message *m);

/* grey [height][width] */
int ted4_ray_write_grey(const char *path, int width, int height, const uint8_t *grey,
                        ted4_ray_message *m);

#endif
