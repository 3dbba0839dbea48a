/* arena.h - the library's memory: every allocation is checked against a budget first. Depends on
 * ted4.h. arena.c is the only file of ref-decoder that calls malloc.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ARENA_H
#define TED4_ARENA_H

#include <stddef.h>
#include <stdint.h>
#include "ted4.h"

struct ted4_arena_block;

/* An arena may be moved by assignment. Only one thread may use it at a time. */
typedef struct ted4_arena {
    ted4_allocator allocator;
    uint64_t used, max;              /* bytes, including headers */
    struct ted4_arena_block *blocks; /* owned, doubly linked */
} ted4_arena;

#define TED4_ARENA_DEFAULT ((uint64_t)1 << 32)

/* Initialises an arena with the allocator and max_bytes of o. If o is NULL, it uses malloc and
 * allows 4 GiB. */
void ted4_arena_init(ted4_arena *a, const ted4_options *o);
/* Returns n zeroed elements of size bytes, aligned to 64 bytes, or NULL if the budget would be
 * exceeded or memory ran out. n = 0 also yields a pointer. n may be an unchecked number from a
 * file, even beyond the address range of this machine. Owned by the arena. */
void *ted4_arena_alloc(ted4_arena *a, uint64_t n, size_t size);
/* Does the same, but leaves the contents undefined. */
void *ted4_arena_alloc_raw(ted4_arena *a, uint64_t n, size_t size);
/* Frees one block; block may be NULL. */
void ted4_arena_release(ted4_arena *a, void *block);
/* Frees all blocks. */
void ted4_arena_finish(ted4_arena *a);

#endif
