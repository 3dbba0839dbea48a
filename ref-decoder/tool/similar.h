/* similar.h - the name that somebody may have meant who wrote another.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SIMILAR_H
#define TED4_SIMILAR_H

#include <stddef.h>

typedef struct {
    const char *word; /* borrowed; need not end */
    size_t length, distance;
    const char *best; /* borrowed; NULL: nothing is like it */
} ted4_similar;

ted4_similar ted4_similar_to(const char *word, size_t length);
/* Takes name if none before was as much like the word: letters left out, put in, changed, or two in
 * turn. Names a third of whose letters differ are not like it. */
void ted4_similar_try(ted4_similar *s, const char *name);

#endif
