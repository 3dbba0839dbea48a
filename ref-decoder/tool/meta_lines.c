/* meta_lines.c - see meta_lines.h. R-SEC-002: control characters in a file must not reach a
 * terminal, nor characters that are not seen, or that turn the text around.
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

typedef struct {
    uint32_t first, last;
} range;

/* Code points that are not shown: marks without width, of direction, of lines; byte order marks and
 * other special ones; tags; surrogates, which UTF-8 does not have. */
static const range UNSEEN[] = {
    { 0x00ad, 0x00ad }, { 0x061c, 0x061c }, { 0x200b, 0x200b },   { 0x200e, 0x200f },
    { 0x2028, 0x202e }, { 0x2060, 0x206f }, { 0xd800, 0xdfff },   { 0xfeff, 0xfeff },
    { 0xfff0, 0xfffb }, { 0xfffe, 0xffff }, { 0xe0000, 0xe0fff }, { 0x110000, UINT32_MAX }
};

static int is_seen(uint32_t code)
{
    for (size_t i = 0; i < sizeof UNSEEN / sizeof *UNSEEN; i++)
        if (code >= UNSEEN[i].first && code <= UNSEEN[i].last)
            return 0;
    return 1;
}

/* Returns the number of bytes of the character of UTF-8 at p, of which left > 0 bytes remain; 0 if
 * there is none, or none that is shown. */
static size_t character(const uint8_t *p, size_t left)
{
    /* By its number of bytes: the least code point, and the bits that the first byte begins with.
     */
    static const uint32_t least[5] = { 0, 0, 0xa0, 0x800, 0x10000 };
    static const uint8_t mark[5] = { 0, 0, 0xc0, 0xe0, 0xf0 };
    size_t n = 4;
    uint32_t code;

    if (p[0] < 0x80)
        return p[0] >= 0x20 && p[0] < 0x7f;
    while (n > 1 && (p[0] & (0xf8 << (4 - n) & 0xff)) != mark[n])
        n--;
    if (n == 1 || n > left)
        return 0;
    code = p[0] & (0x7fu >> n);
    for (size_t i = 1; i < n; i++) {
        if ((p[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (p[i] & 0x3f);
    }
    return code >= least[n] && is_seen(code) ? n : 0;
}

static void put(sink *to, const uint8_t *line, size_t n)
{
    const size_t word = strlen(to->word);
    char text[MOST + 1];

    if (n <= word || memcmp(line, to->word, word) != 0 || (line[word] != '=' && line[word] != '.'))
        return;
    n = n < MOST ? n : MOST;
    memset(text, '?', n);
    for (size_t i = 0; i < n;) {
        const size_t bytes = character(line + i, n - i);

        memcpy(text + i, line + i, bytes);
        i += bytes > 0 ? bytes : 1;
    }
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
