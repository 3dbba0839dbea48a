/* load_transforms.c - layouts "blender" (D-NeRF: transforms_train.json and transforms_test.json
 * with camera_angle_x) and "nerfstudio" (the same pair, or one transforms.json, with fl_x and
 * more; its lists train_filenames and test_filenames, or val_filenames, split it, else TED4_HOLD_OUT_*).
 * transform_matrix is camera-to-world with axes right, up, backward; the world stays as it is,
 * except that applied_transform, which nerfstudio has put before poses and point cloud alike, is
 * taken off both again.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"
#include "data/json_field.h"
#include "math/elementary.h"

/* One transforms file while it is read. */
typedef struct {
    ted4_raw_scene *scene;
    const char     *folder;
    char           *path;           /* owned */
    json_t         *root;           /* owned */
    const json_t   *frame;          /* the one being read; borrowed */
    char            where[700];     /* "path: frames[i]" */
    int             is_test;
    double          applied[12];    /* world of the file = applied * world of the dataset; 3x4, a similarity */
    double          applied_scale;
    ted4_message   *m;
} transforms;

static char *file_in(const char *folder, const char *name)
{
    char *path = ted4_path_join(folder, name);

    if (path != NULL && ted4_is_file(path))
        return path;
    free(path);
    return NULL;
}

int ted4_is_transforms(const char *folder)
{
    char *pair = file_in(folder, "transforms_train.json"), *one = file_in(folder, "transforms.json");
    const int found = pair != NULL || one != NULL;

    free(pair);
    free(one);
    return found;
}

/* A number of the frame, else of the file. As ted4_json_number. */
static int number(transforms *t, const char *name, double *v)
{
    const int found = ted4_json_number(t->frame, t->where, name, v, t->m);

    return found != 0 ? found : ted4_json_number(t->root, t->path, name, v, t->m);
}

