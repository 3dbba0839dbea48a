/* ray_ways.h - options for files as other writers make them, different from the defaults of
 * ted4scene, and the words for these options. All zero is the default.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_WAYS_H
#define RAY_WAYS_H

/* RAY_USUAL: the default of the scene. RAY_ROOM: the scene's own surroundings, in most scenes a
 * room. The others remove them. */
typedef enum { RAY_USUAL, RAY_ROOM, RAY_WHITE, RAY_BLACK, RAY_CLEAR } ted4_ray_background;

/* 4,000 on surfaces; 100,000 random points in a box ten times as wide as the things; none; 4,000
 * random points in a box around the things; 1,000 as structure from motion finds them: on what
 * never moves, less exact along the ray of a camera, with that camera's tint. */
typedef enum {
    RAY_ON_SURFACES,
    RAY_BOX10,
    RAY_NO_POINTS,
    RAY_ANYWHERE,
    RAY_MOTION_POINTS
} ted4_ray_points;

/* PNG of 8 bits, of 16 bits, grey, with a palette, interlaced; JPEG, also progressive. */
typedef enum {
    RAY_PNG,
    RAY_PNG16,
    RAY_GREY,
    RAY_PALETTE,
    RAY_INTERLACED,
    RAY_JPEG,
    RAY_PROGRESSIVE
} ted4_ray_file_kind;

/* How file_path names a picture: as is usual for the layout; without folder and ending; without
 * folder; without ending. */
typedef enum { RAY_AS_USUAL, RAY_NAME_ONLY, RAY_NO_FOLDER, RAY_NO_ENDING } ted4_ray_paths;

/* Where the held-out pictures are listed: in the test file; in transforms_val.json; nowhere, and
 * they do not exist; in the test file, with times that training does not have. */
typedef enum { RAY_TEST_FILE, RAY_VAL_FILE, RAY_TRAIN_ONLY, RAY_OTHER_TIMES } ted4_ray_split;

/* Numbers of the enumerations above, as the command line sets them, and other options. */
typedef struct {
    int background, points, file, paths, split;
    int turns;         /* one camera per time, always a different one at a different place */
    int premultiplied; /* 1: colours of transparent pictures are premultiplied by alpha */
    int sizes;         /* 1: picture sizes differ between cameras: 1, 3/4, 5/4 in turn */
    int k_each;        /* 1: each picture states its own K */
    int starts;        /* 1: clips begin at different times */
    int up_y;          /* 1: coordinates of the files have y up instead of z */
    int masks;         /* 1: write truth/masks, which show the moving parts of training pictures */
    int missing;       /* number of listed training pictures that do not exist */
    double unit;       /* ratio of lengths in the files to lengths in the room; 0: 1 */
    double off[2];     /* offset of the principal point from the middle, in widths and heights */
} ted4_ray_ways;

/* Words for options. The default values, RAY_PNG and RAY_TEST_FILE have no word. */
typedef enum {
    RAY_BACKGROUNDS,
    RAY_POINTS_WORDS,
    RAY_PNG_WORDS,
    RAY_JPEG_WORDS,
    RAY_PATHS_WORDS,
    RAY_SPLITS,
    RAY_VOCABULARIES
} ted4_ray_vocabulary;

/* Returns the number that a word stands for, or -1. */
int ted4_ray_word(ted4_ray_vocabulary v, const char *word);

#endif
