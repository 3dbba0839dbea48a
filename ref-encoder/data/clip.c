/* clip.c - see clip.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/clip.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"
#include "data/picture_path.h"
#include "data/video.h"

void ted4_name_list_free(ted4_name_list *l)
{
    for (size_t i = 0; i < l->n; i++)
        free(l->names[i]);
    free(l->names);
    memset(l, 0, sizeof *l);
}

static int append(ted4_name_list *l, char *name)
{
    char **names = name == NULL ? NULL : realloc(l->names, (l->n + 1) * sizeof *names);

    if (names == NULL) {
        free(name);
        return -1;
    }
    l->names = names;
    l->names[l->n++] = name;
    return 0;
}

static int has_end(const char *name, const char *end)
{
    const size_t n = strlen(name), k = strlen(end);

    return n > k && strcmp(name + n - k, end) == 0;
}

static int is_picture(const char *name)
{
    return name[0] != '.' && ted4_picture_is_named(name);
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static int by_length(const void *a, const void *b)
{
    const size_t x = strlen(*(char *const *)a), y = strlen(*(char *const *)b);

    return x != y ? (x > y) - (x < y) : by_name(a, b);
}

/* One of the layouts in which a clip can be stored in the scene's folder. */
typedef struct {
    const char *parent; /* folder whose entries are examined, relative to the scene's folder */
    const char *inner;  /* folder that an entry must contain; NULL: the entry itself is the
                         * folder */
    const char *end;    /* suffix of a file's name; NULL: the entry is a folder */
} form;

static const form forms[] = { { "images", NULL, NULL },
                              { ".", "images", NULL },
                              { ".", NULL, ".mp4" } };

static int fits(const form *f, const char *parent, const char *entry)
{
    if (strncmp(entry, "cam", 3) != 0)
        return 0;
    char *path = ted4_path_join(parent, entry);
    char *inner = path != NULL && f->inner != NULL ? ted4_path_join(path, f->inner) : NULL;
    const int found = f->end != NULL ? has_end(entry, f->end) && path != NULL && ted4_is_file(path)
                                     : (f->inner == NULL ? path : inner) != NULL &&
                                           ted4_is_folder(f->inner == NULL ? path : inner);
    free(path);
    free(inner);
    return found;
}

static int add_fitting(ted4_name_list *l, const form *f, const char *parent)
{
    DIR *d = opendir(parent);
    int result = 0;

    for (struct dirent *e = d == NULL ? NULL : readdir(d); e != NULL && result == 0;
         e = readdir(d)) {
        if (!fits(f, parent, e->d_name))
            continue;
        char *name = ted4_text_copy(e->d_name);
        if (name != NULL && f->end != NULL)
            name[strlen(name) - strlen(f->end)] = 0;
        result = append(l, name);
    }
    if (d != NULL)
        closedir(d);
    return result;
}

int ted4_clip_names(ted4_name_list *l, const char *folder)
{
    int result = 0;

    memset(l, 0, sizeof *l);
    for (size_t i = 0; i < sizeof forms / sizeof forms[0] && l->n == 0 && result == 0; i++) {
        char *parent = ted4_path_join(folder, forms[i].parent);
        result = parent == NULL ? -1 : add_fitting(l, &forms[i], parent);
        free(parent);
    }
    if (result != 0)
        ted4_name_list_free(l);
    else if (l->n > 0)
        qsort(l->names, l->n, sizeof *l->names, by_name);
    return result;
}

int ted4_clip_list(ted4_name_list *pictures, const char *folder, int lengths)
{
    DIR *d = opendir(folder);
    int result = 0;

    memset(pictures, 0, sizeof *pictures);
    for (struct dirent *e = d == NULL ? NULL : readdir(d); e != NULL && result == 0;
         e = readdir(d)) {
        char *path = is_picture(e->d_name) ? ted4_path_join(folder, e->d_name) : NULL;
        if (path != NULL && ted4_is_special(path))
            free(path);
        else if (is_picture(e->d_name))
            result = append(pictures, path);
    }
    if (d != NULL)
        closedir(d);
    if (result != 0)
        ted4_name_list_free(pictures);
    else if (pictures->n > 0)
        qsort(pictures->names, pictures->n, sizeof *pictures->names, lengths ? by_length : by_name);
    return result;
}

