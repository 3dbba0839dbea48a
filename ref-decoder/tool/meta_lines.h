/* meta_lines.h - what a file says for people: lines key=value of its chunks META (spec 5.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TOOL_META_LINES_H
#define TED4_TOOL_META_LINES_H

#include <jansson.h>
#include <stddef.h>
#include <stdint.h>

/* Prints, of a file that a decoder accepted, the lines whose key is a word or begins with it and a
 * dot; bytes that are no printable ASCII come out as '?'. */
void ted4_meta_lines_print(const uint8_t *data, size_t size, const char *word);
/* The same as an array of strings. */
json_t *ted4_meta_lines_json(const uint8_t *data, size_t size, const char *word);

#endif
