/* load_colmap.c - loads the layout "colmap": images/ and a sparse model in sparse/0 or sparse.
 * Time: the last number in a file's name orders the pictures, and each distinct number is one
 * frame. Split: see raw_scene.h. Physical camera: COLMAP's camera together with the folder below
 * images/, because COLMAP itself customarily has one folder per camera. If there is no images/, a
 * copy reduced by N in images_N/ is used, as PNG or JPEG.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/colmap_file.h"
#include "data/data_util.h"
#include "data/picture_path.h"
#include "math/compare.h"

static int has_cameras(const char *model)
{
    static const char *const files[] = { "cameras.bin", "cameras.txt" };
    int found = 0;

    for (size_t i = 0; i < sizeof files / sizeof files[0] && !found; i++) {
        char *file = ted4_path_join(model, files[i]);
        found = file != NULL && ted4_is_file(file);
        free(file);
    }
    return found;
}

/* Returns folder/name if it holds a model, else NULL. Owned by the caller. */
static char *model_in(const char *folder, const char *name)
{
    char *model = ted4_path_join(folder, name);

    if (model != NULL && has_cameras(model))
        return model;
    free(model);
    return NULL;
}

/* Returns folder/sparse/0 or folder/sparse, whichever holds cameras.*, or NULL if neither does.
 * Owned by the caller. */
static char *find_model(const char *folder)
{
    char *model = model_in(folder, "sparse/0");

    return model != NULL ? model : model_in(folder, "sparse");
}

/* Says why no model was found. */
static int no_model(const char *folder, ted4_message *m)
{
    static const char *const places[] = { "sparse", "sparse/0" };

    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        char *place = ted4_path_join(folder, places[i]);
        const int result = place == NULL ? ted4_say_no_memory(m) : ted4_may_read(place, m);
        free(place);
        if (result != 0)
            return -1;
    }
    return ted4_say(m, "%s/sparse: neither cameras.bin nor cameras.txt here or in sparse/0",
                    folder);
}

int ted4_is_colmap(const char *folder)
{
    char *sparse = ted4_path_join(folder, "sparse");
    const int found = sparse != NULL && ted4_is_folder(sparse);

    free(sparse);
    return found;
}

static const char *base_name(const char *name)
{
    const char *slash = strrchr(name, '/');

    return slash == NULL ? name : slash + 1;
}

static char *camera_label(const ted4_colmap_image *image)
{
    const size_t n = (size_t)(base_name(image->name) - image->name);
    char *label = malloc(n + 16);

    if (label != NULL)
        snprintf(label, n + 16, "%u/%.*s", (unsigned)image->camera, (int)n, image->name);
    return label;
}

static const ted4_colmap_camera *find_camera(const ted4_colmap *c, uint32_t id)
{
    for (size_t i = 0; i < c->n_cameras; i++)
        if (c->cameras[i].id == id)
            return &c->cameras[i];
    return NULL;
}

static int add_image(ted4_raw_scene *s, const ted4_colmap *c, const ted4_colmap_image *image,
                     const char *images, ted4_message *m)
{
    const ted4_colmap_camera *camera = find_camera(c, image->camera);
    char where[300];

    snprintf(where, sizeof where, "COLMAP image \"%.250s\"", image->name);
    if (camera == NULL)
        return ted4_say(m, "%s: its camera %u is not in the cameras file", where,
                        (unsigned)image->camera);
    ted4_shot *shot;
    char *path = ted4_path_join(images, image->name), *other = NULL;
    /* Reduced copies may be in another file format than their originals. */
    if (s->reduced > 1 && path != NULL && !ted4_is_file(path) &&
        ted4_picture_find(images, image->name, NULL, &other) == 1) {
        free(path);
        path = other;
    }
    const int there = ted4_raw_scene_list(s, path, where, &shot, m);
    if (there <= 0)
        return there;
    shot->lens = camera->lens;
    memcpy(shot->R, image->R, sizeof shot->R);
    memcpy(shot->t, image->t, sizeof shot->t);
    shot->time = ted4_picture_number(image->name);
    if (shot->time == -2)
        return ted4_say(m, "%s: the number in the name has more than 15 digits", where);
    shot->camera = camera_label(image);
    return shot->camera == NULL ? ted4_say_no_memory(m) : 0;
}

/* Says that names with and without numbers, ranks above 0 and rank 0, are mixed. */
static int say_mixed(const ted4_raw_scene *s, ted4_message *m)
{
    size_t without = 0, with = 0;

    while (s->shots[without].time > 0)
        without++;
    while (s->shots[with].time == 0)
        with++;
    return ted4_say(m,
                    "%.400s has no number in its name, %.400s has one: their order in time is "
                    "unknown",
                    s->shots[without].path, s->shots[with].path);
}

/* Replaces each number by its rank, because numbers in names only order the frames. If no name has
 * a number, all pictures are frame 0; names with and without numbers cannot be mixed. */
