/* load_neu3d.c - loads the layout "neu3d" (Neural 3D Video, also called DyNeRF): poses_bounds.npy
 * and one clip per camera (clip.h). Row i of the table belongs to clip i in the order of names; but
 * if there are more rows than clips, and the last clip has the number of the last row, row NN
 * belongs to clip camNN. The first camera is held out. Frames with the same number have the same
 * time.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/clip.h"
#include "data/poses_bounds.h"

enum { MOST_FRAMES = 300 }; /* the frames used in published results on these scenes */

typedef struct {
    ted4_raw_scene *scene;
    const char *folder;
    ted4_poses_bounds table;
    ted4_name_list names; /* of clips */
    ted4_clips clips;
    int numbered; /* are rows matched by the numbers of the clips? */
    ted4_message *m;
} neu3d;

/* A COLMAP scene or one of stills may also hold such a table; clips tell them apart. */
int ted4_is_neu3d(const char *folder)
{
    ted4_name_list clips = { NULL, 0 };
    const int found = ted4_is_poses_bounds(folder) && ted4_clip_names(&clips, folder) == 0 &&
                      clips.n > 0;

    ted4_name_list_free(&clips);
    return found;
}

/* Returns NN of a name camNN, or SIZE_MAX for any other name. */
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

static int find_clip(neu3d *n, size_t i)
{
    ted4_clip clip;

    memset(&clip, 0, sizeof clip);
    clip.name = n->names.names[i];
    clip.model.is_test = i == 0;
    if (ted4_poses_bounds_camera(&n->table, n->numbered ? clip_number(clip.name) : i, &clip.model,
                                 n->m) != 0)
        return -1;
    const int found = ted4_clips_find(&n->clips, &clip, NULL, n->scene->wanted, n->m);
    if (found == 0)
        return ted4_say(n->m, "%s/%s: neither a video nor a folder of pictures", n->folder,
                        clip.name);
    return found < 0 ? -1 : 0;
}

/* Matches rows to clips. Rows without a clip count as entries without a picture. */
static int match_rows(neu3d *n)
{
    const size_t rows = n->table.rows, clips = n->names.n;
    size_t at = 0;
    char where[600], name[40];

    n->scene->n_entries = rows;
    if (clips == rows)
        return 0;
    /* Sorted names of equal length have increasing numbers. Anything else does not match. */
    n->numbered = clips < rows && clip_number(n->names.names[clips - 1]) == rows - 1;
    for (size_t i = 1; i < clips && n->numbered; i++)
        n->numbered = clip_number(n->names.names[i - 1]) < clip_number(n->names.names[i]);
    if (!n->numbered)
        return ted4_say(n->m,
                        "%s: %zu rows, but %zu cameras (cam*.mp4, cam*/images/ or images/cam*/) in "
                        "the folder",
                        n->table.path, rows, clips);
    for (size_t i = 0; i < rows; i++) {
        if (clip_number(n->names.names[at]) == i) {
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
    if (ted4_clip_names(&n->names, n->folder) != 0)
        return ted4_say_no_memory(n->m);
    if (ted4_poses_bounds_read(&n->table, n->folder, n->m) != 0 || match_rows(n) != 0)
        return -1;
    for (size_t i = 0; i < n->names.n; i++)
        if (find_clip(n, i) != 0)
            return -1;
    if (ted4_clips_number(&n->clips, n->m) != 0 ||
        ted4_clips_give(&n->clips, n->scene, n->m) != 0 ||
        ted4_clips_say(&n->clips, 1, n->scene, n->m) != 0)
        return -1;
    return ted4_ply_find(&n->scene->cloud, n->folder, n->m);
}

int ted4_load_neu3d(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    neu3d n;

    memset(&n, 0, sizeof n);
    s->layout = "neu3d";
    s->timed = 1;
    n.scene = s;
    n.folder = folder;
    n.m = m;
    n.clips.folder = folder;
    n.clips.most = s->wanted->max_frames > 0 ? s->wanted->max_frames : MOST_FRAMES;
    const int result = read_all(&n);
    ted4_clips_free(&n.clips);
    ted4_name_list_free(&n.names);
    ted4_poses_bounds_free(&n.table);
    return result;
}
