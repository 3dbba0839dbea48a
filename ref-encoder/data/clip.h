/* clip.h - the frames of one fixed camera, for layouts with one clip per camera: a folder of
 * pictures or a video. Depends on data/raw_scene.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CLIP_H
#define TED4_CLIP_H

#include <stddef.h>
#include "data/raw_scene.h"

/* A sorted list of names. The list and the names are owned. */
typedef struct {
    char **names;
    size_t n;
} ted4_name_list;

void ted4_name_list_free(ted4_name_list *l);

/* Lists the clips of a folder whose names begin with "cam": every NAME with a folder images/NAME/,
 * or if there is none, every NAME with NAME/images/, or else with NAME.mp4. l->n is 0 if there is
 * no clip. Returns 0, or -1 if memory runs out. */
int ted4_clip_names(ted4_name_list *l, const char *folder);

/* Lists all pictures in a folder, sorted by name: with by_length shorter names come first, so that
 * 9999 precedes 10000. Returns 0, or -1 if memory runs out. */
int ted4_clip_list(ted4_name_list *pictures, const char *folder, int by_length);

/* Lists the pictures of a clip, at most most of them (0: all). The first of these that exists is
 * used: the video or folder that the scene names (video; NULL: none), images/NAME/, NAME/images/, a
 * video NAME.mp4 (.mov, .mkv, .avi, .webm, .m4v). Videos are unpacked (see video.h). Returns 1, or
 * 0 if none exists, or -1 with *m filled; *pictures is empty unless 1 is returned. */
int ted4_clip_pictures(ted4_name_list *pictures, const char *folder, const char *name,
                       const char *video, size_t most, const ted4_dataset_options *o,
                       ted4_message *m);

/* Appends a shot for every picture, with the lens, pose and is_test of *model and the label name.
 * Times are model->time plus the picture's index. Returns 0, or -1 with *m filled. */
int ted4_clip_add(ted4_raw_scene *s, const ted4_name_list *pictures, const char *name,
                  const ted4_shot *model, ted4_message *m);

/* Warns if clips that should show the same times differ in length, from shortest to longest frames.
 * Returns 0, or -1 with *m filled. */
int ted4_clip_lengths(ted4_raw_scene *s, size_t shortest, size_t longest, ted4_message *m);

#endif
