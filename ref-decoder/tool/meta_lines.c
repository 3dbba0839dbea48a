/* meta_lines.c - see meta_lines.h. R-SEC-002: control characters in a file must not reach a
 * terminal.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "meta_lines.h"

#include <stdio.h>
#include <string.h>

#include "base/bytes.h"

enum { FILE_HEADER = 12, FRAME_HEAD = 12, FRAME_HASH = 8, MOST = 1000 };

/* The word that selects lines, and where the lines go. */
typedef struct {
    const char *word;
    json_t *list; /* NULL: standard output */
} sink;

static void put(const sink *to, const uint8_t *line, size_t n)
{
    const size_t word = strlen(to->word);
    char text[MOST + 1];

    if (n <= word || memcmp(line, to->word, word) != 0 || (line[word] != '=' && line[word] != '.'))
        return;
    n = n < MOST ? n : MOST;
    for (size_t i = 0; i < n; i++)
        text[i] = (char)(line[i] >= 0x20 && line[i] < 0x7f ? line[i] : '?');
    text[n] = 0;
    if (to->list != NULL)
        json_array_append_new(to->list, json_string(text));
    else
        printf("%s\n", text);
}

static void tell(const sink *to, const uint8_t *data, size_t size)
{
    for (size_t at = FILE_HEADER; at + FRAME_HEAD + FRAME_HASH <= size;) {
        const uint8_t *line = data + at + FRAME_HEAD, *end = line + ted4_load32(data + at + 8);

        for (int is_meta = memcmp(data + at, "META", 4) == 0; is_meta && line < end;) {
            const uint8_t *lf = memchr(line, '\n', (size_t)(end - line));
            const uint8_t *stop = lf != NULL ? lf : end;

            put(to, line, (size_t)(stop - line));
            line = stop < end ? stop + 1 : end;
        }
        at = (size_t)(end - data) + FRAME_HASH;
    }
}

void ted4_meta_lines_print(const uint8_t *data, size_t size, const char *word)
{
    const sink to = { word, NULL };

    tell(&to, data, size);
}

json_t *ted4_meta_lines_json(const uint8_t *data, size_t size, const char *word)
{
    const sink to = { word, json_array() };

    if (to.list != NULL)
        tell(&to, data, size);
    return to.list;
}
