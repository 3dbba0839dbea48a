/* poses_bounds.c - see poses_bounds.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/poses_bounds.h"

#include <stdlib.h>
#include <string.h>
#include "data/npy_file.h"

enum { COLUMNS = 17 };

static const char name[] = "poses_bounds.npy";

int ted4_is_poses_bounds(const char *folder)
{
    char *path = ted4_path_join(folder, name);
    const int found = path != NULL && ted4_is_file(path);

    free(path);
    return found;
}

int ted4_poses_bounds_read(ted4_poses_bounds *p, const char *folder, ted4_message *m)
{
    memset(p, 0, sizeof *p);
    p->path = ted4_path_join(folder, name);
    return p->path == NULL ? ted4_say_no_memory(m)
                           : ted4_npy_read(p->path, COLUMNS, &p->poses, &p->rows, m);
}

void ted4_poses_bounds_free(ted4_poses_bounds *p)
{
    free(p->poses);
    free(p->path);
    memset(p, 0, sizeof *p);
}

int ted4_poses_bounds_camera(const ted4_poses_bounds *table, size_t row, ted4_shot *shot,
                             ted4_message *m)
{
    const double *p = table->poses + COLUMNS * row;
    const double h = p[4], w = p[9];
    ted4_lens *l = &shot->lens;

    if (!(w >= 1 && h >= 1 && w <= 1e6 && h <= 1e6))
        return ted4_say(m, "%s: row %zu: size %gx%g, expected numbers of pixels", table->path, row,
                        w, h);
    l->width = (int)w;
    l->height = (int)h;
    l->fx = l->fy = p[14];
    l->cx = 0.5 * l->width;
    l->cy = 0.5 * l->height;
    for (int j = 0; j < 3; j++) {
        shot->R[j] = p[5 * j + 1];
        shot->R[3 + j] = p[5 * j];
        shot->R[6 + j] = -p[5 * j + 2];
    }
    const char *wrong = ted4_rotation_clean(shot->R);
    if (wrong != NULL)
        return ted4_say(m, "%s: row %zu: its 3x3 part %s", table->path, row, wrong);
    for (int i = 0; i < 3; i++)
        shot->t[i] =
            -(shot->R[3 * i] * p[3] + shot->R[3 * i + 1] * p[8] + shot->R[3 * i + 2] * p[13]);
    return 0;
}
