/* transforms.h - state of a transforms file while load_transforms.c reads it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRANSFORMS_H
#define TED4_TRANSFORMS_H

#include "data/json_field.h"
#include "data/raw_scene.h"

typedef struct {
    ted4_raw_scene *scene;
    const char *folder;
    const char *part;    /* "train", "val" or "test", from the file's name; else NULL */
    char *path;          /* owned */
    json_t *root;        /* owned */
    const json_t *frame; /* frame being read; borrowed */
    char where[700];     /* "path: frames[i]" */
    size_t *shot_of;     /* [frames] index of the shot of a frame, or TED4_NO_SHOT; owned */
    int is_test;
    double applied[12]; /* world of the file = applied * world of the dataset; 3x4 */
    double applied_scale;
    ted4_message *m;
} ted4_transforms;

/* Stands in shot_of for a frame without a picture. */
#define TED4_NO_SHOT SIZE_MAX

/* Reads the lens of the current frame (in transforms_lens.c). *l must hold the size of the picture.
 * Returns 0, or -1 with *m filled. */
int ted4_transforms_lens(ted4_transforms *t, ted4_lens *l);

/* Does a frame, or the top of a file, state a focal length in pixels? */
int ted4_transforms_has_focal(const json_t *object);

#endif
