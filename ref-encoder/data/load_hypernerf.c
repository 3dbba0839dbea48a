/* load_hypernerf.c - loads the layout "hypernerf" (Nerfies): dataset.json names the pictures and
 * the split, metadata.json gives the times, camera/ID.json holds one camera per picture, and
 * rgb/Nx/ID.png are the pictures reduced by N. Everything but rgb is in units of the full-size
 * picture. scene.json (centre, scale, near, far) describes the normalised space of other programs
 * and is not read.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"
#include "data/json_field.h"
#include "data/npy_file.h"
#include "data/picture_path.h"

/* If dataset.json lists no val_ids, every 4th of its ids is for training, the second id after each
 * of these is held out, and the others are left out. */
enum { SPLIT_EVERY = 4, SPLIT_TEST = 2 };

typedef struct {
    ted4_raw_scene *scene;
    const char *folder;
    json_t *dataset, *metadata;                    /* owned */
    char *dataset_path, *metadata_path, *pictures; /* owned; pictures: rgb/Nx */
    ted4_message *m;
} hypernerf;

int ted4_is_hypernerf(const char *folder)
{
    char *list = ted4_path_join(folder, "dataset.json"),
         *cameras = ted4_path_join(folder, "camera");
    const int found = list != NULL && cameras != NULL && ted4_is_file(list) &&
                      ted4_is_folder(cameras);

    free(list);
    free(cameras);
    return found;
}

/* Finds rgb/Nx for the requested reduction N, else for the smallest N that exists. */
static int find_pictures(hypernerf *h)
{
    const int sizes[] = { h->scene->wanted->downscale, 1, 2, 4, 8, 16 };
    char name[32];

    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        snprintf(name, sizeof name, "rgb/%dx", sizes[i]);
        h->pictures = ted4_path_join(h->folder, name);
        if (h->pictures == NULL)
            return ted4_say_no_memory(h->m);
        h->scene->reduced = sizes[i];
        if (sizes[i] > 0 && ted4_is_folder(h->pictures))
            return 0;
        free(h->pictures);
        h->pictures = NULL;
    }
    return ted4_say(h->m, "%s/rgb: none of the folders 1x, 2x, 4x, 8x, 16x here", h->folder);
}

/* Reads a required list of n numbers. */
static int need(const json_t *o, const char *path, const char *name, double *v, size_t n,
                ted4_message *m)
{
    const int found = ted4_json_numbers(o, path, name, v, n, n, m);

    return found > 0   ? 0
           : found < 0 ? -1
                       : ted4_say(m, "%s.%s: missing, expected %zu numbers", path, name, n);
}

static int read_lens(const json_t *o, const char *path, ted4_lens *l, ted4_message *m)
{
    double size[2], centre[2], radial[3] = { 0, 0, 0 }, tangential[2] = { 0, 0 }, aspect = 1;

    const int focal = ted4_json_number(o, path, "focal_length", &l->fx, m);
    if (focal <= 0)
        return focal < 0 ? -1 : ted4_say(m, "%s.focal_length: missing", path);
    if (need(o, path, "image_size", size, 2, m) != 0 ||
        need(o, path, "principal_point", centre, 2, m) != 0 ||
        ted4_json_number(o, path, "skew", &l->skew, m) < 0 ||
        ted4_json_number(o, path, "pixel_aspect_ratio", &aspect, m) < 0 ||
        ted4_json_numbers(o, path, "radial_distortion", radial, 3, 3, m) < 0 ||
        ted4_json_numbers(o, path, "tangential", tangential, 2, 2, m) < 0 ||
        ted4_json_numbers(o, path, "tangential_distortion", tangential, 2, 2, m) < 0)
        return -1;
    if (!(size[0] >= 1 && size[1] >= 1 && size[0] <= 1e6 && size[1] <= 1e6) ||
        size[0] != floor(size[0]) || size[1] != floor(size[1]))
        return ted4_say(m, "%s.image_size: %g, %g, expected whole numbers of pixels", path, size[0],
                        size[1]);
    l->width = (int)size[0];
    l->height = (int)size[1];
    l->fy = l->fx * aspect;
    l->cx = centre[0];
    l->cy = centre[1];
    l->k1 = radial[0];
    l->k2 = radial[1];
    l->k3 = radial[2];
    l->p1 = tangential[0];
    l->p2 = tangential[1];
    return 0;
}

