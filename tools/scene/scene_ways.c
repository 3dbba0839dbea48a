/* scene_ways.c - see scene_ways.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "scene_ways.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char ted4_scene_ways_help[] =
    "What other writers do; most of these go together. Content stays the same:\n"
    "  --background B      room, white, black or transparent: what is around the things\n"
    "  --turns             one camera a time, each elsewhere; as many times as cameras\n"
    "  --points P          surface (default), box10 (100,000 at random in a box ten times as wide\n"
    "                      as the things), none, random (4,000 in a box about the things)\n"
    "  --unit S            coordinates in the files are S times as large\n"
    "  --up A              y or z (default)\n"
    "  --centre X,Y        principal point, in widths and heights (0.5,0.5)\n"
    "  --sizes             cameras differ in picture size: 1, 3/4, 5/4 in turn\n"
    "  --alpha A           straight (default) or premultiplied\n"
    "  --png K             16 (bits), grey, palette or interlaced\n"
    "  --jpeg K            baseline or progressive\n"
    "  --paths P           file_path is plain (neither folder nor ending), ext (without folder) "
    "or\n"
    "                      folder (without ending)\n"
    "  --split S           val (transforms_val.json), train-only (nothing else) or times (test "
    "times\n"
    "                      are those that training lacks: see --hold)\n"
    "  --missing N         of the pictures that are listed for training, N are not there\n"
    "  --k-each            each picture states its K; of colmap, each camera\n"
    "  --starts            calibration: clips begin at different times, which cams.json tells\n"
    "  --masks             truth/masks: where training pictures show what moves, or its shadow\n";

enum {
    BACKGROUND = TED4_SCENE_WAYS,
    TURNS,
    POINTS,
    UNIT,
    UP,
    CENTRE,
    SIZES,
    ALPHA,
    PNG,
    JPEG,
    PATHS,
    SPLIT,
    MISSING,
    K_EACH,
    STARTS,
    MASKS
};

const struct option ted4_scene_ways[TED4_SCENE_N_WAYS] = {
    { "background", required_argument, NULL, BACKGROUND },
    { "turns", no_argument, NULL, TURNS },
    { "points", required_argument, NULL, POINTS },
    { "unit", required_argument, NULL, UNIT },
    { "up", required_argument, NULL, UP },
    { "centre", required_argument, NULL, CENTRE },
    { "sizes", no_argument, NULL, SIZES },
    { "alpha", required_argument, NULL, ALPHA },
    { "png", required_argument, NULL, PNG },
    { "jpeg", required_argument, NULL, JPEG },
    { "paths", required_argument, NULL, PATHS },
    { "split", required_argument, NULL, SPLIT },
    { "missing", required_argument, NULL, MISSING },
    { "k-each", no_argument, NULL, K_EACH },
    { "starts", no_argument, NULL, STARTS },
    { "masks", no_argument, NULL, MASKS },
};

static int word(ted4_ray_vocabulary v, const char *text, int *number)
{
    *number = ted4_ray_word(v, text);
    return *number < 0 ? -1 : 0;
}

/* Parses one of two words as 0 or 1. */
static int either(const char *zero, const char *one, const char *text, int *which)
{
    *which = strcmp(text, one) == 0;
    return *which || strcmp(text, zero) == 0 ? 0 : -1;
}

static int unit(const char *text, double *value)
{
    char *end;

    *value = strtod(text, &end);
    return end != text && *end == '\0' && *value >= 1e-6 && *value <= 1e6 ? 0 : -1;
}

/* Parses "0.6,0.45", a point within the picture. */
static int centre(const char *text, double off[2])
{
    double x, y;
    char rest;

    if (sscanf(text, "%lf,%lf%c", &x, &y, &rest) != 2 || !(x >= 0 && x <= 1 && y >= 0 && y <= 1))
        return -1;
    off[0] = x - 0.5;
    off[1] = y - 0.5;
    return 0;
}

static int count(const char *text, int *n)
{
    char rest;

    return sscanf(text, "%d%c", n, &rest) == 1 && *n >= 0 && *n <= 1000000 ? 0 : -1;
}

static int flag(int *set)
{
    *set = 1;
    return 0;
}

int ted4_scene_way(int number, const char *text, ted4_ray_ways *w)
{
    switch (number) {
    case BACKGROUND: return word(RAY_BACKGROUNDS, text, &w->background);
    case TURNS: return flag(&w->turns);
    case POINTS: return word(RAY_POINTS_WORDS, text, &w->points);
    case UNIT: return unit(text, &w->unit);
    case UP: return either("z", "y", text, &w->up_y);
    case CENTRE: return centre(text, w->off);
    case SIZES: return flag(&w->sizes);
    case ALPHA: return either("straight", "premultiplied", text, &w->premultiplied);
    case PNG: return word(RAY_PNG_WORDS, text, &w->file);
    case JPEG: return word(RAY_JPEG_WORDS, text, &w->file);
    case PATHS: return word(RAY_PATHS_WORDS, text, &w->paths);
    case SPLIT: return word(RAY_SPLITS, text, &w->split);
    case MISSING: return count(text, &w->missing);
    case K_EACH: return flag(&w->k_each);
    case STARTS: return flag(&w->starts);
    default: return flag(&w->masks);
    }
}
