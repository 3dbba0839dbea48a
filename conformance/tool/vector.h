/* vector.h - one vector: its bytes, and the descriptor with the answer that every decoder must
 * give.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_VECTOR_H
#define CONF_VECTOR_H

#include <jansson.h>
#include "recipe.h"
#include "text.h"

typedef struct {
    conf_bytes file;    /* owned */
    json_t *descriptor; /* owned */
    char folder[64];    /* "valid/header" */
} conf_vector;

/* Makes a vector from its recipe. suite: the folder of vectors/ with the stored files. Returns 0,
 * with a message on stderr, if our decoder answers differently from what the recipe expects, else
 * 1. */
int conf_vector_make(conf_vector *v, const conf_recipe *r, const char *suite);
void conf_vector_free(conf_vector *v);

#endif
