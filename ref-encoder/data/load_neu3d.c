/* load_neu3d.c - layout "neu3d" (Neural 3D Video, also DyNeRF): poses_bounds.npy and one clip a
 * camera (clip.h). Row i of the table belongs to clip i in the order of names: a 3x5 matrix row-major
 * - columns down, right, back, centre in the world, and (height, width, focal length in pixels) - and
 * two bounds of depth, not used. The first camera is held out. Times: frame over frame.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/clip.h"
#include "data/data_util.h"
#include "data/npy_file.h"

enum { COLUMNS = 17, MOST_FRAMES = 300 };       /* the frames that results on these scenes refer to */

static const double VIDEO_RATE = 30;            /* frames a second, of every scene of the set */

typedef struct {
    ted4_raw_scene *scene;
    const char     *folder;
    char           *path;           /* of the table; owned */
    double         *poses;          /* [rows][COLUMNS]; owned */
    size_t          rows, shortest, longest;   /* of clips, in frames */
    ted4_name_list  clips;
    ted4_message   *m;
} neu3d;

/* A COLMAP scene may hold such a table too; then the clips decide. */
int ted4_is_neu3d(const char *folder)
{
    char *table = ted4_path_join(folder, "poses_bounds.npy");
    int found = table != NULL && ted4_is_file(table);

    free(table);
    if (found && ted4_is_colmap(folder)) {
        ted4_name_list clips;
        found = ted4_clip_names(&clips, folder) == 0 && clips.n > 0;
        ted4_name_list_free(&clips);
    }
    return found;
}

static int read_camera(neu3d *n, size_t row, ted4_shot *shot)
{
    const double *p = n->poses + COLUMNS * row;
    const double h = p[4], w = p[9];
    ted4_lens *l = &shot->lens;

    if (!(w >= 1 && h >= 1 && w <= 1e6 && h <= 1e6))
        return ted4_say(n->m, "%s: row %zu: size %gx%g, expected numbers of pixels", n->path, row, w, h);
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
        return ted4_say(n->m, "%s: row %zu: its 3x3 part %s", n->path, row, wrong);
    for (int i = 0; i < 3; i++)
        shot->t[i] = -(shot->R[3 * i] * p[3] + shot->R[3 * i + 1] * p[8] + shot->R[3 * i + 2] * p[13]);
    return 0;
}

static int add_clip(neu3d *n, size_t i)
{
    const uint32_t wanted = n->scene->wanted->max_frames;
    const char *name = n->clips.names[i];
    ted4_shot model;
    ted4_name_list pictures;

    memset(&model, 0, sizeof model);
    model.is_test = i == 0;
    if (read_camera(n, i, &model) != 0)
        return -1;
    int result = ted4_clip_pictures(&pictures, n->folder, name, NULL, wanted > 0 ? wanted : MOST_FRAMES, n->m);
    if (result == 0)
        result = ted4_say(n->m, "%s/%s: neither a video nor a folder of pictures", n->folder, name);
    if (result < 0)
        return -1;
    n->shortest = i == 0 || pictures.n < n->shortest ? pictures.n : n->shortest;
    n->longest = pictures.n > n->longest ? pictures.n : n->longest;
    result = ted4_clip_add(n->scene, &pictures, name, &model, n->m);
    ted4_name_list_free(&pictures);
    return result;
}

static int read_all(neu3d *n)
{
    if (n->path == NULL || ted4_clip_names(&n->clips, n->folder) != 0)
        return ted4_say_no_memory(n->m);
    if (ted4_npy_read(n->path, COLUMNS, &n->poses, &n->rows, n->m) != 0)
        return -1;
    if (n->clips.n != n->rows)
        return ted4_say(n->m, "%s: %zu rows, but %zu cameras (cam*.mp4, cam*/images/ or images/cam*/) in the folder",
                        n->path, n->rows, n->clips.n);
    for (size_t i = 0; i < n->clips.n; i++)
        if (add_clip(n, i) != 0)
            return -1;
    if (ted4_clip_lengths(n->scene, n->shortest, n->longest, n->m) != 0)
        return -1;
    return ted4_ply_find(&n->scene->cloud, n->folder, n->m);
}

int ted4_load_neu3d(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    neu3d n;

    memset(&n, 0, sizeof n);
    s->layout = "neu3d";
    s->timed = 1;
    s->rate = VIDEO_RATE;
    n.scene = s;
    n.folder = folder;
    n.m = m;
    n.path = ted4_path_join(folder, "poses_bounds.npy");
    const int result = read_all(&n);
    ted4_name_list_free(&n.clips);
    free(n.poses);
    free(n.path);
    return result;
}
