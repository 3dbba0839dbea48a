/* build.h - from the lines of a recipe to a scene, and to the bytes of a valid file.
 * Steps: header (build_header.c), networks and bank (build_nets.c), positions and masks
 * (build_anchors.c), symbols (build_symbols.c), deflate (pack.c). Everything is integers or exact
 * binary32, so every machine builds the same.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_BUILD_H
#define CONF_BUILD_H

#include "chance.h"
#include "norm/scene.h"
#include "recipe.h"
#include "text.h"

typedef struct {
    const conf_recipe *recipe;
    conf_chance chance;
    ted4_header head;
    ted4_scene *scene; /* owned */
    int level;         /* 0: the lowest that fits */
} conf_build;

/* The valid file that the recipe's scene lines describe; *b then holds the scene, to be ended with
 * conf_build_end. */
void conf_build_file(conf_build *b, const conf_recipe *r, conf_bytes *file);
void conf_build_end(conf_build *b);

/* What the lines say, each kind for itself. A line that a function does not know it leaves alone.
 */
void conf_build_header(conf_build *b);
void conf_build_nets(conf_build *b);
void conf_build_positions(conf_build *b);
void conf_build_masks(conf_build *b);
void conf_build_symbols(conf_build *b);
void conf_build_pack(conf_build *b);

/* ---- build_words.c ---- */

/* 1: word i of the line is that text. */
int conf_word_is(const conf_line *l, int i, const char *text);
/* Word i: a binary32 in decimal, as C's hexadecimal floating constant, or as :7f800000, a pattern.
 */
float conf_word_float(const conf_line *l, int i);
/* Word i: one of feature, scaling, offset, phi, tau. */
int conf_word_type(const conf_line *l, int i);
extern const char *const conf_type_name[TED4_TYPES];

/* Index in NETE's values of the bias of a unit: words i to i + 2 are NET LAYER UNIT. *scale: B =
 * bias 2^scale. */
size_t conf_bias_index(const conf_build *b, const conf_line *l, int i, int *scale);

/* The words of scene lines: every other first word belongs to another part of the tool. */
int conf_is_scene_line(const conf_line *l);

#endif
