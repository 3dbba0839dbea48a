/* load_transforms.c - loads the layouts "blender" (transforms_train.json and transforms_test.json),
 * "D-NeRF" (the same with times) and "nerfstudio" (the same pair, or a single transforms.json, with
 * additional fields). transforms_val.json is used if there is no transforms_test.json. A single
 * file is split by its lists train_filenames and test_filenames or val_filenames, else by
 * TED4_HOLD_OUT_*. Frames without a picture are left out. Lenses are read in transforms_lens.c.
 * transform_matrix is camera-to-world with axes right, up, backward. The world stays as it is,
 * except that applied_transform, which nerfstudio has applied to both poses and point cloud, is
 * undone in both.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/transforms.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/picture_path.h"

static char *file_in(const char *folder, const char *name)
{
    char *path = ted4_path_join(folder, name);

    if (path != NULL && ted4_is_file(path))
        return path;
    free(path);
    return NULL;
}

static int has_file(const char *folder, const char *name)
{
    char *path = file_in(folder, name);
    const int found = path != NULL;

    free(path);
    return found;
}

static const char file_train[] = "transforms_train.json", file_test[] = "transforms_test.json",
                  file_val[] = "transforms_val.json", file_one[] = "transforms.json";

int ted4_is_transforms(const char *folder)
{
    return has_file(folder, file_train) || has_file(folder, file_one) ||
           has_file(folder, file_test) || has_file(folder, file_val);
}

/* Computes x = applied^-1 y for a similarity: A^-1 = A^T / s^2. */
static void undo_applied(const ted4_transforms *t, const double y[3], double x[3])
{
    const double *A = t->applied, s2 = t->applied_scale * t->applied_scale;
    const double d[3] = { y[0] - A[3], y[1] - A[7], y[2] - A[11] };

    for (int j = 0; j < 3; j++)
        x[j] = (A[j] * d[0] + A[4 + j] * d[1] + A[8 + j] * d[2]) / s2;
}

/* M is camera-to-world with columns right, up, backward and centre. World to camera is R with rows
 * right, down and forward, and t = -R c. */
static int read_pose(ted4_transforms *t, ted4_shot *shot)
{
    static const double sign[3] = { 1, -1, -1 };
    double M[12], centre[3];
    const int found = ted4_json_affine(t->frame, t->where, "transform_matrix", M, t->m);

    if (found <= 0)
        return found < 0
                   ? -1
                   : ted4_say(t->m, "%s.transform_matrix: missing, expected 4x4 numbers", t->where);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            /* v is entry j of applied^-1 times column i. */
            double v = 0;
            for (int k = 0; k < 3; k++)
                v += t->applied[4 * k + j] * M[4 * k + i];
            shot->R[3 * i + j] = sign[i] * v / t->applied_scale;
        }
    const char *wrong = ted4_rotation_clean(shot->R);
    if (wrong != NULL)
        return ted4_say(t->m, "%s.transform_matrix: its 3x3 part %s", t->where, wrong);
    undo_applied(t, (const double[]) { M[3], M[7], M[11] }, centre);
    for (int i = 0; i < 3; i++)
        shot->t[i] = -(shot->R[3 * i] * centre[0] + shot->R[3 * i + 1] * centre[1] +
                       shot->R[3 * i + 2] * centre[2]);
    return 0;
}

/* Returns 1 with *path owned by the caller, 0 if the picture is missing (which is counted), or -1
 * with *m filled. */
static int find_picture(ted4_transforms *t, char **path)
{
    const char *name = NULL;
    const int told = ted4_json_text(t->frame, t->where, "file_path", &name, t->m);

    if (told <= 0)
        return told < 0
                   ? -1
                   : ted4_say(t->m, "%s.file_path: missing, expected a picture's name", t->where);
    const int found = ted4_picture_find(t->folder, name, t->part, path);
    if (found == 0)
        ted4_raw_scene_missing(t->scene, t->where, name);
    return found < 0 ? ted4_say_no_memory(t->m) : found;
}

/* "camera" may be a name or a number. Without it, the label is NULL and cameras are distinguished
 * by pose. */
static int read_camera_label(ted4_transforms *t, ted4_shot *shot)
{
    const json_t *field = json_object_get(t->frame, "camera");
    char text[32];

    if (field == NULL || json_is_null(field))
        return 0;
    if (json_is_integer(field))
        snprintf(text, sizeof text, "%lld", (long long)json_integer_value(field));
    else if (!json_is_string(field))
        return ted4_say(t->m, "%s.camera: expected a string or an integer", t->where);
    shot->camera = ted4_text_copy(json_is_string(field) ? json_string_value(field) : text);
    return shot->camera == NULL ? ted4_say_no_memory(t->m) : 0;
}

