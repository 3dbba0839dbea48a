/* budget.c - see budget.h. An element owns the bytes from its offset to that of the next element.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "budget.h"

#include <string.h>

/* Returns 1 for the symbols of a substream. They are traced at the substream's first byte, which is
 * counted for the substream. */
static int is_symbol(const char *element)
{
    static const char *const name[] = { "dynamic", "offset_bit", "feature", "scaling",
                                        "offset",  "phi",        "tau" };

    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (strcmp(element, name[i]) == 0)
            return 1;
    return 0;
}

static int ends_in(const char *text, const char *end)
{
    const size_t n = strlen(text), m = strlen(end);

    return n >= m && strcmp(text + n - m, end) == 0;
}

/* Makes the name of a row: the element's name, followed by the number of the slice for a substream
 * of features. */
static void name_row(char name[TED4_BUDGET_NAME], const char *element, int64_t index)
{
    const size_t length = strlen(element);
    size_t n = length < TED4_BUDGET_NAME - 4 ? length : TED4_BUDGET_NAME - 4;

    memcpy(name, element, n);
    if (strcmp(element, "feature_substream") == 0) {
        name[n++] = ' ';
        if (index >= 10)
            name[n++] = (char)('0' + index / 10 % 10);
        name[n++] = (char)('0' + index % 10);
    }
    name[n] = '\0';
}

static int row_of(ted4_budget *b, const char *element, int64_t index)
{
    char name[TED4_BUDGET_NAME];
    int i = 0;

    name_row(name, element, index);
    while (i < b->n_rows &&
           (strcmp(b->row[i].element, name) != 0 || strcmp(b->row[i].chunk, b->chunk) != 0))
        i++;
    if (i == TED4_BUDGET_ROWS) {
        b->disordered = 1;
        return 0;
    }
    if (i == b->n_rows) {
        b->n_rows++;
        memcpy(b->row[i].chunk, b->chunk, sizeof b->chunk);
        memcpy(b->row[i].element, name, sizeof name);
    }
    return i;
}

/* Returns 1 if chunks of the current type have rows of their own. */
static int has_rows(ted4_budget *b)
{
    static const char critical[][5] = { "HEAD", "NETE", "NETR", "BANK", "POSN", "TILE", "ENDS" };

    for (size_t i = 0; i < sizeof critical / sizeof *critical; i++)
        if (strcmp(b->chunk, critical[i]) == 0)
            return 1;
    for (int i = 0; i < b->n_rows; i++)
        if (strcmp(b->row[i].chunk, b->chunk) == 0)
            return 1;
    if (b->n_types == TED4_BUDGET_TYPES)
        return 0;
    b->n_types++;
    return 1;
}

static void begin_chunk(ted4_budget *b, int64_t type)
{
    memset(b->chunk, 0, sizeof b->chunk);
    for (int i = 0; i < 4; i++)
        b->chunk[i] = (char)(type >> 8 * i & 0x7f);
    if (!has_rows(b))
        memcpy(b->chunk, "other", sizeof "other");
}

static void keep_header(ted4_budget *b, const char *element, int64_t index, int64_t value)
{
    if (b->n_header < TED4_HEADER_VALUES)
        b->header[b->n_header++] = (ted4_header_value) { element, index, value };
    else
        b->disordered = 1;
}

void ted4_budget_trace(void *user, size_t offset, const char *element, int64_t index, int64_t value)
{
    ted4_budget *const b = user;
    const int frame = strncmp(element, "chunk_", 6) == 0;

    if (is_symbol(element))
        return;
    if (strcmp(element, "chunk_type") == 0)
        begin_chunk(b, value);
    else if (b->n_rows == 0)
        memcpy(b->chunk, "file", sizeof "file");
    b->disordered |= offset < b->offset || (b->n_rows == 0 && offset != 0);
    if (b->n_rows > 0)
        b->row[b->owner].bytes += offset - b->offset;
    b->offset = offset;
    b->owner = row_of(b, frame ? "frame" : element, index);
    if (ends_in(element, "_substream"))
        b->row[b->owner].symbols += (uint64_t)value;
    if (strcmp(b->chunk, "HEAD") == 0 && !frame)
        keep_header(b, element, index, value);
}

int ted4_budget_finish(ted4_budget *b, size_t size)
{
    uint64_t sum = 0;

    b->disordered |= size < b->offset;
    b->row[b->owner].bytes += size - b->offset;
    b->offset = size;
    for (int i = 0; i < b->n_rows; i++)
        sum += b->row[i].bytes;
    return !b->disordered && sum == size;
}
