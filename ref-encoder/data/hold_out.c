/* hold_out.c - marks the test pictures where the caller names cameras. See raw_scene.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/picture_path.h"

/* Shots without a label belong to the same camera if their poses agree to six decimals. The rounded
 * pose becomes the label. */
static char *pose_label(const ted4_shot *s)
{
    char text[12 * 26], *at = text;
    double centre[3];

    ted4_pose_centre(s->R, s->t, centre);
    for (int i = 0; i < 12; i++) {
        const double v = i < 9 ? s->R[i] : centre[i - 9];
        at += snprintf(at, 26, "%.15g ", round(v * 1e6) + 0.0); /* + 0.0 turns -0 into 0 */
    }
    return ted4_text_copy(text);
}

int ted4_raw_scene_label(ted4_raw_scene *s)
{
    for (size_t i = 0; i < s->n_shots; i++) {
        ted4_shot *shot = &s->shots[i];
        shot->is_posed = shot->camera == NULL;
        if (shot->is_posed && (shot->camera = pose_label(shot)) == NULL)
            return -1;
    }
    return 0;
}

const char *ted4_camera_name(const char *label, size_t *n)
{
    const char *slash = strchr(label, '/'),
               *folder = slash != NULL && slash[1] != 0 ? slash + 1 : label;

    *n = strlen(folder);
    while (*n > 1 && folder[*n - 1] == '/')
        --*n;
    return folder;
}

static int is_short_label(const ted4_shot *s, const char *name)
{
    size_t n;
    const char *label = ted4_camera_name(s->camera, &n);

    return strlen(name) == n && strncmp(label, name, n) == 0;
}

/* Does the path, with or without its extension, end with the parts of name? */
static int is_picture(const ted4_shot *s, const char *name)
{
    const size_t n = strlen(s->path), k = strlen(name);
    const char *dot = strrchr(s->path, '.');
    const size_t bare = dot != NULL && ted4_picture_is_named(s->path) ? (size_t)(dot - s->path) : n;
    const size_t ends[2] = { n, bare };

    for (int i = 0; i < 2; i++)
        if (k > 0 && k <= ends[i] && strncmp(s->path + ends[i] - k, name, k) == 0 &&
            (k == ends[i] || s->path[ends[i] - k - 1] == '/'))
            return 1;
    return 0;
}

/* Does the name fit a picture of another camera than that of shot? */
static int is_shared(const ted4_raw_scene *s, const ted4_shot *shot, const char *name)
{
    for (size_t i = 0; i < s->n_shots; i++)
        if (is_picture(&s->shots[i], name) && strcmp(s->shots[i].camera, shot->camera) != 0)
            return 1;
    return 0;
}

/* Returns the name of a shot's camera and its length *n: the camera's own, or as much of the path
 * of the shot's picture as no other camera has. */
static const char *name_of(const ted4_raw_scene *s, const ted4_shot *shot, size_t *n)
{
    if (!shot->is_posed)
        return ted4_camera_name(shot->camera, n);
    const char *name = shot->path + strlen(shot->path);
    do {
        for (name--; name > shot->path && name[-1] != '/'; name--)
            ;
    } while (name > shot->path && is_shared(s, shot, name));
    *n = strlen(name);
    return name;
}

/* Do the cameras of these shots have the same name? Several cameras have one where their pictures
 * lie in one folder of COLMAP. */
static int same_name(const ted4_shot *a, const ted4_shot *b)
{
    size_t n, k;

    if (a->is_posed || b->is_posed)
        return strcmp(a->camera, b->camera) == 0;

    const char *const name = ted4_camera_name(a->camera, &n), *const other =
                                                                  ted4_camera_name(b->camera, &k);

    return n == k && memcmp(name, other, n) == 0;
}

/* Lists the names of cameras, or of pictures where cameras have no name, as far as there is
 * room. */
static void list_names(const ted4_raw_scene *s, char *text, size_t size)
{
    const size_t full = size - 39;
    size_t used = 0, n = 0;

    text[0] = 0;
    for (size_t i = 0; i < s->n_shots; i++) {
        const ted4_shot *shot = &s->shots[i];
        size_t length = 0, k = 0;
        while (k < i && !same_name(&s->shots[k], shot))
            k++;
        if (k < i)
            continue;
        n++;
        if (used == full)
            continue;
        const char *name = name_of(s, shot, &length);
        if (used + length + 1 < full)
            used += (size_t)snprintf(text + used, size - used, "%s%.*s", n > 1 ? ", " : "",
                                     (int)length, name);
        else
            used = full;
    }
    if (used == full)
        snprintf(text + strlen(text), 39, ", ... (%zu in all)", n);
}

/* Marks the shots of the camera with this label as test or, if there is none, of all cameras that
 * are called so for short. Returns whether there are any. */
static int hold_out_cameras(ted4_raw_scene *s, const char *name)
{
    int found = 0;

    for (int shorter = 0; shorter < 2 && !found; shorter++)
        for (size_t i = 0; i < s->n_shots; i++) {
            ted4_shot *shot = &s->shots[i];

            if (!shot->is_posed &&
                (shorter ? is_short_label(shot, name) : strcmp(shot->camera, name) == 0))
                found = shot->is_test = 1;
        }
    return found;
}

/* Returns the label of the camera of the picture that name refers to, or NULL with *m filled. */
static const char *find_camera(const ted4_raw_scene *s, const char *name, ted4_message *m)
{
    const char *found = NULL;
    char names[700];

    for (size_t i = 0; i < s->n_shots; i++) {
        if (!is_picture(&s->shots[i], name))
            continue;
        if (found != NULL && strcmp(found, s->shots[i].camera) != 0) {
            ted4_say(m,
                     "--hold-out %.200s: pictures of several cameras are called so, expected more "
                     "of the path",
                     name);
            return NULL;
        }
        found = s->shots[i].camera;
    }
    if (found == NULL) {
        list_names(s, names, sizeof names);
        ted4_say(m, "--hold-out %.200s: no camera or picture of this name, expected one of: %s",
                 name, names);
    }
    return found;
}

int ted4_raw_scene_hold_out_named(ted4_raw_scene *s, const ted4_dataset_options *o, ted4_message *m)
{
    for (size_t i = 0; i < s->n_shots; i++)
        s->shots[i].is_test = 0;
    for (size_t k = 0; k < o->n_hold_out; k++) {
        if (hold_out_cameras(s, o->hold_out[k]))
            continue;
        const char *camera = find_camera(s, o->hold_out[k], m);
        if (camera == NULL)
            return -1;
        for (size_t i = 0; i < s->n_shots; i++)
            s->shots[i].is_test |= strcmp(s->shots[i].camera, camera) == 0;
    }
    return 0;
}
