/* camera_transforms.h - cameras of transforms_*.json, as D-NeRF, Blender and nerfstudio write them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_TRANSFORMS_H
#define TED4_CAMERA_TRANSFORMS_H

#include <jansson.h>
#include <stddef.h>

#include "camera_list.h"

/* Reads the frames of a transforms file into the empty list *l. file: its JSON object; path: its
 * name, from where pictures are found that tell a missing size. l->distorted says whether a lens
 * is. Times are fractions of the scene as they are. Returns 0, or -1 with why filled; *l must be
 * freed in both cases. */
int ted4_transforms_read(const json_t *file, const char *path, ted4_camera_list *l, char *why,
                         size_t why_size);

#endif