/* orientation is world to camera, with rows right, down, forward; position is the camera's
 * centre. */
static int read_pose(const json_t *o, const char *path, ted4_shot *shot, ted4_message *m)
{
    double c[3];

    if (need(o, path, "orientation", shot->R, 9, m) != 0 || need(o, path, "position", c, 3, m) != 0)
        return -1;
    const char *wrong = ted4_rotation_clean(shot->R);
    if (wrong != NULL)
        return ted4_say(m, "%s.orientation: it %s", path, wrong);
    for (int i = 0; i < 3; i++)
        shot->t[i] =
            -(shot->R[3 * i] * c[0] + shot->R[3 * i + 1] * c[1] + shot->R[3 * i + 2] * c[2]);
    return 0;
}

static int read_camera(hypernerf *h, const char *id, ted4_shot *shot)
{
    char name[300];

    snprintf(name, sizeof name, "camera/%.250s.json", id);
    char *path = ted4_path_join(h->folder, name);
    if (path == NULL)
        return ted4_say_no_memory(h->m);
    json_t *o = ted4_json_read(path, h->m);
    const int result = o == NULL || read_lens(o, path, &shot->lens, h->m) != 0 ||
                               read_pose(o, path, shot, h->m) != 0
                           ? -1
                           : 0;
    json_decref(o);
    free(path);
    return result;
}

/* Reads the time, which is warp_id or one of its other names, and the physical camera, which is
 * camera_id if given. */
static int read_metadata(hypernerf *h, const char *id, ted4_shot *shot)
{
    static const char *const names[] = { "warp_id", "time_id", "time" };
    const json_t *entry = json_object_get(h->metadata, id);
    char where[700], label[64];
    double camera;
    int found = 0;

    snprintf(where, sizeof where, "%.600s: \"%.80s\"", h->metadata_path, id);
    if (!json_is_object(entry))
        return ted4_say(h->m, "%s: no such entry, expected an object with warp_id", where);
    for (size_t i = 0; i < sizeof names / sizeof names[0] && found == 0; i++)
        found = ted4_json_time(entry, where, names[i], &shot->time, h->m);
    if (found == 0)
        return ted4_say(h->m, "%s.warp_id: missing", where);
    const int labelled = found < 0 ? -1
                                   : ted4_json_number(entry, where, "camera_id", &camera, h->m);
    if (labelled <= 0)
        return labelled;
    snprintf(label, sizeof label, "%.15g", camera);
    shot->camera = ted4_text_copy(label);
    return shot->camera == NULL ? ted4_say_no_memory(h->m) : 0;
}

static int add_picture(hypernerf *h, const char *id, int is_test)
{
    char name[300], where[700];

    snprintf(name, sizeof name, "%.250s.png", id);
    snprintf(where, sizeof where, "%.600s: \"%.80s\"", h->dataset_path, id);
    ted4_shot *shot;
    char *path = NULL;
    const int found = ted4_picture_find(h->pictures, name, NULL, &path);
    if (found < 0)
        return ted4_say_no_memory(h->m);
    const int there = ted4_raw_scene_list(
        h->scene, found == 0 ? ted4_path_join(h->pictures, name) : path, where, &shot, h->m);
    if (there <= 0)
        return there;
    shot->is_test = is_test;
    return read_camera(h, id, shot) != 0 || read_metadata(h, id, shot) != 0 ? -1 : 0;
}

/* Reads the list of that name, whose items must be strings. *list is NULL if there is none. */
static int read_list(hypernerf *h, const char *name, const json_t **list)
{
    *list = json_object_get(h->dataset, name);
    if (*list != NULL && !json_is_array(*list))
        return ted4_say(h->m, "%s.%s: expected a list of names", h->dataset_path, name);
    for (size_t i = 0; i < json_array_size(*list); i++)
        if (!json_is_string(json_array_get(*list, i)))
            return ted4_say(h->m, "%s.%s[%zu]: expected a name", h->dataset_path, name, i);
    return 0;
}

