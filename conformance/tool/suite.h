/* suite.h - the published suite in a folder: descriptors next to files.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_SUITE_H
#define CONF_SUITE_H

#include <jansson.h>
#include "text.h"

#define CONF_SUITE_VERSION "1.0.0"

typedef struct {
    char id[96];
    char path[CONF_PATH];           /* path of the descriptor */
    char file[CONF_PATH];           /* path of the vector, which need not exist */
    json_t *descriptor;             /* owned */
    char hash[CONF_SHORT_HASH + 1]; /* hash of the descriptor's file, as in the manifest */
} conf_entry;

/* Loads every descriptor below a folder, sorted by id. list: a file with one id per line (@NAME
 * includes all ids of another list in the same folder); NULL: all. An id of the list that does not
 * exist gives an entry without a descriptor. Returns an owned array. */
conf_entry *conf_suite_load(const char *folder, const char *list, size_t *n);
void conf_suite_free(conf_entry *e, size_t n);

#endif
