/* colmap_file.c - reads a COLMAP model, of which each file may be binary or text. See
 * colmap_file.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/colmap_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"

typedef int part_reader(ted4_colmap *c, const char *path, ted4_message *m);

/* Reads folder/name.bin, or if there is none, folder/name.txt. Returns 1 if neither exists. */
static int read_part(ted4_colmap *c, const char *folder, const char *name, part_reader *bin,
                     part_reader *txt, ted4_message *m)
{
    part_reader *const reader[2] = { bin, txt };

    for (int i = 0; i < 2; i++) {
        char file[32];
        snprintf(file, sizeof file, "%s.%s", name, i == 0 ? "bin" : "txt");
        char *path = ted4_path_join(folder, file);
        if (path == NULL)
            return ted4_say_no_memory(m);
        const int found = ted4_is_file(path);
        const int result = found ? reader[i](c, path, m) : 1;
        free(path);
        if (found)
            return result;
    }
    ted4_say(m, "%s: neither %s.bin nor %s.txt", folder, name, name);
    return 1;
}

static int by_name(const void *a, const void *b)
{
    const ted4_colmap_image *x = a, *y = b;
    int order = strcmp(x->name, y->name);

    /* A file may name a picture twice; such entries need a fixed order too. */
    if (order == 0)
        order = (x->camera > y->camera) - (x->camera < y->camera);
    for (int k = 0; order == 0 && k < 3; k++)
        order = (x->t[k] > y->t[k]) - (x->t[k] < y->t[k]);
    for (int k = 0; order == 0 && k < 9; k++)
        order = (x->R[k] > y->R[k]) - (x->R[k] < y->R[k]);
    return order;
}

int ted4_colmap_read(ted4_colmap *c, const char *folder, ted4_message *m)
{
    memset(c, 0, sizeof *c);
    if (read_part(c, folder, "cameras", ted4_colmap_bin_cameras, ted4_colmap_txt_cameras, m) != 0 ||
        read_part(c, folder, "images", ted4_colmap_bin_images, ted4_colmap_txt_images, m) != 0)
        return -1;
    if (c->n_images > 0)
        qsort(c->images, c->n_images, sizeof *c->images, by_name);
    return read_part(c, folder, "points3D", ted4_colmap_bin_points, ted4_colmap_txt_points, m) < 0
               ? -1
               : 0;
}

void ted4_colmap_free(ted4_colmap *c)
{
    for (size_t i = 0; i < c->n_images; i++)
        free(c->images[i].name);
    free(c->images);
    free(c->cameras);
    ted4_point_cloud_free(&c->cloud);
    memset(c, 0, sizeof *c);
}
