/* meta_lines.c - see meta_lines.h. R-SEC-002: control characters in a file must not reach a
 * terminal.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "meta_lines.h"

#include <stdio.h>
#include <string.h>

#include "chunks.h"

enum { MOST = 1000 }; /* bytes of a line that are shown */

/* The word that selects lines, and where the lines go. */
typedef struct {
    const char *word;
    json_t *list; /* NULL: standard output */
    size_t n;     /* lines so far */
} sink;

static void put(sink *to, const uint8_t *line, size_t n)
{
    const size_t word = strlen(to->word);
    char text[MOST + 1];

    if (n <= word || memcmp(line, to->word, word) != 0 || (line[word] != '=' && line[word] != '.'))
        return;
    n = n < MOST ? n : MOST;
    for (size_t i = 0; i < n; i++)
        text[i] = (char)(line[i] >= 0x20 && line[i] < 0x7f ? line[i] : '?');
    text[n] = 0;
    to->n++;
    if (to->list != NULL)
        json_array_append_new(to->list, json_string(text));
    else
        printf("%s\n", text);
}

static void tell(sink *to, const uint8_t *data, size_t size)
{
    ted4_chunk_view c;

    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(data, size, &at, &c);) {
        const uint8_t *line = c.payload, *const end = line + c.size;

        while (strcmp(c.type, "META") == 0 && line < end) {
            const uint8_t *lf = memchr(line, '\n', (size_t)(end - line));
            const uint8_t *stop = lf != NULL ? lf : end;

            put(to, line, (size_t)(stop - line));
            line = stop < end ? stop + 1 : end;
        }
    }
}

size_t ted4_meta_lines_print(const uint8_t *data, size_t size, const char *word)
{
    sink to = { .word = word };

    tell(&to, data, size);
    return to.n;
}

json_t *ted4_meta_lines_json(const uint8_t *data, size_t size, const char *word)
{
    sink to = { word, json_array(), 0 };

    if (to.list != NULL)
        tell(&to, data, size);
    return to.list;
}
