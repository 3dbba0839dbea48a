/* eval_images.c - see eval_images.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "eval_images.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "file_out.h"
#include "moving_pixels.h"
#include "render/png_file.h"
#include "tool/output.h"
#include "tool/picture_out.h"

enum { TRUTH, OURS, ERROR, MOVING, N_KINDS };
static const char *const kinds[N_KINDS] = {
    [TRUTH] = "truth", [OURS] = "ours", [ERROR] = "error", [MOVING] = "moving"
};

/* Returns -1, with "what: why" in *m. */
static int failed(ted4_message *m, const char *what, const char *why)
{
    const int n = snprintf(m->text, sizeof m->text, "%s: %s", what, why);

    if (n >= (int)sizeof m->text) /* the end of the name matters more than its beginning */
        snprintf(m->text, sizeof m->text, "...%s: %s", what + strlen(what) - 500, why);
    return -1;
}

static int make_folder(const char *path, ted4_message *m)
{
    return mkdir(path, 0777) == 0 || errno == EEXIST ? 0 : failed(m, path, strerror(errno));
}

/* Makes the name of a picture. Returns 0, or -1 with *m filled. */
static int name_one(char path[TED4_PATH_SIZE], const ted4_eval_images *to, const char *kind,
                    ted4_message *m)
{
    const int n = snprintf(path, TED4_PATH_SIZE, "%s/%s/%05zu.png", to->folder, kind, to->number);

    return n > 0 && n < TED4_PATH_SIZE ? 0 : failed(m, to->folder, "name too long");
}

int ted4_eval_images_begin(const char *folder, size_t n, int moving, int overwrite, ted4_message *m)
{
    for (size_t k = 0; k < N_KINDS - !moving; k++) {
        for (size_t i = 0; i < n; i++) {
            const ted4_eval_images to = { folder, i };
            char path[TED4_PATH_SIZE];

            if (name_one(path, &to, kinds[k], m) != 0)
                return -1;
            if (!overwrite && ted4_output_exists(path))
                return failed(m, path, "exists; -f overwrites");
        }
    }
    return make_folder(folder, m);
}

static int write_one(const ted4_eval_images *to, const char *kind, const ted4_camera *c,
                     const uint8_t *rgb, ted4_message *m)
{
    char path[TED4_PATH_SIZE], why[256];

    if (name_one(path, to, kind, m) != 0)
        return -1;
    *strrchr(path, '/') = '\0';
    if (make_folder(path, m) != 0 || name_one(path, to, kind, m) != 0)
        return -1;
    return ted4_picture_write(path, c->width, c->height, rgb, why, sizeof why) == 0
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
    code = write_one(to, kinds[TRUTH], c, truth, m);
    if (code == 0)
        code = write_one(to, kinds[OURS], c, ours, m);
    if (code == 0)
        code = write_one(to, kinds[ERROR], c, made, m);
    if (code == 0 && median != NULL) {
        ted4_moving_add(&unused, median, truth, ours, pixels, made);
        code = write_one(to, kinds[MOVING], c, made, m);
    }
    free(made);
    return code;
}

int ted4_eval_sheet_write(const ted4_sheet *s, const char *path, int force, char *why,
                          size_t why_size)
{
    size_t size;
    uint8_t *const png = ted4_png_encode(s->width * TED4_SHEET_COLUMNS, s->height * s->rows, s->rgb,
                                         &size, why, why_size);
    int code;

    if (png == NULL)
        return -1;
    code = ted4_file_keep(path, force, png, size, why, why_size);
    free(png);
    return code;
}
