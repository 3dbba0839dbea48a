/* scene_ways.h - the options of ted4scene for files as other writers make them: see ray_ways.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef SCENE_WAYS_H
#define SCENE_WAYS_H

#include <getopt.h>

#include "ray_ways.h"

/* The lines of the help for these options. */
extern const char ted4_scene_ways_help[];

/* The numbers of long options begin here; smaller numbers are letters. */
enum { TED4_SCENE_WAYS = 256, TED4_SCENE_N_WAYS = 16 };

/* The options for getopt_long. */
extern const struct option ted4_scene_ways[TED4_SCENE_N_WAYS];

/* Applies the option of that number. Returns 0, or -1 if text is not a valid value. */
int ted4_scene_way(int number, const char *text, ted4_ray_ways *w);

#endif
