/* arena.h - the memory of the library: every byte is charged against a budget before it is taken.
 * Depends on ted4.h. arena.c is the only file of ref-decoder that calls malloc.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ARENA_H
#define TED4_ARENA_H

#include <stddef.h>
#include <stdint.h>
#include "ted4.h"

struct ted4_arena_block;

/* May be moved by assignment; not safe for use from two threads at once. */
typedef struct ted4_arena {
    ted4_allocator allocator;
    uint64_t used, max;              /* bytes, headers included */
    struct ted4_arena_block *blocks; /* owned, doubly linked */
} ted4_arena;

#define TED4_ARENA_DEFAULT ((uint64_t)1 << 32)

/* o may be NULL: malloc, 4 GiB. */
void ted4_arena_init(ted4_arena *a, const ted4_options *o);
/* n elements of size bytes, zeroed, aligned to 64 bytes. n = 0 gives a pointer too. NULL: over
 * budget, or no memory. n may be a number that a file claims, more than this machine can address.
 */
void *ted4_arena_alloc(ted4_arena *a, uint64_t n, size_t size);
/* The same, with any contents. */
void *ted4_arena_alloc_raw(ted4_arena *a, uint64_t n, size_t size);
/* Gives one block back; NULL is fine. */
void ted4_arena_release(ted4_arena *a, void *block);
/* Gives everything back. */
void ted4_arena_finish(ted4_arena *a);

#endif
