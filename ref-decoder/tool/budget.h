/* budget.h - which syntax element each byte of a file belongs to, gathered from the trace of the
 * decoder. Depends on nothing.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BUDGET_H
#define TED4_BUDGET_H

#include <stddef.h>
#include <stdint.h>

enum { TED4_BUDGET_ROWS = 160, TED4_BUDGET_NAME = 32, TED4_HEADER_VALUES = 80 };

/* All elements of one name in chunks of one type. */
typedef struct {
    char chunk[8]; /* "HEAD"; "file" before the first chunk */
    char element[TED4_BUDGET_NAME];
    uint64_t bytes;
    uint64_t symbols; /* of substreams, else 0 */
} ted4_budget_row;

/* An element of the header. */
typedef struct {
    const char *name;     /* borrowed from the decoder's constants */
    int64_t index, value; /* value: as in the file; a binary32 is its pattern */
} ted4_header_value;

/* All zero is a good start. */
typedef struct {
    ted4_budget_row row[TED4_BUDGET_ROWS];
    int n_rows, owner; /* owner: row of the byte at offset */
    size_t offset;
    ted4_header_value header[TED4_HEADER_VALUES];
    int n_header;
    char chunk[8];  /* type of the chunk under way */
    int disordered; /* elements were not in file order, or were too many to keep */
} ted4_budget;

/* For ted4_options.trace, with the budget as trace_user. */
void ted4_budget_trace(void *budget, size_t offset, const char *element, int64_t index,
                       int64_t value);
/* After decoding: gives the last element the rest of the file. 1 when every byte has exactly one
 * owner, else 0. */
int ted4_budget_finish(ted4_budget *b, size_t size);

#endif
