/* json_string.h - strings for JSON, which is UTF-8, from what need not be: names of files, and
 * messages with such names or that were cut short.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_JSON_STRING_H
#define TED4_JSON_STRING_H

#include <jansson.h>

/* Returns a string, which the caller owns, with U+FFFD for each byte of text that is not UTF-8; or
 * NULL if there is no memory. */
json_t *ted4_json_string(const char *text);

/* Returns 1 if text is UTF-8. */
int ted4_is_utf8(const char *text);

/* Returns how many bytes of text, at most so many, are whole letters: a precision for %.*s. */
int ted4_whole_letters(const char *text, int most);

#endif
