/* scene_ways.h - the options of ted4scene for files as other writers make them: see ray_ways.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef SCENE_WAYS_H
#define SCENE_WAYS_H

#include "ray_ways.h"
#include "tool/arguments.h"

enum { TED4_SCENE_N_WAYS = 16 };

extern const ted4_argument ted4_scene_ways[TED4_SCENE_N_WAYS];

/* Applies the option of that index in ted4_scene_ways. text: its value, or NULL. Returns 0, or -1
 * if text is not a valid value. */
int ted4_scene_way(int number, const char *text, ted4_ray_ways *w);
/* Returns what is expected as the value of that option. */
const char *ted4_scene_way_expected(int number);

#endif
