/* camera_lens.h - the lens of a frame of a transforms file. Fields count as for ted4enc
 * (ref-encoder/data/transforms_lens.c, doc/layouts.md); of distortion, which views do not have, it
 * is only said whether there is any.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_LENS_H
#define TED4_CAMERA_LENS_H

#include <jansson.h>

#include "render/raster.h"

/* Reads focal lengths and centre of the frame of a file into *v, whose width and height are set.
 * *distorted becomes 1 if the lens is not that of a pinhole, and otherwise stays as it is. Returns
 * NULL, or what is wrong, as in "frame 3 has ...". */
const char *ted4_camera_lens(const json_t *file, const json_t *frame, ted4_view *v, int *distorted);

#endif
