/* png_file.h - rendered views as PNG, in memory, and as files for programs that measure: those of
 * users write by tool/picture_out.h, which leaves nothing behind when a signal ends them. It needs
 * libpng, so no normative file includes it (annex I, informative).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PNG_FILE_H
#define TED4_PNG_FILE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Writes rgb, [height][width][3] sRGB bytes, to an open file, which stays open. Returns 0, or -1
 * with a reason in why (truncated to why_size bytes). */
int ted4_png_put(FILE *f, int width, int height, const uint8_t *rgb, char *why, size_t why_size);

/* Writes the same pixels to a temporary file beside path, which is then renamed to path, so that
 * path never holds an incomplete image. Returns 0, or -1 with a reason in why, which does not name
 * the file. */
int ted4_png_write(const char *path, int width, int height, const uint8_t *rgb, char *why,
                   size_t why_size);

/* Encodes the same pixels in memory. Returns the PNG file of *size bytes, for the caller to free(),
 * or NULL with a reason in why. */
uint8_t *ted4_png_encode(int width, int height, const uint8_t *rgb, size_t *size, char *why,
                         size_t why_size);

#endif
