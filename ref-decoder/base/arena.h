/* arena.h - the memory of the library: every byte is charged against a budget before it is taken.
 * Depends on ted4.h. arena.c is the only file of ref-decoder that calls malloc.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ARENA_H
#define TED4_ARENA_H

#include <stddef.h>
#include <stdint.h>
#include "ted4.h"

struct ted4_arena_block;

/* It may be moved by assignment. Only one thread may use it at a time. */
typedef struct ted4_arena {
    ted4_allocator allocator;
    uint64_t used, max;              /* bytes, headers included */
    struct ted4_arena_block *blocks; /* owned, doubly linked */
} ted4_arena;

#define TED4_ARENA_DEFAULT ((uint64_t)1 << 32)

/* Initialises an arena with the allocator and max_bytes of o. If o is NULL: malloc, and at most 4
 * GiB. */
void ted4_arena_init(ted4_arena *a, const ted4_options *o);
/* Returns n zeroed elements of size bytes, aligned to 64 bytes; n = 0 gives a pointer too. Returns
 * NULL if the budget is exceeded or there is no memory. n may be a number that a file claims, more
 * than this machine can address. */
void *ted4_arena_alloc(ted4_arena *a, uint64_t n, size_t size);
/* The same, but the contents are undefined. */
void *ted4_arena_alloc_raw(ted4_arena *a, uint64_t n, size_t size);
/* Frees one block; block may be NULL. */
void ted4_arena_release(ted4_arena *a, void *block);
/* Frees everything. */
void ted4_arena_finish(ted4_arena *a);

#endif
