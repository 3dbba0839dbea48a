/* eval_images.c - see eval_images.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "eval_images.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "moving_pixels.h"
#include "render/png_file.h"
#include "sheet.h"

enum { PATH_SIZE = 4096 };

/* Returns -1, with "what: why" in *m. */
static int failed(ted4_message *m, const char *what, const char *why)
{
    const int n = snprintf(m->text, sizeof m->text, "%s: %s", what, why);

    if (n >= (int)sizeof m->text) /* the end of the name matters more than its beginning */
        snprintf(m->text, sizeof m->text, "...%s: %s", what + strlen(what) - 500, why);
    return -1;
}

static int write_one(const ted4_eval_images *to, const char *kind, const ted4_camera *c,
                     const uint8_t *rgb, ted4_message *m)
{
    char path[PATH_SIZE], why[256];
    int n = snprintf(path, sizeof path, "%s/%s", to->folder, kind);

    if (n > 0 && n < PATH_SIZE && mkdir(path, 0777) != 0 && errno != EEXIST)
        return failed(m, path, strerror(errno));
    n = snprintf(path, sizeof path, "%s/%s/%05zu.png", to->folder, kind, to->number);
    if (n < 0 || n >= PATH_SIZE)
        return failed(m, to->folder, "name too long");
    if (!to->overwrite && access(path, F_OK) == 0)
        return failed(m, path, "exists; -f overwrites");
    return ted4_png_write(path, c->width, c->height, rgb, why, sizeof why) == 0
               ? 0
               : failed(m, path, why);
}

int ted4_eval_images_write(const ted4_eval_images *to, const ted4_camera *c, const uint8_t *truth,
                           const uint8_t *ours, const uint8_t *median, ted4_message *m)
{
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    uint8_t *const made = malloc(3 * pixels);
    ted4_moving_sum unused = { 0 };
    int code;

    if (made == NULL)
        return failed(m, to->folder, "out of memory");
    ted4_sheet_error(truth, ours, 3 * pixels, made);
    code = write_one(to, "truth", c, truth, m);
    if (code == 0)
        code = write_one(to, "ours", c, ours, m);
    if (code == 0)
        code = write_one(to, "error", c, made, m);
    if (code == 0 && median != NULL) {
        ted4_moving_add(&unused, median, truth, ours, pixels, made);
        code = write_one(to, "moving", c, made, m);
    }
    free(made);
    return code;
}
