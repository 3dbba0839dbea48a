/* picture_out.c - see picture_out.h. The simplified interface of libpng does not need setjmp.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "picture_out.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <string.h>

#include "output.h"

/* Writes to an open file. Returns 0, or -1 with a reason in why. */
static int write_png(FILE *f, int width, int height, const uint8_t *rgb, char *why, size_t why_size)
{
    png_image p;

    memset(&p, 0, sizeof p);
    p.version = PNG_IMAGE_VERSION;
    p.width = (png_uint_32)width;
    p.height = (png_uint_32)height;
    p.format = PNG_FORMAT_RGB;
    if (png_image_write_to_stdio(&p, f, 0, rgb, 0, NULL))
        return 0;
    if (ferror(f))
        snprintf(why, why_size, "%s", strerror(errno));
    else
        snprintf(why, why_size, "PNG: %s", p.message);
    return -1;
}

int ted4_picture_write(const char *path, int width, int height, const uint8_t *rgb, char *why,
                       size_t why_size)
{
    ted4_output o;

    if (ted4_output_open(&o, path) != 0) {
        snprintf(why, why_size, "%s", strerror(errno));
        return -1;
    }
    if (write_png(o.file, width, height, rgb, why, why_size) != 0) {
        ted4_output_cancel(&o);
        return -1;
    }
    if (ted4_output_close(&o) == 0)
        return 0;
    snprintf(why, why_size, "%s", strerror(errno));
    return -1;
}
