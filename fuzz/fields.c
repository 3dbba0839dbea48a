/* fields.c - see fields.h. A field ends where the next one begins.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "fields.h"

#include "harness.h"
#include "ted4.h"

typedef struct {
    fuzz_field *fields;
    size_t n, most;
    size_t at; /* offset of the last element met */
} gatherer;

static void gather(void *user, size_t offset, const char *element, int64_t index, int64_t value)
{
    gatherer *g = user;
    const size_t width = offset - g->at;

    (void)element;
    (void)index;
    (void)value;
    if (offset > g->at && (width == 1 || width == 2 || width == 4 || width == 8) && g->n < g->most)
        g->fields[g->n++] = (fuzz_field) { g->at, (unsigned)width };
    g->at = offset;
}

size_t fuzz_fields(const uint8_t *data, size_t size, fuzz_field *fields, size_t most)
{
    gatherer g = { fields, 0, most, 0 };
    const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES, .trace = gather, .trace_user = &g };
    ted4_scene *s = NULL;

    (void)ted4_decode(data, size, &o, &s, NULL);
    ted4_scene_free(s);
    return g.n;
}