static int check_model(transforms *t)
{
    static const char *const known[] = { "OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "PERSPECTIVE" };
    static const char *const foreign[] = { "k3", "k4", "k5", "k6" };
    const char *model = known[0];
    double v = 0;

    const int found = ted4_json_text(t->frame, t->where, "camera_model", &model, t->m);
    if (found < 0 || (found == 0 && ted4_json_text(t->root, t->path, "camera_model", &model, t->m) < 0))
        return -1;
    size_t i = 0;
    while (i < sizeof known / sizeof known[0] && strcmp(model, known[i]) != 0)
        i++;
    if (i == sizeof known / sizeof known[0])
        return ted4_say(t->m, "%s.camera_model: %s, expected OPENCV or PINHOLE", t->where, model);
    if (json_is_true(json_object_get(t->root, "is_fisheye")))
        return ted4_say(t->m, "%s.is_fisheye: true, expected a perspective camera", t->path);
    for (i = 0; i < sizeof foreign / sizeof foreign[0]; i++)
        if (number(t, foreign[i], &v) < 0)
            return -1;
        else if (v != 0)
            return ted4_say(t->m, "%s.%s: %g, only k1 k2 p1 p2 are supported", t->where, foreign[i], v);
    return 0;
}

/* Size that the intrinsics refer to: w, h, or the file's own. */
static int read_size(transforms *t, ted4_lens *l)
{
    double w = l->width, h = l->height;

    if (number(t, "w", &w) < 0 || number(t, "h", &h) < 0)
        return -1;
    if (!(w >= 1 && h >= 1 && w <= 1e6 && h <= 1e6) || w != floor(w) || h != floor(h))
        return ted4_say(t->m, "%s: w, h are %g, %g, expected whole numbers of pixels", t->where, w, h);
    l->width = (int)w;
    l->height = (int)h;
    l->cx = 0.5 * w;
    l->cy = 0.5 * h;
    return 0;
}

static int read_lens(transforms *t, ted4_lens *l)
{
    double angle = 0;

    if (check_model(t) != 0 || read_size(t, l) != 0)
        return -1;
    const int focal = number(t, "fl_x", &l->fx);
    const int field = focal == 0 ? number(t, "camera_angle_x", &angle) : 0;
    if (focal < 0 || field < 0)
        return -1;
    if (focal == 0 && field == 0)
        return ted4_say(t->m, "%s: no fl_x and no camera_angle_x here or at the top of the file", t->where);
    if (field > 0) {
        if (!(angle > 0 && angle < TED4_PI))
            return ted4_say(t->m, "%s: camera_angle_x is %g, expected an angle between 0 and pi", t->where, angle);
        l->fx = 0.5 * l->width / ted4_math_tan(0.5 * angle);
    }
    l->fy = l->fx;
    if (number(t, "fl_y", &l->fy) < 0 || number(t, "cx", &l->cx) < 0 || number(t, "cy", &l->cy) < 0 ||
        number(t, "k1", &l->k1) < 0 || number(t, "k2", &l->k2) < 0 ||
        number(t, "p1", &l->p1) < 0 || number(t, "p2", &l->p2) < 0)
        return -1;
    return 0;
}

/* x = applied^-1 y for a similarity: A^-1 = A^T / s^2. */
static void undo_applied(const transforms *t, const double y[3], double x[3])
{
    const double *A = t->applied, s2 = t->applied_scale * t->applied_scale;
    const double d[3] = { y[0] - A[3], y[1] - A[7], y[2] - A[11] };

    for (int j = 0; j < 3; j++)
        x[j] = (A[j] * d[0] + A[4 + j] * d[1] + A[8 + j] * d[2]) / s2;
}

/* M = camera-to-world, columns right, up, backward, centre. World to camera: R = rows right,
 * down, forward; t = -R c. */
static int read_pose(transforms *t, ted4_shot *shot)
{
    static const double sign[3] = { 1, -1, -1 };
    double M[12], centre[3];
    const int found = ted4_json_affine(t->frame, t->where, "transform_matrix", M, t->m);

    if (found <= 0)
        return found < 0 ? -1 : ted4_say(t->m, "%s.transform_matrix: missing, expected 4x4 numbers", t->where);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            /* Entry j of applied^-1 times column i. */
            double v = 0;
            for (int k = 0; k < 3; k++)
                v += t->applied[4 * k + j] * M[4 * k + i];
            shot->R[3 * i + j] = sign[i] * v / t->applied_scale;
        }
    const char *wrong = ted4_rotation_clean(shot->R);
    if (wrong != NULL)
        return ted4_say(t->m, "%s.transform_matrix: its 3x3 part %s", t->where, wrong);
    undo_applied(t, (const double[]){ M[3], M[7], M[11] }, centre);
    for (int i = 0; i < 3; i++)
        shot->t[i] = -(shot->R[3 * i] * centre[0] + shot->R[3 * i + 1] * centre[1] + shot->R[3 * i + 2] * centre[2]);
    return 0;
}

/* The file as named, or with the extension that D-NeRF leaves out. Owned by the caller; NULL
 * with *m filled. */
static char *find_picture(transforms *t)
{
    static const char *const extensions[] = { "", ".png", ".jpg", ".jpeg", ".PNG", ".JPG" };
    const char *name = NULL;
    const int found = ted4_json_text(t->frame, t->where, "file_path", &name, t->m);

    if (found <= 0) {
        if (found == 0)
            ted4_say(t->m, "%s.file_path: missing, expected a picture's name", t->where);
        return NULL;
    }
    char *base = ted4_path_join(t->folder, name);
    const size_t room = base == NULL ? 0 : strlen(base) + 8;
    char *path = base == NULL ? NULL : malloc(room);
    for (size_t i = 0; path != NULL && i < sizeof extensions / sizeof extensions[0]; i++) {
        snprintf(path, room, "%s%s", base, extensions[i]);
        if (ted4_is_file(path)) {
            free(base);
            return path;
        }
    }
    if (path == NULL)
        ted4_say_no_memory(t->m);
    else
        ted4_say(t->m, "%s.file_path: no picture %s (nor with .png, .jpg added)", t->where, base);
    free(base);
    free(path);
    return NULL;
}

/* "camera" may be a name or a number; absent: NULL, told apart by pose. */
static int read_camera_label(transforms *t, ted4_shot *shot)
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

static int read_frame(transforms *t)
{
    if (!json_is_object(t->frame))
        return ted4_say(t->m, "%s: expected an object", t->where);
    char *path = find_picture(t);
    ted4_shot *shot = path == NULL ? NULL : ted4_raw_scene_add(t->scene, path, t->where, t->m);
    if (shot == NULL)
        return -1;
    shot->is_test = t->is_test;
    if (read_lens(t, &shot->lens) != 0 || read_pose(t, shot) != 0 || read_camera_label(t, shot) != 0)
        return -1;
    return 0;
}

