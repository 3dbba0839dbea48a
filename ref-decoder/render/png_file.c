/* png_file.c - see png_file.h. The simplified interface of libpng does not need setjmp.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/png_file.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static png_image describe(int width, int height)
{
    png_image p;

    memset(&p, 0, sizeof p);
    p.version = PNG_IMAGE_VERSION;
    p.width = (png_uint_32)width;
    p.height = (png_uint_32)height;
    p.format = PNG_FORMAT_RGB;
    return p;
}

uint8_t *ted4_png_encode(int width, int height, const uint8_t *rgb, size_t *size, char *why,
                         size_t why_size)
{
    png_image p = describe(width, height);
    png_alloc_size_t n = PNG_IMAGE_PNG_SIZE_MAX(p); /* the exact size would take encoding twice */
    uint8_t *const png = malloc(n);

    if (png != NULL && png_image_write_to_memory(&p, png, &n, 0, rgb, 0, NULL)) {
        *size = n;
        return png;
    }
    snprintf(why, why_size, "PNG: %s", p.message[0] != '\0' ? p.message : "out of memory");
    free(png);
    return NULL;
}
