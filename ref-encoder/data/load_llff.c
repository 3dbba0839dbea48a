/* load_llff.c - loads the layout "LLFF": poses_bounds.npy (poses_bounds.h), and stills in images/
 * or, reduced by N, in images_N/, one per row in the order of names. Every eighth picture is held
 * out, beginning with the first, as in published results on these scenes. There is one time.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/clip.h"
#include "data/poses_bounds.h"

/* A COLMAP scene may also hold such a table, but its model is more complete and is preferred. */
int ted4_is_llff(const char *folder)
{
    return ted4_is_poses_bounds(folder) && !ted4_is_colmap(folder);
}

static int may_read_images(const char *folder, ted4_message *m)
{
    char *images = ted4_path_join(folder, "images");
    const int result = images == NULL ? ted4_say_no_memory(m) : ted4_may_read(images, m);

    free(images);
    return result;
}

/* Finds the pictures in images_N for the requested reduction N if these are as many as rows, else
 * in images, else in the least reduced images_N. */
static int find_pictures(ted4_raw_scene *s, const char *folder, size_t rows,
                         ted4_name_list *pictures, ted4_message *m)
{
    const int sizes[] = { s->wanted->downscale, 1, 2, 4, 8, 16 };
    char name[32];

    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        snprintf(name, sizeof name, sizes[i] > 1 ? "images_%d" : "images", sizes[i]);
        char *place = ted4_path_join(folder, name);
        const int result = place == NULL ? -1 : ted4_clip_list(pictures, place, 0);
        free(place);
        if (result != 0)
            return ted4_say_no_memory(m);
        s->reduced = sizes[i];
        if (pictures->n == rows || (i > 0 && pictures->n > 0))
            break;
        ted4_name_list_free(pictures);
    }
    if (pictures->n == rows)
        return 0;
    if (pictures->n == 0 && may_read_images(folder, m) != 0)
        return -1;
    return ted4_say(m,
                    "%s/poses_bounds.npy: %zu rows, but %zu pictures in %s/, and no cameras "
                    "(cam*.mp4, cam*/images/ or images/cam*/)",
                    folder, rows, pictures->n, pictures->n > 0 ? name : "images");
}

static int add_pictures(ted4_raw_scene *s, const ted4_poses_bounds *table,
                        const ted4_name_list *pictures, ted4_message *m)
{
    char where[600];

    for (size_t i = 0; i < pictures->n; i++) {
        snprintf(where, sizeof where, "%.500s: row %zu", table->path, i);
        ted4_shot *shot = ted4_raw_scene_add(s, ted4_text_copy(pictures->names[i]), where, m);
        if (shot == NULL || ted4_poses_bounds_camera(table, i, shot, m) != 0)
            return -1;
        shot->is_test = i % TED4_HOLD_OUT_EVERY == 0;
    }
    return 0;
}

int ted4_load_llff(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    ted4_poses_bounds table;
    ted4_name_list pictures = { NULL, 0 };

    s->layout = "LLFF";
    int result = ted4_poses_bounds_read(&table, folder, m);
    if (result == 0)
        result = find_pictures(s, folder, table.rows, &pictures, m);
    if (result == 0)
        result = add_pictures(s, &table, &pictures, m);
    if (result == 0)
        result = ted4_ply_find(&s->cloud, folder, m);
    ted4_name_list_free(&pictures);
    ted4_poses_bounds_free(&table);
    return result;
}
