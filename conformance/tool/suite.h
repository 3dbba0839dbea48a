/* suite.h - the published suite as it lies in a folder: descriptors next to files.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_SUITE_H
#define CONF_SUITE_H

#include <jansson.h>
#include "text.h"

#define CONF_SUITE_VERSION "1.0.0"

typedef struct {
    char id[96];
    char path[CONF_PATH];           /* of the descriptor */
    char file[CONF_PATH];           /* of the vector; need not exist */
    json_t *descriptor;             /* owned */
    char hash[CONF_SHORT_HASH + 1]; /* of the descriptor's file, as the manifest has it */
} conf_entry;

/* Every descriptor below a folder, sorted by id; list: a file with an id a line (@NAME: all of
 * another list beside it), NULL: all. An id of the list that is not there gives an entry without a
 * descriptor. An owned array. */
conf_entry *conf_suite_load(const char *folder, const char *list, size_t *n);
void conf_suite_free(conf_entry *e, size_t n);

#endif