/* All frames with a time, or none; in both files of a pair. */
static int read_times(transforms *t, size_t first)
{
    const json_t *frames = json_object_get(t->root, "frames");
    const size_t n = json_array_size(frames);
    size_t timed = 0;

    for (size_t i = 0; i < n; i++)
        timed += json_object_get(json_array_get(frames, i), "time") != NULL;
    if (first > 0 && (timed > 0) != t->scene->timed)
        return ted4_say(t->m, "%s: frames %s a time, those of the other file do not agree", t->path,
                        timed > 0 ? "have" : "lack");
    t->scene->timed = timed > 0;
    for (size_t i = 0; i < n && timed > 0; i++) {
        snprintf(t->where, sizeof t->where, "%.600s: frames[%zu]", t->path, i);
        const int found = ted4_json_number(json_array_get(frames, i), t->where, "time",
                                           &t->scene->shots[first + i].time, t->m);
        if (found < 0)
            return -1;
        if (found == 0)
            return ted4_say(t->m, "%s.time: missing, while %zu of %zu frames have one", t->where, timed, n);
    }
    return 0;
}

static int read_applied(transforms *t)
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
        return ted4_say(t->m, "%s.applied_transform: its 3x3 part, scale removed, %s", t->path, wrong);
    for (int i = 0; i < 9; i++)
        t->applied[i / 3 * 4 + i % 3] = t->applied_scale * R[i];
    return 0;
}

/* The cloud that the file names, else one of the usual names; moved back as the poses are. */
static int read_cloud(transforms *t)
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
        undo_applied(t, (const double[]){ c->xyz[3 * i], c->xyz[3 * i + 1], c->xyz[3 * i + 2] }, x);
        for (size_t k = 0; k < 3; k++)
            c->xyz[3 * i + k] = (float)x[k];
    }
    return result;
}

static int read_frames(transforms *t)
{
    const json_t *frames = json_object_get(t->root, "frames");
    const size_t first = t->scene->n_shots;

    if (!json_is_array(frames) || json_array_size(frames) == 0)
        return ted4_say(t->m, "%s: frames: expected a list with at least one frame", t->path);
    for (size_t i = 0; i < json_array_size(frames); i++) {
        t->frame = json_array_get(frames, i);
        snprintf(t->where, sizeof t->where, "%.600s: frames[%zu]", t->path, i);
        if (read_frame(t) != 0)
            return -1;
    }
    const double rate = t->scene->rate;
    if (ted4_json_rate(t->root, t->path, &t->scene->rate, t->m) < 0)
        return -1;
    if (rate > 0 && rate != t->scene->rate)
        return ted4_say(t->m, "%s.fps: %g, expected %g", t->path, t->scene->rate, rate);
    return read_times(t, first);
}

/* nerfstudio's lists of file_paths for training, and to hold out: the first of these that is there. */
static const char list_train[] = "train_filenames";
static const char *const lists_test[] = { "test_filenames", "val_filenames" };

static const char *plain_name(const char *name)
{
    while (name[0] == '.' && name[1] == '/')
        name += 2;
    return name;
}

/* Index of the frame of that file_path, n when there is none; looks from start on, for lists are mostly in the order of
 * the frames. */
static size_t find_frame(const json_t *frames, size_t start, const char *name)
{
    const size_t n = json_array_size(frames);

    for (size_t k = 0; k < n; k++) {
        const size_t i = (start + k) % n;
        const char *path = json_string_value(json_object_get(json_array_get(frames, i), "file_path"));
        if (strcmp(plain_name(path), plain_name(name)) == 0)
            return i;
    }
    return n;
}

enum { UNNAMED, TRAIN, TEST };

