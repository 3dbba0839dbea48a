/* header_check.c - checks and compares headers by the elements that a file would hold
 * (header_from_options.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "header_from_options.h"

#include <string.h>

#include "norm/limits.h"
#include "write/coder_count.h"

enum { MAX_ELEMENTS = 96 };

/* The elements of a header, in the order of the file. */
typedef struct {
    size_t n;
    int64_t value[MAX_ELEMENTS];
    const char *last; /* static text: name of the last element that was walked */
} elements;

static void note_element(void *user, size_t offset, const char *element, int64_t index,
                         int64_t value)
{
    elements *e = user;

    (void)offset;
    (void)index;
    e->last = element;
    if (e->n < MAX_ELEMENTS)
        e->value[e->n++] = value;
}

/* Lists the elements of h. Returns 0, or -1 if the format does not allow this header; e->last then
 * names the wrong element, because a walk traces nothing after an error. */
static int walk(const ted4_header *h, elements *e)
{
    ted4_header whole = *h;
    ted4_shape shape;
    ted4_counter c;

    whole.n_anchors = 1;
    memset(e, 0, sizeof *e);
    ted4_counter_init(&c);
    c.base.trace = note_element;
    c.base.trace_user = e;
    ted4_walk_header(&c.base, &whole, &shape, TED4_LEVEL_UNBOUNDED, UINT64_MAX);
    return c.base.error.code == TED4_OK ? 0 : -1;
}

const char *ted4_header_wrong(const ted4_header *h)
{
    elements e;

    return walk(h, &e) == 0 ? NULL : e.last;
}

int ted4_header_same(const ted4_header *a, const ted4_header *b)
{
    elements x, y;

    return walk(a, &x) == 0 && walk(b, &y) == 0 && x.n == y.n &&
           memcmp(x.value, y.value, x.n * sizeof *x.value) == 0;
}
