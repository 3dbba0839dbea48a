/* arena.c - implements arena.h. A block consists of padding, a header, and the storage, which is
 * aligned to 64 bytes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "base/arena.h"

#include <stdlib.h>
#include <string.h>

enum { ALIGN = 64 };

typedef struct ted4_arena_block block;
struct ted4_arena_block {
    block *next, *prev;
    void *storage; /* the pointer that the allocator returned */
    size_t size;   /* bytes requested from the allocator */
};

static void *malloc_alloc(void *user, size_t size)
{
    (void)user;
    return malloc(size);
}

static void malloc_free(void *user, void *p)
{
    (void)user;
    free(p);
}

void ted4_arena_init(ted4_arena *a, const ted4_options *o)
{
    static const ted4_allocator standard = { malloc_alloc, malloc_free, NULL };

    memset(a, 0, sizeof *a);
    a->allocator = o != NULL && o->allocator.alloc != NULL ? o->allocator : standard;
    a->max = o != NULL && o->max_bytes != 0 ? o->max_bytes : TED4_ARENA_DEFAULT;
}

/* The header lies directly before the aligned storage. */
static block *header_of(void *p)
{
    return (block *)p - 1;
}

void *ted4_arena_alloc(ted4_arena *a, uint64_t n, size_t size)
{
    void *storage = ted4_arena_alloc_raw(a, n, size);

    if (storage != NULL)
        memset(storage, 0, (size_t)n * size);
    return storage;
}

void *ted4_arena_alloc_raw(ted4_arena *a, uint64_t n, size_t size)
{
    const size_t extra = sizeof(block) + ALIGN;
    block *b;
    size_t total;
    char *storage;

    if (size != 0 && n > (SIZE_MAX - extra) / size)
        return NULL;
    total = (size_t)n * size + extra;
    if (total > a->max - a->used)
        return NULL;
    storage = a->allocator.alloc(a->allocator.user, total);
    if (storage == NULL)
        return NULL;
    b = (block *)(void *)(storage + extra - ((uintptr_t)storage + extra) % ALIGN) - 1;
    b->storage = storage;
    b->size = total;
    b->prev = NULL;
    b->next = a->blocks;
    if (b->next != NULL)
        b->next->prev = b;
    a->blocks = b;
    a->used += total;
    return b + 1;
}

void ted4_arena_release(ted4_arena *a, void *p)
{
    block *b;

    if (p == NULL)
        return;
    b = header_of(p);
    if (b->prev != NULL)
        b->prev->next = b->next;
    else
        a->blocks = b->next;
    if (b->next != NULL)
        b->next->prev = b->prev;
    a->used -= b->size;
    a->allocator.free(a->allocator.user, b->storage);
}

void ted4_arena_finish(ted4_arena *a)
{
    while (a->blocks != NULL)
        ted4_arena_release(a, a->blocks + 1);
}
