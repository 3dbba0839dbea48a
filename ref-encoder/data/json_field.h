/* json_field.h - reads fields of a JSON document; error messages name the file and the field.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_JSON_FIELD_H
#define TED4_JSON_FIELD_H

#include <jansson.h>
#include <stddef.h>
#include "data/dataset.h"

/* Parses a file; duplicate keys are refused, and a byte order mark is skipped. The caller must
 * json_decref() the result. Returns NULL with *m "file:line: what" on failure. */
json_t *ted4_json_read(const char *path, ted4_message *m);

/* In all functions below, where ("file: frames[12]" or "file") is the beginning of messages. They
 * return 1 if the field was read, 0 if it is absent, which leaves *v unchanged, and -1 with *m
 * filled if it is of another type or not finite.
 * Reads a number. */
int ted4_json_number(const json_t *object, const char *where, const char *name, double *v,
                     ted4_message *m);

/* Reads a time, and refuses those so large that a difference could be infinite. */
int ted4_json_time(const json_t *object, const char *where, const char *name, double *v,
                   ted4_message *m);

/* Reads a string. *v is borrowed from the object. */
int ted4_json_text(const json_t *object, const char *where, const char *name, const char **v,
                   ted4_message *m);

/* Reads a list of low to high numbers. Nested lists are read in order (a matrix row by row).
 * Returns the number of values instead of 1. */
int ted4_json_numbers(const json_t *object, const char *where, const char *name, double *v,
                      size_t low, size_t high, ted4_message *m);

/* Reads a matrix of 4 rows of 4 numbers. The last row must be 0 0 0 1 and may be left out. v
 * receives the upper 3x4 part, row-major. */
int ted4_json_affine(const json_t *object, const char *where, const char *name, double v[12],
                     ted4_message *m);

/* Reads the field "fps", frames per second, and refuses rates that a header cannot represent
 * (frame_rate.h). *rate is 0 if unknown. Returns as ted4_json_number. */
int ted4_json_rate(const json_t *object, const char *where, double *rate, ted4_message *m);

#endif
