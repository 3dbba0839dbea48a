/* meta_lines.h - prints text for human readers that a file contains: the lines key=value of its
 * chunks META (spec 5.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TOOL_META_LINES_H
#define TED4_TOOL_META_LINES_H

#include <jansson.h>
#include <stddef.h>
#include <stdint.h>

/* Prints the lines whose key is word, or begins with word and a dot, and returns their number. The
 * file must be one that a decoder accepted. Bytes that are not UTF-8, or belong to characters that
 * are not seen, are replaced by '?'. */
size_t ted4_meta_lines_print(const uint8_t *data, size_t size, const char *word);
/* Returns the same lines as a new array of strings. */
json_t *ted4_meta_lines_json(const uint8_t *data, size_t size, const char *word);

#endif
