/* counting.h - a caller's allocator that counts, limits and fails. fz_decode and fz_alloc_fail use
 * it to observe memory.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_COUNTING_H
#define TED4_FUZZ_COUNTING_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "ted4.h"

/* If all members are zero, no allocation fails. */
typedef struct {
    uint64_t held, most; /* bytes held now, and their maximum so far */
    uint64_t n, fail_at; /* allocations so far; the one that fails, from 1, or 0: none */
    int fail_on;         /* all later allocations fail too */
} counting_memory;

enum { COUNTING_HEADER = 16 };

static inline void *counting_alloc(void *user, size_t size)
{
    counting_memory *m = user;
    char *p;

    m->n++;
    if (m->fail_at > 0 && (m->n == m->fail_at || (m->fail_on && m->n > m->fail_at)))
        return NULL;
    p = malloc(size + COUNTING_HEADER);
    if (p == NULL)
        return NULL;
    memcpy(p, &size, sizeof size);
    m->held += size;
    m->most = m->held > m->most ? m->held : m->most;
    return p + COUNTING_HEADER;
}

static inline void counting_free(void *user, void *block)
{
    counting_memory *m = user;
    size_t size;

    memcpy(&size, (char *)block - COUNTING_HEADER, sizeof size);
    m->held -= size;
    free((char *)block - COUNTING_HEADER);
}

static inline ted4_allocator counting_allocator(counting_memory *m)
{
    return (ted4_allocator) { counting_alloc, counting_free, m };
}

#endif
