/* mdoc.c - text in the language of manual pages, mdoc(7). See pages.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "pages.h"

enum { COLUMNS = 78 };

/* Characters that would be instructions or typographic signs, but for an escape. */
static const char signs[] = "\\-'`^~\"";

/* Returns a bound of the bytes that are written for a word of n bytes. */
static size_t most_bytes(const char *word, size_t n)
{
    enum { ESCAPE = 3 }; /* bytes of an escape beyond the first one */
    size_t bytes = n;

    for (size_t i = 0; i < n; i++)
        bytes += strchr(signs, word[i]) != NULL ? ESCAPE : 0;
    return bytes;
}

/* Writes one character, with an escape where it needs one. */
static void put(FILE *f, char c, int at_start)
{
    static const char *const names[] = {
        "\\e", "\\-", "\\(aq", "\\(ga", "\\(ha", "\\(ti", "\\(dq"
    };
    const char *const sign = c != '\0' ? strchr(signs, c) : NULL;

    if (at_start && c == '.')
        fputs("\\&", f);
    if (sign != NULL)
        fputs(names[sign - signs], f);
    else
        fputc(c, f);
}

void ted4_mdoc_word(FILE *f, const char *text, size_t n)
{
    for (size_t i = 0; i < n; i++)
        put(f, text[i], i == 0);
}

/* Writes a word of prose: only a dash that begins an option is no hyphen. */
static void prose(FILE *f, const char *word, size_t n, int at_start)
{
    int dashes = 1;

    for (size_t i = 0; i < n; i++) {
        dashes = dashes && strchr("-(\"'", word[i]) != NULL;
        if (word[i] == '-' && !dashes)
            fputc('-', f);
        else
            put(f, word[i], at_start && i == 0);
    }
}

static int ends_sentence(const char *word, size_t n)
{
    return strchr(".!?", word[n - 1]) != NULL || (n > 1 && strncmp(word + n - 2, ".)", 2) == 0);
}

void ted4_mdoc_text(FILE *f, const char *text, size_t n)
{
    static const char blanks[] = " \n";
    const char *const end = text + n;
    size_t column = 0;

    while (text < end) {
        if (strchr(blanks, *text) != NULL) {
            text++;
            continue;
        }
        size_t length = strcspn(text, blanks);

        if (length > (size_t)(end - text))
            length = (size_t)(end - text);
        const size_t bytes = most_bytes(text, length);

        if (column > 0 && column + 1 + bytes > COLUMNS) {
            fputc('\n', f);
            column = 0;
        } else if (column > 0) {
            fputc(' ', f);
            column++;
        }
        prose(f, text, length, column == 0);
        column += bytes;
        if (ends_sentence(text, length)) {
            fputc('\n', f);
            column = 0;
        }
        text += length;
    }
    if (column > 0)
        fputc('\n', f);
}

void ted4_mdoc_literal(FILE *f, const char *text, size_t n)
{
    for (size_t i = 0; i < n; i++)
        put(f, text[i], i == 0 || text[i - 1] == '\n');
    if (n > 0 && text[n - 1] != '\n')
        fputc('\n', f);
}
