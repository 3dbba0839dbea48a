/* cover_triples.c - counts triples of features in valid vectors. They are reported but are no goal,
 * because most of them occur by chance.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "cover.h"
#include "features.h"

enum { MOST = 64 };

/* All features of all groups, numbered consecutively. */
typedef struct {
    const char *name[MOST];
    size_t group[MOST], n;
} features;

static void number(features *f)
{
    f->n = 0;
    for (size_t g = 0; g < conf_n_feature_groups; g++)
        for (size_t i = 0; i < 5 && conf_feature_groups[g][i] != NULL; i++) {
            if (f->n == MOST)
                conf_die("more than %d features", MOST);
            f->name[f->n] = conf_feature_groups[g][i];
            f->group[f->n++] = g;
        }
}

/* Returns a mask in which bit i is set if the vector has feature i. */
static uint64_t mask_of(const features *f, const json_t *descriptor)
{
    const json_t *const list = json_object_get(descriptor, "features");
    uint64_t mask = 0;

    for (size_t i = 0; i < json_array_size(list); i++)
        for (size_t j = 0; j < f->n; j++)
            if (strcmp(json_string_value(json_array_get(list, i)), f->name[j]) == 0)
                mask |= (uint64_t)1 << j;
    return mask;
}

static int together(const features *f, size_t a, size_t b)
{
    return f->group[a] != f->group[b] && !conf_feature_excludes(f->name[a], f->name[b]);
}

conf_triples conf_cover_triples(const conf_entry *e, size_t n)
{
    uint64_t *mask = conf_alloc(n, sizeof *mask);
    conf_triples t = { 0, 0 };
    features f;

    number(&f);
    for (size_t i = 0; i < n; i++)
        if (strcmp(json_string_value(
                       json_object_get(json_object_get(e[i].descriptor, "expect"), "result")),
                   "valid") == 0)
            mask[i] = mask_of(&f, e[i].descriptor);
    for (size_t a = 0; a < f.n; a++)
        for (size_t b = a + 1; b < f.n; b++)
            for (size_t c = b + 1; together(&f, a, b) && c < f.n; c++) {
                const uint64_t three = (uint64_t)1 << a | (uint64_t)1 << b | (uint64_t)1 << c;
                size_t i = 0;

                if (!together(&f, a, c) || !together(&f, b, c))
                    continue;
                while (i < n && (mask[i] & three) != three)
                    i++;
                t.possible++;
                t.reached += i < n;
            }
    free(mask);
    return t;
}
