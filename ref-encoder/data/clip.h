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

/* Lists all pictures in a folder, but no pipes and the like, sorted by name: with by_length shorter
 * names come first, so that 9999 precedes 10000. Returns 0, or -1 if memory runs out. */
int ted4_clip_list(ted4_name_list *pictures, const char *folder, int by_length);

/* A clip of the scene. */
typedef struct {
    const char *name;        /* label of the camera; borrowed */
    size_t entry;            /* index in the layout's list */
    ted4_shot model;         /* lens, pose and is_test of its pictures; time: that of its frame 0 */
    ted4_name_list pictures; /* in the order of time */
    uint32_t *frame;         /* [pictures.n] the clip's frame that each picture is; owned */
    size_t frames;           /* number of the clip's frames, also of those without a picture */
    int is_video;
} ted4_clip;

typedef struct {
    const char *folder; /* of the scene; borrowed */
    size_t most;        /* the first so many frames are wanted; 0: all */
    ted4_clip *list;    /* owned */
    size_t n;
    int is_counted;      /* the numbers in names count frames */
    uint64_t base, step; /* then frame k has the number base + k step */
    /* Pictures that would be missing if the numbers counted frames, and were no picture missing;
     * 0: names have no such numbers. */
    uint64_t lacking, expected;
} ted4_clips;

void ted4_clips_free(ted4_clips *c);

/* Adds the clip *added, of which name, entry and model are given, and its pictures, at most c->most
 * of them. The clip is the video or folder that the scene names (video), or if that is NULL, the
 * first of these that exists: images/NAME/, NAME/images/, a video NAME.mp4 (.mov, .mkv, .avi,
 * .webm, .m4v). Videos are unpacked (see video.h). Returns 1, or 0 if there is no clip, or -1 with
 * *m filled. */
int ted4_clips_find(ted4_clips *c, const ted4_clip *added, const char *video,
                    const ted4_dataset_options *o, ted4_message *m);

/* Appends a shot for every picture of all clips, in their order. Returns 0, or -1 with *m
 * filled. */
int ted4_clips_give(const ted4_clips *c, ted4_raw_scene *s, ted4_message *m);

/* clip_times.c: finds the frames of all pictures, and leaves pictures out that are not of the first
 * c->most frames. The last number in a picture's name, less the smallest of all clips and divided
 * by the common step of all numbers, is its frame, so that pictures of equal numbers have equal
 * times. Pictures are counted in their order instead if names have no numbers, or not increasing
 * ones, or if the clips would lack half of their pictures or more; the frames of a video are always
 * counted. Returns 0, or -1 with *m filled. */
int ted4_clips_number(ted4_clips *c, ted4_message *m);

/* clip_times.c: warns of missing pictures and of numbers that were not used, and names the picture
 * that is the reason; where together is set, as all clips should end at the same time, it warns of
 * clips that end early, too. Returns 0, or -1 with *m filled. */
int ted4_clips_say(const ted4_clips *c, int together, ted4_raw_scene *s, ted4_message *m);

#endif
