/* file_cameras.h - what a file says of cameras and of the up direction (spec 16.4).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FILE_CAMERAS_H
#define TED4_FILE_CAMERAS_H

#include <stddef.h>
#include <stdint.h>

#include "cams.h"

/* Sets up to the up direction that a file's chunks CAMS name last, in scene coordinates; all 0 if
 * none does. file: [size], accepted by a decoder. */
void ted4_file_up(const uint8_t *file, size_t size, float up[3]);

#endif
