/* picture_out.c - see picture_out.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "picture_out.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "output.h"
#include "render/png_file.h"

int ted4_picture_write(const char *path, int width, int height, const uint8_t *rgb, char *why,
                       size_t why_size)
{
    ted4_output o;

    if (ted4_output_open(&o, path) != 0) {
        snprintf(why, why_size, "%s", strerror(errno));
        return -1;
    }
    if (ted4_png_put(o.file, width, height, rgb, why, why_size) != 0) {
        ted4_output_cancel(&o);
        return -1;
    }
    if (ted4_output_close(&o) == 0)
        return 0;
    snprintf(why, why_size, "%s", strerror(errno));
    return -1;
}
