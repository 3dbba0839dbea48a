/* recipe.h - the recipes (.rcp) in conformance/recipes, the text from which every vector is made.
 * README.md in that folder defines the grammar.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_RECIPE_H
#define CONF_RECIPE_H

#include <stddef.h>

enum { CONF_WORDS = 320 };

/* A line of a vector, after {names} are replaced and presets are expanded. */
typedef struct {
    char *text; /* owned: the storage of the words */
    char *word[CONF_WORDS];
    int n;            /* number of words, at least 1 */
    char *rest;       /* owned: the unchanged text after the first word */
    const char *file; /* borrowed; the origin of the line */
    int number;
} conf_line;

typedef struct {
    char *id;        /* owned */
    conf_line *line; /* owned */
    size_t n;
    const char *file; /* borrowed: the name of its recipe file */
} conf_recipe;

typedef struct {
    conf_recipe *recipe;
    size_t n;
    char **file;
    size_t n_files;
} conf_recipes;

/* Loads all *.rcp of a folder in the order of their names. Ends the program if one of them is
 * wrong. */
void conf_recipes_load(conf_recipes *r, const char *folder);
void conf_recipes_free(conf_recipes *r);

/* Returns the first line of that name, or NULL. */
const conf_line *conf_line_find(const conf_recipe *r, const char *name);
/* Prints the place of the line and ends the program. */
_Noreturn void conf_line_bad(const conf_line *l, const char *why);
/* Parses word i as an integer (decimal or 0x, may be negative) in [low, high]. Ends the program if
 * it is not one. */
long long conf_line_number(const conf_line *l, int i, long long low, long long high);

#endif
