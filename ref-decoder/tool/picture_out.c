/* picture_out.c - see picture_out.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "picture_out.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "render/png_file.h"

int ted4_picture_write(const char *path, int width, int height, const uint8_t *rgb, char *why,
                       size_t why_size)
{
    size_t size;
    uint8_t *const png = ted4_png_encode(width, height, rgb, &size, why, why_size);
    int result = -1;

    if (png != NULL) {
        result = ted4_output_write(path, png, size);
        if (result != 0)
            snprintf(why, why_size, "%s", strerror(errno));
    }
    free(png);
    return result;
}
