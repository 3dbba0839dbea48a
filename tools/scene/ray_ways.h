/* ray_ways.h - ways in which other writers differ from what ted4scene writes by default, and the
 * words for them. All zero is the default.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_WAYS_H
#define RAY_WAYS_H

/* RAY_USUAL: what the scene has. RAY_ROOM: what the scene has around its things, a room in most;
 * the others take it away. */
typedef enum { RAY_USUAL, RAY_ROOM, RAY_WHITE, RAY_BLACK, RAY_CLEAR } ted4_ray_background;

/* On surfaces; 100,000 at random in a box ten times as wide as the things; none; 4,000 at random in
 * a box about the things. */
typedef enum { RAY_ON_SURFACES, RAY_BOX10, RAY_NO_POINTS, RAY_ANYWHERE } ted4_ray_points;

/* PNG of 8 bits; of 16; grey; of a palette; interlaced; JPEG, also progressive. */
typedef enum {
    RAY_PNG,
    RAY_PNG16,
    RAY_GREY,
    RAY_PALETTE,
    RAY_INTERLACED,
    RAY_JPEG,
    RAY_PROGRESSIVE
} ted4_ray_file_kind;

/* How file_path names a picture: as usual in the layout; neither folder nor ending; no folder; no
 * ending. */
typedef enum { RAY_AS_USUAL, RAY_NAME_ONLY, RAY_NO_FOLDER, RAY_NO_ENDING } ted4_ray_paths;

/* The file of what is held out is the test file; transforms_val.json; not there, nor are its
 * pictures; the test file, whose times training does not have. */
typedef enum { RAY_TEST_FILE, RAY_VAL_FILE, RAY_TRAIN_ONLY, RAY_OTHER_TIMES } ted4_ray_split;

/* Numbers of the enumerations above, as the command line sets them, and the rest. */
typedef struct {
    int background, points, file, paths, split;
    int turns;         /* one camera a time, always another one, always elsewhere */
    int premultiplied; /* colours of transparent pictures are multiplied by alpha */
    int sizes;         /* cameras differ in picture size: 1, 3/4, 5/4 in turn */
    int k_each;        /* each picture states its K */
    int starts;        /* clips begin at different times */
    int up_y;          /* coordinates of the files: y up, not z */
    int masks;         /* truth/masks: where training pictures show what moves */
    int missing;       /* of the listed training pictures, how many are not there */
    double unit;       /* coordinates of the files in those of the room; 0: 1 */
    double off[2];     /* of the principal point from the middle, in widths and heights */
} ted4_ray_ways;

/* Words of options. What is usual, and RAY_PNG and RAY_TEST_FILE, have none. */
typedef enum {
    RAY_BACKGROUNDS,
    RAY_POINTS_WORDS,
    RAY_PNG_WORDS,
    RAY_JPEG_WORDS,
    RAY_PATHS_WORDS,
    RAY_SPLITS,
    RAY_VOCABULARIES
} ted4_ray_vocabulary;

/* The number that a word stands for, or -1. */
int ted4_ray_word(ted4_ray_vocabulary v, const char *word);

#endif
