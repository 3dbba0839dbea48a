/* json_line.h - a JSON object as one line of text, made member by member. A real number that is not
 * finite becomes null, as JSON has no other word for it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_JSON_LINE_H
#define TED4_JSON_LINE_H

#include <stddef.h>
#include <stdio.h>

typedef struct {
    FILE *file; /* NULL: no memory */
    char *text; /* owned; valid after ted4_json_line_end */
    size_t size;
    int first; /* 1: the next member is the first one of its object, or element of its array */
} ted4_json_line;

void ted4_json_line_begin(ted4_json_line *l);
/* Ends the line with a line feed. Returns 0, or -1 if there was no memory. */
int ted4_json_line_end(ted4_json_line *l);
void ted4_json_line_free(ted4_json_line *l);

/* Add a member or, in an array, where name is NULL, an element: with a value that is formatted as
 * by printf, a number with so many decimals, or one with so many significant digits. */
void ted4_json_line_put(ted4_json_line *l, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void ted4_json_line_fixed(ted4_json_line *l, const char *name, int decimals, double x);
void ted4_json_line_digits(ted4_json_line *l, const char *name, int digits, double x);
/* Begins and ends a member that is an object, "{" and "}", or an array, "[" and "]". */
void ted4_json_line_open(ted4_json_line *l, const char *name, const char *bracket);
void ted4_json_line_close(ted4_json_line *l, const char *bracket);

#endif
