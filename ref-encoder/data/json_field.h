/* json_field.h - fields of a JSON document with messages that name file and field.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_JSON_FIELD_H
#define TED4_JSON_FIELD_H

#include <jansson.h>
#include <stddef.h>
#include "data/dataset.h"

/* Parses a file; duplicate keys are refused. NULL with *m "file:line: what". json_decref() the
 * result. */
json_t *ted4_json_read(const char *path, ted4_message *m);

/* where, in all of these: "file: frames[12]" or "file", what messages begin with. *v is left
 * alone when the field is absent. 1: read, 0: absent, -1 with *m filled: of another type or not
 * finite. */
int ted4_json_number(const json_t *object, const char *where, const char *name, double *v,
                     ted4_message *m);

/* Borrowed text of a string. */
int ted4_json_text(const json_t *object, const char *where, const char *name, const char **v,
                   ted4_message *m);

/* low to high numbers in a list; lists in the list are read in order (a matrix by rows). Gives
 * how many. */
int ted4_json_numbers(const json_t *object, const char *where, const char *name, double *v,
                      size_t low, size_t high, ted4_message *m);

/* A matrix given as 4 rows (or, when the last is left out, 3) of 4 numbers; the last must be 0 0
 * 0 1. v: its upper 3x4, row-major. */
int ted4_json_affine(const json_t *object, const char *where, const char *name, double v[12],
                     ted4_message *m);

/* Frames a second, field "fps", as a header can say them (frame_rate.h); 0: not known. As
 * ted4_json_number. */
int ted4_json_rate(const json_t *object, const char *where, double *rate, ted4_message *m);

#endif
