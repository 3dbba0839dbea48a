/* ray_ways.c - see ray_ways.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_ways.h"

#include <stddef.h>
#include <string.h>

typedef struct {
    const char *word;
    int number;
} meaning;

static const meaning words[RAY_VOCABULARIES][5] = {
    [RAY_BACKGROUNDS] = { { "room", RAY_ROOM },
                          { "white", RAY_WHITE },
                          { "black", RAY_BLACK },
                          { "transparent", RAY_CLEAR } },
    [RAY_POINTS_WORDS] = { { "surface", RAY_ON_SURFACES },
                           { "box10", RAY_BOX10 },
                           { "none", RAY_NO_POINTS },
                           { "random", RAY_ANYWHERE },
                           { "sfm", RAY_MOTION_POINTS } },
    [RAY_PNG_WORDS] = { { "16", RAY_PNG16 },
                        { "grey", RAY_GREY },
                        { "palette", RAY_PALETTE },
                        { "interlaced", RAY_INTERLACED } },
    [RAY_JPEG_WORDS] = { { "baseline", RAY_JPEG }, { "progressive", RAY_PROGRESSIVE } },
    [RAY_PATHS_WORDS] = { { "plain", RAY_NAME_ONLY },
                          { "ext", RAY_NO_FOLDER },
                          { "folder", RAY_NO_ENDING } },
    [RAY_SPLITS] = { { "val", RAY_VAL_FILE },
                     { "train-only", RAY_TRAIN_ONLY },
                     { "times", RAY_OTHER_TIMES } },
};

int ted4_ray_word(ted4_ray_vocabulary v, const char *word)
{
    for (int i = 0; i < 5 && words[v][i].word != NULL; i++) {
        if (strcmp(words[v][i].word, word) == 0)
            return words[v][i].number;
    }
    return -1;
}
