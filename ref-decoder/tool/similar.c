/* similar.c - see similar.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "similar.h"

#include <string.h>

enum { LONGEST = 40 };

ted4_similar ted4_similar_to(const char *word, size_t length)
{
    const size_t most = length / 3 > 1 ? length / 3 : 1;

    return (ted4_similar) { word, length, most + 1, NULL };
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Returns the number of edits that turn a into b, where swapping two neighbours is one edit. */
static size_t edits(const char *a, size_t n, const char *b, size_t m)
{
    size_t d[LONGEST + 1][LONGEST + 1];

    for (size_t i = 0; i <= n; i++)
        for (size_t j = 0; j <= m; j++) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            d[i][j] = least(least(d[i - 1][j], d[i][j - 1]) + 1,
                            d[i - 1][j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[n][m];
}

void ted4_similar_try(ted4_similar *s, const char *name)
{
    const size_t n = strlen(name);

    if (n > LONGEST || s->length > LONGEST)
        return;

    const size_t distance = edits(s->word, s->length, name, n);

    if (distance < s->distance) {
        s->distance = distance;
        s->best = name;
    }
}
