/* scene_ways.c - see scene_ways.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "scene_ways.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    BACKGROUND,
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

const ted4_argument ted4_scene_ways[TED4_SCENE_N_WAYS] = {
    [BACKGROUND] = { 0, "background", "B",
                     "room, white, black or transparent: what is around the things" },
    [TURNS] = { 0, "turns", NULL, "one camera a time, each elsewhere; as many times as cameras" },
    [POINTS] = { 0, "points", "P",
                 "surface (default), box10 (100,000 at random in a box ten times as wide as the "
                 "things), none, random (4,000 in a box about the things) or sfm (1,000 as "
                 "structure from "
                 "motion finds them: on still things, less exact, tinted)" },
    [UNIT] = { 0, "unit", "S", "coordinates in the files are S times as large" },
    [UP] = { 0, "up", "A", "y or z (default)" },
    [CENTRE] = { 0, "centre", "X,Y", "principal point, in widths and heights. Default 0.5,0.5" },
    [SIZES] = { 0, "sizes", NULL, "cameras differ in picture size: 1, 3/4, 5/4 in turn" },
    [ALPHA] = { 0, "alpha", "A", "straight (default) or premultiplied" },
    [PNG] = { 0, "png", "K", "16 (bits), grey, palette or interlaced" },
    [JPEG] = { 0, "jpeg", "K", "baseline or progressive" },
    [PATHS] = { 0, "paths", "P",
                "file_path is plain (neither folder nor ending), ext (without folder) or folder "
                "(without ending)" },
    [SPLIT] = { 0, "split", "S",
                "val (transforms_val.json), train-only (nothing else) or times (test times are "
                "those that training lacks: see --hold)" },
    [MISSING] = { 0, "missing", "N",
                  "of the pictures that are listed for training, N are not there" },
    [K_EACH] = { 0, "k-each", NULL, "each picture states its K; of colmap, each camera" },
    [STARTS] = { 0, "starts", NULL,
                 "calibration: clips begin at different times, which cams.json tells" },
    [MASKS] = { 0, "masks", NULL,
                "truth/masks: where training pictures show what moves, or its shadow" },
};

/* Options without a value have none. */
static const char *const expected[TED4_SCENE_N_WAYS] = {
    [BACKGROUND] = "room, white, black or transparent",
    [POINTS] = "surface, box10, none, random or sfm",
    [UNIT] = "a number from 1e-06 to 1e+06",
    [UP] = "y or z",
    [CENTRE] = "X,Y, both from 0 to 1",
    [ALPHA] = "straight or premultiplied",
    [PNG] = "16, grey, palette or interlaced",
    [JPEG] = "baseline or progressive",
    [PATHS] = "plain, ext or folder",
    [SPLIT] = "val, train-only or times",
    [MISSING] = "a whole number from 0 to 1000000",
};

const char *ted4_scene_way_expected(int number)
{
    return expected[number];
}

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
