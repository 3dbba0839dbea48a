/* clip.h - what a fixed camera saw over time, for layouts with one camera a clip: a folder of
 * pictures, or a video. Depends on data/raw_scene.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CLIP_H
#define TED4_CLIP_H

#include <stddef.h>
#include "data/raw_scene.h"

/* Sorted names; owned, with the list. */
typedef struct {
    char **names;
    size_t n;
} ted4_name_list;

void ted4_name_list_free(ted4_name_list *l);

/* The clips of a folder that begin with "cam": NAME of images/NAME/ where there is any, else of
 * NAME/images/, else of NAME.mp4. 0 with l->n == 0: none. -1: no memory. */
int ted4_clip_names(ted4_name_list *l, const char *folder);

/* All pictures in a folder, in the order of names, shorter ones first, so that 9999 is before
 * 10000; by_length 0: plainly by name. 0, or -1: no memory. */
int ted4_clip_list(ted4_name_list *pictures, const char *folder, int by_length);

/* Pictures of a clip: of the video, or folder of pictures, that the scene names (NULL: none) if it
 * is there, else of images/NAME/ or NAME/images/, else of a video NAME.mp4 (.mov, .mkv, .avi,
 * .webm, .m4v). Videos are unpacked (see video.h). At most most pictures, 0: all. 1, or 0: there is
 * none of all these, or -1 with *m filled; *pictures is empty then. */
int ted4_clip_pictures(ted4_name_list *pictures, const char *folder, const char *name,
                       const char *video, size_t most, const ted4_dataset_options *o,
                       ted4_message *m);

/* Appends a shot for every picture: lens, pose and is_test of *model, time = index from its time
 * on, label = name. */
int ted4_clip_add(ted4_raw_scene *s, const ted4_name_list *pictures, const char *name,
                  const ted4_shot *model, ted4_message *m);

/* Warns when clips that should show the same times have from shortest to longest frames. 0, or -1
 * with *m filled. */
int ted4_clip_lengths(ted4_raw_scene *s, size_t shortest, size_t longest, ted4_message *m);

#endif
