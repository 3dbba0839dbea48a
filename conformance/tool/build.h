/* build.h - builds a scene from the lines of a recipe, and the bytes of a valid file from the
 * scene. Steps: header (build_header.c), networks and bank (build_nets.c), positions and masks
 * (build_anchors.c), symbols (build_symbols.c), deflate (pack.c). All arithmetic is on integers or
 * exact in binary32, so that every machine builds the same file.
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
    int level;         /* 0: the lowest level that fits */
} conf_build;

/* Builds the valid file that the scene lines of the recipe describe. *b then holds the scene; the
 * caller frees it with conf_build_end. */
void conf_build_file(conf_build *b, const conf_recipe *r, conf_bytes *file);
void conf_build_end(conf_build *b);

/* Each function handles its own kinds of lines and ignores the others. */
void conf_build_header(conf_build *b);
void conf_build_nets(conf_build *b);
void conf_build_positions(conf_build *b);
void conf_build_masks(conf_build *b);
void conf_build_symbols(conf_build *b);
void conf_build_pack(conf_build *b);

/* ---- build_words.c ---- */

/* Returns 1 if word i of the line is that text, else 0. */
int conf_word_is(const conf_line *l, int i, const char *text);
/* Parses word i as a binary32: a decimal number, a hexadecimal floating constant of C, or a bit
 * pattern such as :7f800000. */
float conf_word_float(const conf_line *l, int i);
/* Parses word i as a type of value: feature, scaling, offset, phi or tau. */
int conf_word_type(const conf_line *l, int i);
extern const char *const conf_type_name[TED4_TYPES];

/* Returns the index, in the values of NETE, of the bias of a unit. Words i to i + 2 are NET LAYER
 * UNIT. Sets *scale so that B = bias 2^scale. */
size_t conf_bias_index(const conf_build *b, const conf_line *l, int i, int *scale);

/* Returns 1 if the first word of the line is one of the scene lines; all other lines belong to
 * other parts of the tool. */
int conf_is_scene_line(const conf_line *l);

#endif
