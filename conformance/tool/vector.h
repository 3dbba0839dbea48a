/* vector.h - one vector: its bytes, and the descriptor that says what every decoder has to answer.
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

/* Made from its recipe; suite: the folder of vectors/, where files that are kept lie. 0: our
 * decoder answers something else than what the recipe expects, which is said on stderr. */
int conf_vector_make(conf_vector *v, const conf_recipe *r, const char *suite);
void conf_vector_free(conf_vector *v);

#endif
