/* class_t.h - class T (spec E): thresholds for a query of a stream, by rule, and whether a
 * decoder's records keep them. Everything is computed from the code that the specification prints
 * (tests/support/spec_tolerance.h); nothing of ref-decoder but the tables of annex A takes part.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CLASS_T_H
#define CLASS_T_H

#include <stddef.h>
#include <stdint.h>

enum { CLASS_T_GROUPS = 5 }; /* position, scale, rotation, opacity, colour */

typedef struct {
    uint32_t num, den;
    float camera[3];
} class_t_query;

/* R-TOL-003: powers of two; 0 for a group of which nothing is judged. */
typedef struct {
    size_t n; /* records */
    double peak[CLASS_T_GROUPS], rms[CLASS_T_GROUPS];
} class_t_thresholds;

typedef struct class_t class_t; /* a valid stream, decoded */

/* NULL: the stream is not valid, and *id names the error at *offset; or *id is NULL, as there is no
 * memory. data is not kept. */
class_t *class_t_open(const uint8_t *data, size_t size, const char **id, uint64_t *offset);
void class_t_close(class_t *c); /* NULL is fine */

/* 1, or 0: class X has no result for the query. */
int class_t_bounds(const class_t *c, const class_t_query *q, class_t_thresholds *out);

/* What is said of the T5 string that a decoder gives for a query (J.7), NULL when it gives none:
 * "kept", or the first thing that is wrong: "missing", "count", "not finite", or the name of a
 * group. Where class X has no result because a number is not finite, everything is kept
 * (R-TOL-006). For a time out of range there must be no records: "out of range". */
const char *class_t_judge(const class_t *c, const class_t_query *q, const uint8_t *records,
                          size_t size);

#endif