/* Returns folder/first/second if it is a folder, else NULL. Owned by the caller. */
static char *inner_folder(const char *folder, const char *first, const char *second)
{
    char *outer = ted4_path_join(folder, first),
         *path = outer == NULL ? NULL : ted4_path_join(outer, second);

    free(outer);
    if (path != NULL && ted4_is_folder(path))
        return path;
    free(path);
    return NULL;
}

static void keep(ted4_name_list *l, size_t most)
{
    while (most > 0 && l->n > most)
        free(l->names[--l->n]);
}

/* Returns the video of that name in the scene's folder, with any supported extension, or NULL.
 * Owned by the caller. */
static char *find_video(const char *folder, const char *name)
{
    static const char *const ends[] = { "mp4", "mov", "mkv", "avi", "webm",
                                        "m4v", "MP4", "MOV", "MKV", "AVI" };
    char file[300];

    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        snprintf(file, sizeof file, "%.250s.%s", name, ends[i]);
        char *path = ted4_path_join(folder, file);
        if (path != NULL && ted4_is_file(path))
            return path;
        free(path);
    }
    return NULL;
}

/* Gives the folder of a clip's pictures, unpacking a video if necessary. *place is owned by the
 * caller. Returns as ted4_clips_find. */
static int find_place(const ted4_clips *c, ted4_clip *clip, const char *video, char **place,
                      const ted4_dataset_options *o, ted4_message *m)
{
    char *path = video == NULL ? NULL : ted4_path_join(c->folder, video);

    if (video != NULL && path == NULL)
        return ted4_say_no_memory(m);
    if (path != NULL && ted4_is_folder(path)) {
        *place = path;
        return 1;
    }
    if (video == NULL) {
        *place = inner_folder(c->folder, "images", clip->name);
        if (*place == NULL)
            *place = inner_folder(c->folder, clip->name, "images");
        if (*place != NULL)
            return 1;
        path = find_video(c->folder, clip->name);
    }
    if (path == NULL || !ted4_is_file(path)) {
        free(path);
        return 0;
    }
    clip->is_video = 1;
    *place = ted4_video_unpack(path, c->most, o, m);
    free(path);
    return *place == NULL ? -1 : 1;
}

int ted4_clips_find(ted4_clips *c, const ted4_clip *added, const char *video,
                    const ted4_dataset_options *o, ted4_message *m)
{
    ted4_clip *list = realloc(c->list, (c->n + 1) * sizeof *list);
    char *place = NULL;

    if (list == NULL)
        return ted4_say_no_memory(m);
    c->list = list;
    ted4_clip *clip = &list[c->n];
    *clip = *added;
    int result = find_place(c, clip, video, &place, o, m);
    if (result == 1) {
        c->n++;
        if (ted4_clip_list(&clip->pictures, place, 1) != 0)
            result = ted4_say_no_memory(m);
        else if (clip->pictures.n == 0)
            result = ted4_may_read(place, m) != 0 ? -1 : ted4_say(m, "%s: no pictures here", place);
        keep(&clip->pictures, c->most);
    }
    free(place);
    return result;
}

int ted4_clips_give(const ted4_clips *c, ted4_raw_scene *s, ted4_message *m)
{
    for (const ted4_clip *clip = c->list; clip < c->list + c->n; clip++)
        for (size_t i = 0; i < clip->pictures.n; i++) {
            ted4_shot *shot =
                ted4_raw_scene_add(s, ted4_text_copy(clip->pictures.names[i]), clip->name, m);
            if (shot == NULL)
                return -1;
            shot->lens = clip->model.lens;
            memcpy(shot->R, clip->model.R, sizeof shot->R);
            memcpy(shot->t, clip->model.t, sizeof shot->t);
            shot->is_test = clip->model.is_test;
            shot->time = clip->model.time + clip->frame[i];
            shot->camera = ted4_text_copy(clip->name);
            if (shot->camera == NULL)
                return ted4_say_no_memory(m);
        }
    return 0;
}

void ted4_clips_free(ted4_clips *c)
{
    for (size_t i = 0; i < c->n; i++) {
        ted4_name_list_free(&c->list[i].pictures);
        free(c->list[i].frame);
    }
    free(c->list);
    memset(c, 0, sizeof *c);
}
