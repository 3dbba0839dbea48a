/* similar.h - finds the known name that is most similar to a misspelt one, for "did you mean".
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SIMILAR_H
#define TED4_SIMILAR_H

#include <stddef.h>

typedef struct {
    const char *word; /* borrowed; need not end with a 0 */
    size_t length, distance;
    const char *best; /* borrowed; NULL: no name is similar */
} ted4_similar;

ted4_similar ted4_similar_to(const char *word, size_t length);
/* Makes name the best match if it is closer to the word than all names before. The distance counts
 * letters removed, inserted or replaced, and swapped neighbours. It may be at most a third of the
 * word's length, but 1 is always allowed. */
void ted4_similar_try(ted4_similar *s, const char *name);

#endif
