/* raw_scene.c - see raw_scene.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "data/image_file.h"

void ted4_raw_scene_free(ted4_raw_scene *s)
{
    for (size_t i = 0; i < s->n_shots; i++) {
        free(s->shots[i].path);
        free(s->shots[i].camera);
    }
    free(s->shots);
    for (size_t i = 0; i < s->n_warnings; i++)
        free(s->warnings[i]);
    free(s->warnings);
    ted4_point_cloud_free(&s->cloud);
    memset(s, 0, sizeof *s);
}

static int reserve(ted4_raw_scene *s)
{
    if (s->n_shots < s->capacity)
        return 0;
    const size_t capacity = s->capacity == 0 ? 64 : 2 * s->capacity;
    ted4_shot *shots = s->capacity > SIZE_MAX / 2 / sizeof *shots
                           ? NULL
                           : realloc(s->shots, capacity * sizeof *shots);
    if (shots == NULL)
        return -1;
    s->shots = shots;
    s->capacity = capacity;
    return 0;
}

ted4_shot *ted4_raw_scene_add(ted4_raw_scene *s, char *path, const char *where, ted4_message *m)
{
    ted4_image_header header;
    ted4_message why;

    if (path == NULL || reserve(s) != 0) {
        free(path);
        ted4_say_no_memory(m);
        return NULL;
    }
    if (ted4_image_probe(path, &header, &why) != 0) {
        ted4_say(m, "%s: %s", where, why.text);
        free(path);
        return NULL;
    }
    ted4_shot *shot = &s->shots[s->n_shots++];
    memset(shot, 0, sizeof *shot);
    shot->path = path;
    shot->width = shot->lens.width = header.width;
    shot->height = shot->lens.height = header.height;
    shot->has_alpha = header.has_alpha;
    shot->orientation = header.orientation;
    return shot;
}

void ted4_raw_scene_missing(ted4_raw_scene *s, const char *where, const char *name)
{
    if (s->n_missing++ == 0)
        snprintf(s->first_missing, sizeof s->first_missing, "%.500s: %.190s", where, name);
}

/* Does the path not exist, or is it no file from which a picture can be read? A file that exists
 * but cannot be read is an error, not an absence. */
static int is_absent(const char *path)
{
    struct stat st;

    if (stat(path, &st) != 0)
        return errno == ENOENT || errno == ENOTDIR || errno == ENAMETOOLONG;
    return ted4_is_special(path);
}

int ted4_raw_scene_list(ted4_raw_scene *s, char *path, const char *where, ted4_shot **shot,
                        ted4_message *m)
{
    *shot = NULL;
    s->n_entries++;
    if (path != NULL && is_absent(path)) {
        ted4_raw_scene_missing(s, where, path);
        free(path);
        return 0;
    }
    *shot = ted4_raw_scene_add(s, path, where, m);
    return *shot == NULL ? -1 : 1;
}

void ted4_raw_scene_hold_out(ted4_raw_scene *s)
{
    for (size_t i = 0; i < s->n_shots; i++)
        s->shots[i].is_test = i % TED4_HOLD_OUT_EVERY == TED4_HOLD_OUT_PHASE;
}
