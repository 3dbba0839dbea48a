/* png_file.h - rendered views as PNG files in memory (annex I, informative). It needs libpng, so no
 * normative file includes it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PNG_FILE_H
#define TED4_PNG_FILE_H

#include <stddef.h>
#include <stdint.h>

/* Encodes rgb, [height][width][3] sRGB bytes. Returns the PNG file of *size bytes, for the caller
 * to free(), or NULL with a reason in why (truncated to why_size bytes). */
uint8_t *ted4_png_encode(int width, int height, const uint8_t *rgb, size_t *size, char *why,
                         size_t why_size);

#endif