/* Reads frame i of the list. */
static int read_frame(ted4_transforms *t, size_t i)
{
    char *path = NULL;

    if (!json_is_object(t->frame))
        return ted4_say(t->m, "%s: expected an object", t->where);
    t->scene->n_entries++;
    const int found = find_picture(t, &path);
    ted4_shot *shot = found == 1 ? ted4_raw_scene_add(t->scene, path, t->where, t->m) : NULL;
    if (shot == NULL)
        return found == 0 ? 0 : -1;
    t->shot_of[i] = t->scene->n_shots - 1;
    shot->is_test = t->is_test;
    if (ted4_transforms_lens(t, &shot->lens) != 0 || read_pose(t, shot) != 0 ||
        read_camera_label(t, shot) != 0)
        return -1;
    return 0;
}

/* Either all frames have a time or none has; both files of a pair must agree. */
static int read_times(ted4_transforms *t, int is_first)
{
    const json_t *frames = json_object_get(t->root, "frames");
    const size_t n = json_array_size(frames);
    size_t timed = 0;

    for (size_t i = 0; i < n; i++)
        timed += json_object_get(json_array_get(frames, i), "time") != NULL;
    if (!is_first && (timed > 0) != t->scene->timed)
        return ted4_say(t->m, "%s: frames %s a time, those of the other file do not agree", t->path,
                        timed > 0 ? "have" : "lack");
    t->scene->timed = timed > 0;
    for (size_t i = 0; i < n && timed > 0; i++) {
        snprintf(t->where, sizeof t->where, "%.600s: frames[%zu]", t->path, i);
        double time = 0;
        const int found = ted4_json_time(json_array_get(frames, i), t->where, "time", &time, t->m);
        if (found < 0)
            return -1;
        if (found == 0)
            return ted4_say(t->m, "%s.time: missing, while %zu of %zu frames have one", t->where,
                            timed, n);
        if (t->shot_of[i] != TED4_NO_SHOT)
            t->scene->shots[t->shot_of[i]].time = time;
    }
    return 0;
}

static int read_applied(ted4_transforms *t)
{
    static const double identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    double A[12], R[9], norm2 = 0;
    const int found = ted4_json_affine(t->root, t->path, "applied_transform", A, t->m);

    memcpy(t->applied, found > 0 ? A : identity, sizeof A);
    t->applied_scale = 1;
    if (found <= 0)
        return found;
    for (int i = 0; i < 3; i++)
        norm2 += A[i] * A[i];
    t->applied_scale = sqrt(norm2);
    for (int i = 0; i < 9; i++)
        R[i] = norm2 > 0 ? A[i / 3 * 4 + i % 3] / t->applied_scale : 0;
    const char *wrong = ted4_rotation_clean(R);
    if (wrong != NULL)
        return ted4_say(t->m, "%s.applied_transform: its 3x3 part, scale removed, %s", t->path,
                        wrong);
    for (int i = 0; i < 9; i++)
        t->applied[i / 3 * 4 + i % 3] = t->applied_scale * R[i];
    return 0;
}

/* Reads the point cloud that the file names, else one of the usual names, and undoes
 * applied_transform as for poses. */
static int read_cloud(ted4_transforms *t)
{
    ted4_point_cloud *c = &t->scene->cloud;
    const char *name = NULL;

    if (c->n > 0)
        return 0;
    const int found = ted4_json_text(t->root, t->path, "ply_file_path", &name, t->m);
    char *path = found > 0 ? ted4_path_join(t->folder, name) : NULL;
    if (found < 0)
        return -1;
    if (found > 0 && path == NULL)
        return ted4_say_no_memory(t->m);
    const int result = found > 0 ? ted4_ply_read(c, path, t->m) : ted4_ply_find(c, t->folder, t->m);
    free(path);
    for (size_t i = 0; i < c->n; i++) {
        double x[3];
        undo_applied(t, (const double[]) { c->xyz[3 * i], c->xyz[3 * i + 1], c->xyz[3 * i + 2] },
                     x);
        for (size_t k = 0; k < 3; k++)
            c->xyz[3 * i + k] = (float)x[k];
    }
    return result;
}