static int rank_numbers(ted4_raw_scene *s, ted4_message *m)
{
    double *v = malloc((s->n_shots + 1) * sizeof *v);
    size_t k = 0;

    if (v == NULL)
        return ted4_say_no_memory(m);
    for (size_t i = 0; i < s->n_shots; i++)
        v[i] = s->shots[i].time;
    qsort(v, s->n_shots, sizeof *v, ted4_compare_doubles);
    for (size_t i = 0; i < s->n_shots; i++)
        if (k == 0 || v[i] != v[k - 1])
            v[k++] = v[i];
    for (size_t i = 0; i < s->n_shots; i++) {
        const double *at = bsearch(&s->shots[i].time, v, k, sizeof *v, ted4_compare_doubles);
        s->shots[i].time = (double)(at - v);
    }
    const int mixed = k > 1 && v[0] == -1;
    free(v);
    return mixed ? say_mixed(s, m) : 0;
}

static int add_images(ted4_raw_scene *s, ted4_colmap *c, const char *images, ted4_message *m)
{
    for (size_t i = 0; i < c->n_images; i++)
        if (add_image(s, c, &c->images[i], images, m) != 0)
            return -1;
    ted4_raw_scene_hold_out(s);
    return rank_numbers(s, m);
}

/* What is counted in images/. */
typedef struct {
    const ted4_colmap *model;
    size_t there, unlisted;
} census;

static int by_name(const void *name, const void *image)
{
    return strcmp(name, ((const ted4_colmap_image *)image)->name);
}

/* Folders in images/ are one for each camera, perhaps in one for each day or place. The bound keeps
 * links in circles from being followed for ever. */
enum { DEEPEST = 4 };

/* Counts the pictures in a folder and the folders in it. prefix: what the model's names begin with
 * here. Returns 0, or -1 if memory runs out. */
static int count_pictures(census *k, const char *folder, const char *prefix, int depth)
{
    DIR *d = opendir(folder);
    int result = 0;

    for (struct dirent *e = d == NULL ? NULL : readdir(d); e != NULL && result == 0;
         e = readdir(d)) {
        if (e->d_name[0] == '.')
            continue;
        const size_t size = strlen(prefix) + strlen(e->d_name) + 2;
        char *path = ted4_path_join(folder, e->d_name), *name = malloc(size);
        if (path == NULL || name == NULL) {
            result = -1;
        } else if (ted4_is_folder(path) && depth < DEEPEST) {
            snprintf(name, size, "%s%s/", prefix, e->d_name);
            result = count_pictures(k, path, name, depth + 1);
        } else if (ted4_picture_is_named(e->d_name) && ted4_is_file(path)) {
            snprintf(name, size, "%s%s", prefix, e->d_name);
            k->there++;
            k->unlisted += bsearch(name, k->model->images, k->model->n_images,
                                   sizeof *k->model->images, by_name) == NULL;
        }
        free(path);
        free(name);
    }
    if (d != NULL)
        closedir(d);
    return result;
}

/* Warns of pictures that the model lacks, and of a further model, which COLMAP writes where it did
 * not find how pictures hang together. Returns 0, or -1 if memory runs out. */
static int say_unlisted(ted4_raw_scene *s, const ted4_colmap *c, const char *folder,
                        const char *images, const char *model)
{
    census k = { .model = c };

    if (c->n_images > 0 && count_pictures(&k, images, "", 0) != 0)
        return -1;
    if (k.unlisted == 0)
        return 0;
    char *other = model_in(folder, "sparse/1");
    const int result = ted4_raw_scene_warn(
        s, "%zu of %zu pictures in %.300s %s not in the model %.300s%s%.300s%s", k.unlisted,
        k.there, images, k.unlisted == 1 ? "is" : "are", model, other != NULL ? "; the model " : "",
        other != NULL ? other : "", other != NULL ? " is not used" : "");
    free(other);
    return result;
}

/* Returns images/, or if it does not exist, a reduced copy images_N: the one with the requested
 * reduction, else the least reduced. Owned by the caller. Returns NULL with *m filled on
 * failure. */
static char *find_images(ted4_raw_scene *s, const char *folder, size_t n, ted4_message *m)
{
    const int sizes[] = { 1, s->wanted->downscale, 2, 4, 8, 16 };
    char name[32];

    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        snprintf(name, sizeof name, sizes[i] > 1 ? "images_%d" : "images", sizes[i]);
        char *images = ted4_path_join(folder, name);
        s->reduced = sizes[i];
        if (images == NULL)
            ted4_say_no_memory(m);
        if (images == NULL || ted4_is_folder(images))
            return images;
        free(images);
    }
    ted4_say(m, "%s/images: no such folder, expected the %zu pictures of the sparse model", folder,
             n);
    return NULL;
}

int ted4_load_colmap(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    ted4_colmap c;
    char *model = find_model(folder), *images = NULL;
    int result;

    s->layout = "colmap";
    memset(&c, 0, sizeof c);
    if (model == NULL)
        result = no_model(folder, m);
    else
        result = ted4_colmap_read(&c, model, m);
    if (result == 0 && (images = find_images(s, folder, c.n_images, m)) == NULL)
        result = -1;
    if (result == 0)
        result = add_images(s, &c, images, m);
    /* The names of reduced copies may differ from those of the model. */
    if (result == 0 && s->reduced == 1 && say_unlisted(s, &c, folder, images, model) != 0)
        result = ted4_say_no_memory(m);
    if (result == 0 && c.cloud.n > 0) {
        s->cloud = c.cloud;
        memset(&c.cloud, 0, sizeof c.cloud);
    } else if (result == 0) {
        result = ted4_ply_find(&s->cloud, folder, m);
    }
    ted4_colmap_free(&c);
    free(model);
    free(images);
    return result;
}
