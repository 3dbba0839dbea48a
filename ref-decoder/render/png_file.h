/* png_file.h - annex I (informative): writes rendered views as PNG.
 * Needs libpng, so nothing normative includes it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PNG_FILE_H
#define TED4_PNG_FILE_H

#include <stddef.h>
#include <stdint.h>

/* rgb: [height][width][3] sRGB bytes. Written under a temporary name beside path, then renamed,
 * so path never holds half a picture. 0, or -1 with a reason in why (cut to why_size). */
int ted4_png_write(const char *path, int width, int height, const uint8_t *rgb, char *why,
                   size_t why_size);

/* Encodes the same pixels in memory. Returns the PNG file of *size bytes, for the caller to free(),
 * or NULL with a reason in why. */
uint8_t *ted4_png_encode(int width, int height, const uint8_t *rgb, size_t *size, char *why,
                         size_t why_size);

#endif
