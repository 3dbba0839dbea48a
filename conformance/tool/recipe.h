/* recipe.h - the recipes (.rcp) in conformance/recipes: the text from which every vector is made.
 * Grammar: its README.md.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_RECIPE_H
#define CONF_RECIPE_H

#include <stddef.h>

enum { CONF_WORDS = 320 };

/* A line of a vector, after {names} have been replaced and presets put in. */
typedef struct {
    char *text; /* owned: the words lie in it */
    char *word[CONF_WORDS];
    int n;            /* words, at least 1 */
    char *rest;       /* owned: everything behind the first word as it stands */
    const char *file; /* borrowed; where the line comes from */
    int number;
} conf_line;

typedef struct {
    char *id;        /* owned */
    conf_line *line; /* owned */
    size_t n;
    const char *file; /* borrowed: name of its recipe file */
} conf_recipe;

typedef struct {
    conf_recipe *recipe;
    size_t n;
    char **file;
    size_t n_files;
} conf_recipes;

/* All *.rcp of a folder, in the order of their names. Ends the program where one is wrong. */
void conf_recipes_load(conf_recipes *r, const char *folder);
void conf_recipes_free(conf_recipes *r);

/* The first line of that name, or NULL. */
const conf_line *conf_line_find(const conf_recipe *r, const char *name);
/* Ends the program with the line's place. */
_Noreturn void conf_line_bad(const conf_line *l, const char *why);
/* Word i as an integer (decimal or 0x, negative allowed) within [low, high]; ends the program
 * otherwise. */
long long conf_line_number(const conf_line *l, int i, long long low, long long high);

#endif