/* use[i] = what for the frames that a list names. */
static int read_list(transforms *t, const char *name, int what, uint8_t *use)
{
    const json_t *list = json_object_get(t->root, name), *frames = json_object_get(t->root, "frames");
    size_t at = 0;

    if (!json_is_array(list))
        return ted4_say(t->m, "%s.%s: %s, expected a list of file_paths", t->path, name, list == NULL ? "missing" : "not a list");
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *text = json_string_value(json_array_get(list, i));
        if (text == NULL)
            return ted4_say(t->m, "%s.%s[%zu]: expected a file_path", t->path, name, i);
        at = find_frame(frames, at, text);
        if (at == json_array_size(frames))
            return ted4_say(t->m, "%s.%s[%zu]: no frame has the file_path %.300s", t->path, name, i, text);
        if (use[at] != UNNAMED)
            return ted4_say(t->m, "%s.%s[%zu]: %.300s is listed twice", t->path, name, i, text);
        use[at] = (uint8_t)what;
    }
    return 0;
}

/* Frames that neither list names are left out. */
static int split_by_lists(transforms *t, const char *test)
{
    ted4_raw_scene *s = t->scene;
    uint8_t *use = calloc(s->n_shots, 1);
    size_t kept = 0;

    if (use == NULL)
        return ted4_say_no_memory(t->m);
    int result = read_list(t, list_train, TRAIN, use);
    if (result == 0 && test != NULL)
        result = read_list(t, test, TEST, use);
    for (size_t i = 0; i < s->n_shots && result == 0; i++) {
        s->shots[i].is_test = use[i] == TEST;
        if (use[i] == UNNAMED) {
            free(s->shots[i].path);
            free(s->shots[i].camera);
        } else {
            s->shots[kept++] = s->shots[i];
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
    int              order = strcmp(x->path, y->path);

    /* A file may be listed twice. */
    if (order == 0)
        order = (x->time > y->time) - (x->time < y->time);
    for (int k = 0; order == 0 && k < 3; k++)
        order = (x->t[k] > y->t[k]) - (x->t[k] < y->t[k]);
    for (int k = 0; order == 0 && k < 9; k++)
        order = (x->R[k] > y->R[k]) - (x->R[k] < y->R[k]);
    return order;
}

/* The split of a file that holds all frames. */
static int split(transforms *t)
{
    const char *test = NULL;

    for (size_t i = 0; i < sizeof lists_test / sizeof lists_test[0] && test == NULL; i++)
        if (json_object_get(t->root, lists_test[i]) != NULL)
            test = lists_test[i];
    if (test != NULL || json_object_get(t->root, list_train) != NULL)
        return split_by_lists(t, test);
    qsort(t->scene->shots, t->scene->n_shots, sizeof *t->scene->shots, by_path);
    ted4_raw_scene_hold_out(t->scene);
    return 0;
}

static int has_focal(const json_t *root)
{
    const json_t *frame = json_array_get(json_object_get(root, "frames"), 0);

    return json_object_get(root, "fl_x") != NULL || json_object_get(frame, "fl_x") != NULL;
}

/* Reads one file, of which all frames are for training or all are held out, or which has both. */
enum { ALL_TRAIN, ALL_TEST, BOTH };

static int read_file(ted4_raw_scene *s, const char *folder, const char *name, int holds, ted4_message *m)
{
    transforms t;

    memset(&t, 0, sizeof t);
    t.scene = s;
    t.folder = folder;
    t.is_test = holds == ALL_TEST;
    t.m = m;
    t.path = ted4_path_join(folder, name);
    if (t.path == NULL)
        return ted4_say_no_memory(m);
    t.root = ted4_json_read(t.path, m);
    int result = t.root == NULL ? -1 : 0;
    if (result == 0 && !json_is_object(t.root))
        result = ted4_say(m, "%s: expected an object with a list \"frames\"", t.path);
    if (result == 0)
        result = read_applied(&t);
    if (result == 0)
        result = read_frames(&t);
    if (result == 0 && holds == BOTH)
        result = split(&t);
    if (result == 0)
        result = read_cloud(&t);
    if (result == 0) {
        const int blender = !has_focal(t.root);
        s->layout = blender ? "blender" : "nerfstudio";
        s->unit_cube = blender;
    }
    json_decref(t.root);
    free(t.path);
    return result;
}

int ted4_load_transforms(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    char *train = file_in(folder, "transforms_train.json");
    const int pair = train != NULL;

    free(train);
    if (pair)
        return read_file(s, folder, "transforms_train.json", ALL_TRAIN, m) == 0 &&
               read_file(s, folder, "transforms_test.json", ALL_TEST, m) == 0 ? 0 : -1;
    return read_file(s, folder, "transforms.json", BOTH, m);
}
