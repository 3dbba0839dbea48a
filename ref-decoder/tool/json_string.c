/* json_string.c - see json_string.h. What is UTF-8 is left to jansson to say.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "json_string.h"

#include <stdlib.h>
#include <string.h>

static const char UNKNOWN[] = "\xef\xbf\xbd"; /* U+FFFD */

enum { MOST_BYTES = 4 /* of a letter */, UNKNOWN_BYTES = sizeof UNKNOWN - 1 };

/* Returns the number of bytes of the letter at p, of which left > 0 bytes remain; or 0 if there is
 * none. */
static size_t letter(const char *p, size_t left)
{
    for (size_t n = 1; n <= MOST_BYTES && n <= left; n++) {
        json_t *const s = json_stringn(p, n);

        json_decref(s);
        if (s != NULL)
            return n;
    }
    return 0;
}

json_t *ted4_json_string(const char *text)
{
    const size_t size = strlen(text);
    json_t *whole = json_string(text);
    char *clean;
    size_t n = 0;

    if (whole != NULL || (clean = malloc(UNKNOWN_BYTES * size + 1)) == NULL)
        return whole;
    for (size_t i = 0; i < size;) {
        const size_t bytes = letter(text + i, size - i);

        memcpy(clean + n, bytes > 0 ? text + i : UNKNOWN, bytes > 0 ? bytes : UNKNOWN_BYTES);
        n += bytes > 0 ? bytes : UNKNOWN_BYTES;
        i += bytes > 0 ? bytes : 1;
    }
    whole = json_stringn(clean, n);
    free(clean);
    return whole;
}

int ted4_is_utf8(const char *text)
{
    json_t *const s = json_string(text);

    json_decref(s);
    return s != NULL;
}

int ted4_whole_letters(const char *text, int most)
{
    size_t n = strnlen(text, (size_t)most);

    /* The first byte that is left out may not be one that continues a letter. */
    while (n > 0 && text[n] != '\0' && ((unsigned char)text[n] & 0xc0) == 0x80)
        n--;
    return (int)n;
}
