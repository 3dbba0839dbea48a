/* ray_picture.h - writes a picture as a file of one of the kinds that other writers make. Depends
 * on ray_set.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_PICTURE_H
#define RAY_PICTURE_H

#include "ray_set.h"

/* Returns ".png" or ".jpg". */
const char *ted4_ray_ending(const ted4_ray_options *o);

/* Writes rgba [height][width][4]. Alpha is written only if the background is transparent. Returns
 * 0, or -1 with *m filled. */
int ted4_ray_write_picture(const ted4_ray_options *o, const char *path, int width, int height,
                           const uint8_t *rgba, ted4_ray_message *m);

/* Writes grey [height][width]. Returns 0, or -1 with *m filled. */
int ted4_ray_write_grey(const char *path, int width, int height, const uint8_t *grey,
                        ted4_ray_message *m);

#endif