/* Warns of nerfstudio's masks, which frames have, or the top of the file for all of them. */
static int say_masks(ted4_transforms *t)
{
    static const char field[] = "mask_path";
    const json_t *frames = json_object_get(t->root, "frames");
    int found = json_is_string(json_object_get(t->root, field));

    for (size_t i = 0; i < json_array_size(frames) && !found; i++)
        found = json_is_string(json_object_get(json_array_get(frames, i), field));
    return found && ted4_raw_scene_warn(t->scene, "%s: masks are not used (%s)", t->path, field)
               ? ted4_say_no_memory(t->m)
               : 0;
}

static int read_frames(ted4_transforms *t)
{
    const json_t *frames = json_object_get(t->root, "frames");
    const size_t n = json_array_size(frames);
    const int is_first = t->scene->n_entries == 0;

    if (!json_is_array(frames) || n == 0)
        return ted4_say(t->m, "%s: frames: expected a list with at least one frame", t->path);
    t->shot_of = malloc(n * sizeof *t->shot_of);
    if (t->shot_of == NULL)
        return ted4_say_no_memory(t->m);
    for (size_t i = 0; i < n; i++) {
        t->shot_of[i] = TED4_NO_SHOT;
        t->frame = json_array_get(frames, i);
        snprintf(t->where, sizeof t->where, "%.600s: frames[%zu]", t->path, i);
        if (read_frame(t, i) != 0)
            return -1;
    }
    const double rate = t->scene->rate;
    if (ted4_json_rate(t->root, t->path, &t->scene->rate, t->m) < 0)
        return -1;
    if (rate > 0 && rate != t->scene->rate)
        return ted4_say(t->m, "%s.fps: %g, expected %g", t->path, t->scene->rate, rate);
    return read_times(t, is_first);
}

/* nerfstudio's lists of file_paths, for training and held out. The first of lists_test that names a
 * picture is used, or the first that exists. */
static const char list_train[] = "train_filenames";
static const char *const lists_test[] = { "test_filenames", "val_filenames" };

static const char *plain_name(const char *name)
{
    while (name[0] == '.' && name[1] == '/')
        name += 2;
    return name;
}

/* Returns the index of the frame of that file_path, or n if there is none. The search begins at
 * start, because lists are mostly in the order of the frames. */
static size_t find_frame(const json_t *frames, size_t start, const char *name)
{
    const size_t n = json_array_size(frames);

    for (size_t k = 0; k < n; k++) {
        const size_t i = (start + k) % n;
        const char *path =
            json_string_value(json_object_get(json_array_get(frames, i), "file_path"));
        if (strcmp(plain_name(path), plain_name(name)) == 0)
            return i;
    }
    return n;
}

enum { UNNAMED, TRAIN, TEST };

/* Sets use[i] = what for the frames that a list names. */
static int read_list(ted4_transforms *t, const char *name, int what, uint8_t *use)
{
    const json_t *list = json_object_get(t->root, name),
                 *frames = json_object_get(t->root, "frames");
    size_t at = 0;

    if (!json_is_array(list))
        return ted4_say(t->m, "%s.%s: %s, expected a list of file_paths", t->path, name,
                        list == NULL ? "missing" : "not a list");
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *text = json_string_value(json_array_get(list, i));
        if (text == NULL)
            return ted4_say(t->m, "%s.%s[%zu]: expected a file_path", t->path, name, i);
        at = find_frame(frames, at, text);
        if (at == json_array_size(frames))
            return ted4_say(t->m, "%s.%s[%zu]: no frame has the file_path %.300s", t->path, name, i,
                            text);
        if (use[at] != UNNAMED)
            return ted4_say(t->m, "%s.%s[%zu]: %.300s is listed twice", t->path, name, i, text);
        use[at] = (uint8_t)what;
    }
    return 0;
}

/* Splits the frames by the lists. Frames that neither list names are left out. */
static int split_by_lists(ted4_transforms *t, const char *test)
{
    ted4_raw_scene *s = t->scene;
    const size_t n = json_array_size(json_object_get(t->root, "frames"));
    uint8_t *use = calloc(n, 1);
    size_t kept = 0;

    if (use == NULL)
        return ted4_say_no_memory(t->m);
    int result = read_list(t, list_train, TRAIN, use);
    if (result == 0 && test != NULL)
        result = read_list(t, test, TEST, use);
    for (size_t i = 0; i < n && result == 0; i++) {
        if (t->shot_of[i] == TED4_NO_SHOT)
            continue;
        ted4_shot *shot = &s->shots[t->shot_of[i]];
        shot->is_test = use[i] == TEST;
        if (use[i] == UNNAMED) {
            free(shot->path);
            free(shot->camera);
        } else {
            s->shots[kept++] = *shot;
        }
    }
    if (result == 0)
        s->n_shots = kept;
    free(use);
    return result;
}

