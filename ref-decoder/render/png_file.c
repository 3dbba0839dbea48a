/* png_file.c - see png_file.h. The simplified interface of libpng does not need setjmp.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/png_file.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
    png_alloc_size_t n = 0;
    uint8_t *png = NULL;

    if (png_image_write_get_memory_size(p, n, 0, rgb, 0, NULL) && (png = malloc(n)) != NULL &&
        png_image_write_to_memory(&p, png, &n, 0, rgb, 0, NULL)) {
        *size = n;
        return png;
    }
    snprintf(why, why_size, "PNG: %s", p.message[0] != '\0' ? p.message : "out of memory");
    free(png);
    return NULL;
}

int ted4_png_put(FILE *f, int width, int height, const uint8_t *rgb, char *why, size_t why_size)
{
    png_image p = describe(width, height);

    if (png_image_write_to_stdio(&p, f, 0, rgb, 0, NULL))
        return 0;
    if (ferror(f))
        snprintf(why, why_size, "%s", strerror(errno));
    else
        snprintf(why, why_size, "PNG: %s", p.message);
    return -1;
}

int ted4_png_write(const char *path, int width, int height, const uint8_t *rgb, char *why,
                   size_t why_size)
{
    const size_t capacity = strlen(path) + 32;
    char *temporary = malloc(capacity);

    if (temporary == NULL) {
        snprintf(why, why_size, "out of memory");
        return -1;
    }
    snprintf(temporary, capacity, "%s.%ld.tmp", path, (long)getpid());
    FILE *f = fopen(temporary, "wb");
    int result = -1;
    if (f == NULL) {
        snprintf(why, why_size, "%s", strerror(errno));
    } else {
        result = ted4_png_put(f, width, height, rgb, why, why_size);
        if (fclose(f) != 0 && result == 0) {
            snprintf(why, why_size, "%s", strerror(errno));
            result = -1;
        }
        if (result == 0 && rename(temporary, path) != 0) {
            snprintf(why, why_size, "%s", strerror(errno));
            result = -1;
        }
        if (result != 0)
            remove(temporary);
    }
    free(temporary);
    return result;
}
