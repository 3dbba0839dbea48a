/* budget.h - counts the bytes of each syntax element of a file, from the trace of the decoder.
 * Depends on nothing.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BUDGET_H
#define TED4_BUDGET_H

#include <stddef.h>
#include <stdint.h>

/* Rows are enough for all elements of critical chunks, for TED4_BUDGET_TYPES types of ancillary
 * chunks, whose rows are two each, and for the two of all other types. */
enum {
    TED4_BUDGET_ROWS = 200,
    TED4_BUDGET_TYPES = 50,
    TED4_BUDGET_NAME = 32,
    TED4_HEADER_VALUES = 80
};

/* All elements with the same name in chunks of the same type. */
typedef struct {
    char chunk[8]; /* "HEAD"; "file" before the first chunk; "other": of more ancillary types */
    char element[TED4_BUDGET_NAME];
    uint64_t bytes;
    uint64_t symbols; /* of substreams; 0 for other elements */
} ted4_budget_row;

/* A syntax element of the chunk HEAD. */
typedef struct {
    const char *name;     /* borrowed from the decoder's constants */
    int64_t index, value; /* value: as in the file; a binary32 as its bit pattern */
} ted4_header_value;

/* Must be all zero at the start. */
typedef struct {
    ted4_budget_row row[TED4_BUDGET_ROWS];
    int n_rows, owner; /* owner: row to which the byte at offset belongs */
    int n_types;       /* of ancillary chunks with rows of their own */
    size_t offset;
    ted4_header_value header[TED4_HEADER_VALUES];
    int n_header;
    char chunk[8];  /* type of the current chunk, as in its rows */
    int disordered; /* 1: elements were not in file order, or did not fit in the arrays */
} ted4_budget;

/* A callback for ted4_options.trace, with the budget as trace_user. */
void ted4_budget_trace(void *budget, size_t offset, const char *element, int64_t index,
                       int64_t value);
/* Called after decoding: assigns the rest of the file to the last element. Returns 1 if every byte
 * belongs to exactly one element, else 0. */
int ted4_budget_finish(ted4_budget *b, size_t size);

#endif
