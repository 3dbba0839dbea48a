/* picture_out.h - a picture as a PNG file. Uses output.h and libpng.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PICTURE_OUT_H
#define TED4_PICTURE_OUT_H

#include <stddef.h>
#include <stdint.h>

/* Writes rgb, [height][width][3] sRGB bytes, to a file that appears when it is complete. Returns 0,
 * or -1 with a reason in why, which does not name the file (truncated to why_size bytes). */
int ted4_picture_write(const char *path, int width, int height, const uint8_t *rgb, char *why,
                       size_t why_size);

#endif
