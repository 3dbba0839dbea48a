/* scene_ways.h - options of ted4scene for what other writers do: ray_ways.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef SCENE_WAYS_H
#define SCENE_WAYS_H

#include <getopt.h>

#include "ray_ways.h"

/* Their lines of the help. */
extern const char ted4_scene_ways_help[];

/* Numbers of long options are from here on; below are letters. */
enum { TED4_SCENE_WAYS = 256, TED4_SCENE_N_WAYS = 16 };

/* For getopt_long. */
extern const struct option ted4_scene_ways[TED4_SCENE_N_WAYS];

/* Takes the option of that number. 0, or -1: text is not what goes with it. */
int ted4_scene_way(int number, const char *text, ted4_ray_ways *w);

#endif