/* Adds the pictures of a list. seen: names listed before, an object used as a set. */
static int add_list(hypernerf *h, const json_t *list, int is_test, json_t *seen)
{
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *id = json_string_value(json_array_get(list, i));
        if (json_object_get(seen, id) != NULL)
            return ted4_say(h->m, "%s: \"%.80s\" is listed twice in train_ids and val_ids",
                            h->dataset_path, id);
        if (json_object_set_new(seen, id, json_true()) != 0)
            return ted4_say_no_memory(h->m);
        if (add_picture(h, id, is_test) != 0)
            return -1;
    }
    return 0;
}

static int add_by_position(hypernerf *h, const json_t *ids)
{
    for (size_t i = 0; i < json_array_size(ids); i++) {
        const size_t place = i % SPLIT_EVERY;
        if ((place == 0 || place == SPLIT_TEST || h->scene->wanted->n_hold_out > 0) &&
            add_picture(h, json_string_value(json_array_get(ids, i)), place == SPLIT_TEST) != 0)
            return -1;
    }
    return 0;
}

static int add_pictures(hypernerf *h)
{
    const json_t *ids, *train, *test;

    if (read_list(h, "ids", &ids) != 0 || read_list(h, "train_ids", &train) != 0 ||
        read_list(h, "val_ids", &test) != 0)
        return -1;
    if (json_array_size(test) == 0)
        return add_by_position(h, ids);
    json_t *seen = json_object();
    const int result = seen == NULL ? ted4_say_no_memory(h->m)
                       : add_list(h, train, 0, seen) != 0 || add_list(h, test, 1, seen) != 0 ? -1
                                                                                             : 0;
    json_decref(seen);
    return result;
}

/* Reads the point cloud. A PLY is preferred, because it has colours and moving parts, which
 * points.npy lacks. */
static int read_cloud(hypernerf *h)
{
    ted4_point_cloud *c = &h->scene->cloud;
    double *xyz = NULL;
    size_t rows = 0;

    if (ted4_ply_find(c, h->folder, h->m) != 0)
        return -1;
    char *path = ted4_path_join(h->folder, "points.npy");
    if (path == NULL)
        return ted4_say_no_memory(h->m);
    int result = c->n == 0 && ted4_is_file(path) ? ted4_npy_read(path, 3, &xyz, &rows, h->m) : 0;
    if (result == 0 && rows > 0 && ted4_point_cloud_alloc(c, rows) != 0)
        result = ted4_say_no_memory(h->m);
    for (size_t i = 0; i < 3 * rows && result == 0; i++) {
        c->xyz[i] = (float)xyz[i];
        c->rgb[i] = TED4_POINT_GREY;
    }
    free(xyz);
    free(path);
    return result;
}

static int read_all(hypernerf *h)
{
    if (h->dataset_path == NULL || h->metadata_path == NULL)
        return ted4_say_no_memory(h->m);
    h->dataset = ted4_json_read(h->dataset_path, h->m);
    h->metadata = h->dataset == NULL ? NULL : ted4_json_read(h->metadata_path, h->m);
    if (h->metadata == NULL)
        return -1;
    return find_pictures(h) != 0 || add_pictures(h) != 0 || read_cloud(h) != 0 ? -1 : 0;
}

int ted4_load_hypernerf(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    hypernerf h;

    memset(&h, 0, sizeof h);
    s->layout = "hypernerf";
    s->timed = 1;
    h.scene = s;
    h.folder = folder;
    h.m = m;
    h.dataset_path = ted4_path_join(folder, "dataset.json");
    h.metadata_path = ted4_path_join(folder, "metadata.json");
    const int result = read_all(&h);
    json_decref(h.dataset);
    json_decref(h.metadata);
    free(h.dataset_path);
    free(h.metadata_path);
    free(h.pictures);
    return result;
}
