/* fz_camera_list.c - the cameras of ted4dec --render, as a JSON list or a transforms file. Claims:
 * the result is either cameras with sizes, focal lengths and rotations that the renderer accepts,
 * each with a frame, a time in [0, 1], or neither, and the same cameras when they are printed and
 * read again; or a message of one line, and no camera.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>
#include "harness.h"
#include "scene_folder.h"
#include "tool/camera_list.h"

static void check_camera(const ted4_listed_camera *c)
{
    const ted4_view *v = &c->view;
    const float lens[4] = { v->fx, v->fy, v->cx, v->cy };

    fuzz_require(v->width >= 1 && v->height >= 1 && v->width <= 16384 && v->height <= 16384,
                 "a size");
    for (int i = 0; i < 9; i++)
        fuzz_require(isfinite(v->R[i]) && isfinite(lens[i % 4]) && isfinite(v->t[i % 3]), "finite");
    fuzz_require(v->fx > 0 && v->fy > 0, "focal lengths");
    fuzz_require(c->has_frame || c->time.num <= c->time.den, "a time");
}

static int is_same(const ted4_listed_camera *a, const ted4_listed_camera *b)
{
    return memcmp(&a->view, &b->view, sizeof a->view) == 0 && a->has_frame == b->has_frame &&
           a->frame == b->frame && a->time.num == b->time.num && a->time.den == b->time.den;
}

static void check_print(const ted4_camera_list *l)
{
    ted4_camera_list again;
    char *text = NULL, why[200];
    size_t size = 0;
    FILE *const f = open_memstream(&text, &size);

    fuzz_require(f != NULL, "memory");
    ted4_camera_list_print(l, f);
    fuzz_require(fclose(f) == 0, "memory");
    fuzz_require(ted4_camera_list_load(&again, fuzz_file("again.json", text, size), why,
                                       sizeof why) == 0 &&
                     again.n == l->n,
                 "cameras that are printed are read");
    for (size_t i = 0; i < l->n; i++)
        fuzz_require(is_same(&l->camera[i], &again.camera[i]), "the same cameras");
    ted4_camera_list_free(&again);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ted4_camera_list l;
    char why[200];

    (void)fuzz_scene("camera_list");
    if (ted4_camera_list_load(&l, fuzz_file("cameras.json", data, size), why, sizeof why) == 0) {
        fuzz_require(l.n > 0, "a camera");
        for (size_t i = 0; i < l.n; i++)
            check_camera(&l.camera[i]);
        check_print(&l);
    } else {
        fuzz_require(memchr(why, 0, sizeof why) != NULL && why[0] != 0, "a message");
        fuzz_require(l.camera == NULL && l.n == 0, "no camera");
    }
    ted4_camera_list_free(&l);
    return 0;
}
