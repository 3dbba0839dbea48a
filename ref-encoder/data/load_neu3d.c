/* load_neu3d.c - layout "neu3d" (Neural 3D Video, also DyNeRF): poses_bounds.npy and one clip a
 * camera (clip.h). Row i of the table belongs to clip i in the order of names; where rows are more
 * than clips, and the clips' numbers end with the last row's, clip camNN has row NN. The first
 * camera is held out. Times: frame over frame.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/clip.h"
#include "data/poses_bounds.h"

enum { MOST_FRAMES = 300 }; /* the frames that results on these scenes refer to */

static const double VIDEO_RATE = 30; /* frames a second, of every scene of the set */

typedef struct {
    ted4_raw_scene *scene;
    const char *folder;
    ted4_poses_bounds table;
    size_t shortest, longest; /* of clips, in frames */
    ted4_name_list clips;
    int numbered; /* are rows those of the clips' numbers? */
    ted4_message *m;
} neu3d;

/* A COLMAP scene, or stills, may hold such a table too; the clips decide. */
int ted4_is_neu3d(const char *folder)
{
    ted4_name_list clips = { NULL, 0 };
    const int found = ted4_is_poses_bounds(folder) && ted4_clip_names(&clips, folder) == 0 &&
                      clips.n > 0;

    ted4_name_list_free(&clips);
    return found;
}

/* NN of camNN; SIZE_MAX: not such a name. */
static size_t clip_number(const char *name)
{
    const char *digits = name + strlen("cam");
    size_t v = 0;

    for (const char *c = digits; *c != 0; c++) {
        if (!isdigit((unsigned char)*c) || c - digits > 6)
            return SIZE_MAX;
        v = 10 * v + (size_t)(*c - '0');
    }
    return *digits != 0 ? v : SIZE_MAX;
}

static int add_clip(neu3d *n, size_t i)
{
    const uint32_t wanted = n->scene->wanted->max_frames;
    const char *name = n->clips.names[i];
    ted4_shot model;
    ted4_name_list pictures;

    memset(&model, 0, sizeof model);
    model.is_test = i == 0;
    if (ted4_poses_bounds_camera(&n->table, n->numbered ? clip_number(name) : i, &model, n->m) != 0)
        return -1;
    int result = ted4_clip_pictures(&pictures, n->folder, name, NULL,
                                    wanted > 0 ? wanted : MOST_FRAMES, n->scene->wanted, n->m);
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

/* Sorts out which rows belong to which clips; rows that have none are entries without a picture. */
static int match_rows(neu3d *n)
{
    const size_t rows = n->table.rows, clips = n->clips.n;
    size_t at = 0;
    char where[600], name[40];

    n->scene->n_entries = rows;
    if (clips == rows)
        return 0;
    /* Sorted names of one width have growing numbers; any other is no match. */
    n->numbered = clips < rows && clip_number(n->clips.names[clips - 1]) == rows - 1;
    for (size_t i = 1; i < clips && n->numbered; i++)
        n->numbered = clip_number(n->clips.names[i - 1]) < clip_number(n->clips.names[i]);
    if (!n->numbered)
        return ted4_say(n->m,
                        "%s: %zu rows, but %zu cameras (cam*.mp4, cam*/images/ or images/cam*/) in "
                        "the folder",
                        n->table.path, rows, clips);
    for (size_t i = 0; i < rows; i++) {
        if (clip_number(n->clips.names[at]) == i) {
            at++;
            continue;
        }
        snprintf(where, sizeof where, "%.500s: row %zu", n->table.path, i);
        snprintf(name, sizeof name, "no clip of number %zu", i);
        ted4_raw_scene_missing(n->scene, where, name);
    }
    return 0;
}

static int read_all(neu3d *n)
{
    if (ted4_clip_names(&n->clips, n->folder) != 0)
        return ted4_say_no_memory(n->m);
    if (ted4_poses_bounds_read(&n->table, n->folder, n->m) != 0 || match_rows(n) != 0)
        return -1;
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
    const int result = read_all(&n);
    ted4_name_list_free(&n.clips);
    ted4_poses_bounds_free(&n.table);
    return result;
}