static int by_path(const void *a, const void *b)
{
    const ted4_shot *x = a, *y = b;
    int order = strcmp(x->path, y->path);

    /* A file may be listed twice; such entries need a fixed order too. */
    if (order == 0)
        order = (x->time > y->time) - (x->time < y->time);
    for (int k = 0; order == 0 && k < 3; k++)
        order = (x->t[k] > y->t[k]) - (x->t[k] < y->t[k]);
    for (int k = 0; order == 0 && k < 9; k++)
        order = (x->R[k] > y->R[k]) - (x->R[k] < y->R[k]);
    return order;
}

/* Splits a file that holds all frames. */
static int split(ted4_transforms *t)
{
    const char *test = NULL;

    if (t->scene->wanted->n_hold_out > 0)
        return 0;
    for (size_t i = sizeof lists_test / sizeof lists_test[0]; i-- > 0;) {
        const json_t *list = json_object_get(t->root, lists_test[i]);
        const int is_empty = json_is_array(list) && json_array_size(list) == 0;

        if (list != NULL && (test == NULL || !is_empty))
            test = lists_test[i];
    }
    if (test != NULL || json_object_get(t->root, list_train) != NULL)
        return split_by_lists(t, test);
    if (t->scene->n_shots > 0)
        qsort(t->scene->shots, t->scene->n_shots, sizeof *t->scene->shots, by_path);
    ted4_raw_scene_hold_out(t->scene);
    return 0;
}

static int has_focal(const json_t *root)
{
    return ted4_transforms_has_focal(root) ||
           ted4_transforms_has_focal(json_array_get(json_object_get(root, "frames"), 0));
}

/* Blender scenes consist of a pair of files, and D-NeRF scenes of such a pair with times.
 * nerfstudio also writes pairs, but with additional fields; a single file with focal lengths in
 * pixels is nerfstudio's, too. */
static const char *name_layout(const ted4_transforms *t)
{
    static const char *const foreign[] = { "camera_model",         "applied_transform",
                                           "applied_scale",        "ply_file_path",
                                           "orientation_override", "train_filenames",
                                           "val_filenames",        "test_filenames" };
    int nerfstudio = t->part == NULL && has_focal(t->root);

    for (size_t i = 0; i < sizeof foreign / sizeof foreign[0]; i++)
        nerfstudio |= json_object_get(t->root, foreign[i]) != NULL;
    return nerfstudio ? "nerfstudio" : t->scene->timed ? "D-NeRF" : "blender";
}

/* What a file holds: only training frames, only held-out frames, or both. */
enum { ALL_TRAIN, ALL_TEST, BOTH };

static int read_root(ted4_transforms *t, int holds)
{
    t->root = ted4_json_read(t->path, t->m);
    if (t->root == NULL)
        return -1;
    if (!json_is_object(t->root))
        return ted4_say(t->m, "%s: expected an object with a list \"frames\"", t->path);
    if (read_applied(t) != 0 || read_frames(t) != 0 || (holds == BOTH && split(t) != 0) ||
        say_masks(t) != 0 || read_cloud(t) != 0)
        return -1;
    t->scene->layout = name_layout(t);
    t->scene->unit_cube = !has_focal(t->root);
    return 0;
}

static int read_file(ted4_raw_scene *s, const char *folder, const char *name, int holds,
                     ted4_message *m)
{
    ted4_transforms t;

    memset(&t, 0, sizeof t);
    t.scene = s;
    t.folder = folder;
    t.part = name == file_train  ? "train"
             : name == file_test ? "test"
             : name == file_val  ? "val"
                                 : NULL;
    t.is_test = holds == ALL_TEST;
    t.m = m;
    t.path = ted4_path_join(folder, name);
    const int result = t.path == NULL ? ted4_say_no_memory(m) : read_root(&t, holds);
    json_decref(t.root);
    free(t.shot_of);
    free(t.path);
    return result;
}

int ted4_load_transforms(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    const char *test = has_file(folder, file_test)  ? file_test
                       : has_file(folder, file_val) ? file_val
                                                    : NULL;

    s->layout = "blender";
    if (!has_file(folder, file_train))
        return read_file(s, folder, has_file(folder, file_one) ? file_one : test, BOTH, m);
    if (test == NULL)
        return read_file(s, folder, file_train, BOTH, m);
    return read_file(s, folder, file_train, ALL_TRAIN, m) == 0 &&
                   read_file(s, folder, test, ALL_TEST, m) == 0
               ? 0
               : -1;
}
