/* heap.c - malloc and free over the linear memory: one list of free blocks in the order of their
 * addresses, first fit, neighbours joined. The decoder takes few, large blocks (base/arena.h), so
 * that a list is short. Blocks are aligned to 16 bytes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdint.h>
#include <stdlib.h>

enum { ALIGN = 16, PAGE = 65536 };

/* In front of every block. next: of free blocks only. */
typedef struct block {
    size_t size; /* bytes, this head included; a multiple of ALIGN */
    struct block *next;
    uint64_t unused;
} block;

_Static_assert(sizeof(block) == ALIGN, "blocks stay aligned");

extern unsigned char __heap_base; /* set by the linker: the first byte behind static data */
static block *first_free;
static uintptr_t heap_end; /* of what belongs to the heap; 0: nothing does yet */

/* Puts a block among the free ones, joined with the neighbours that are free. */
static void give(block *b)
{
    block *before = NULL, *after = first_free;

    while (after != NULL && after < b) {
        before = after;
        after = after->next;
    }
    b->next = after;
    if (after != NULL && (uintptr_t)b + b->size == (uintptr_t)after) {
        b->size += after->size;
        b->next = after->next;
    }
    if (before == NULL) {
        first_free = b;
    } else if ((uintptr_t)before + before->size == (uintptr_t)b) {
        before->size += b->size;
        before->next = b->next;
    } else {
        before->next = b;
    }
}

/* Lets the memory grow by at least size bytes. 0, or -1: the machine has no more. */
static int grow(size_t size)
{
    const size_t pages = (size + PAGE - 1) / PAGE;

    if (heap_end == 0) {
        const uintptr_t start = ((uintptr_t)&__heap_base + ALIGN - 1) / ALIGN * ALIGN;

        heap_end = __builtin_wasm_memory_size(0) * (uintptr_t)PAGE;
        if (heap_end > start) {
            block *b = (block *)start;

            b->size = heap_end - start;
            give(b);
        }
    }
    if (pages > 65536 || __builtin_wasm_memory_grow(0, pages) == (size_t)-1)
        return -1;

    block *b = (block *)heap_end;

    b->size = pages * PAGE;
    heap_end += pages * PAGE;
    give(b);
    return 0;
}

/* Takes size bytes out of the first free block that has them, or gives NULL. */
static block *take(size_t size)
{
    block **link = &first_free;

    while (*link != NULL && (*link)->size < size)
        link = &(*link)->next;

    block *b = *link;

    if (b == NULL)
        return NULL;
    if (b->size - size < 2 * ALIGN) {
        *link = b->next;
        return b;
    }

    block *rest = (block *)((uintptr_t)b + size);

    rest->size = b->size - size;
    rest->next = b->next;
    *link = rest;
    b->size = size;
    return b;
}

void *malloc(size_t size)
{
    if (size > SIZE_MAX - 2 * ALIGN - PAGE)
        return NULL;

    const size_t whole = (size + ALIGN - 1) / ALIGN * ALIGN + ALIGN;
    block *b = take(whole);

    if (b == NULL && grow(whole) == 0)
        b = take(whole);
    return b != NULL ? b + 1 : NULL;
}

void free(void *p)
{
    if (p != NULL)
        give((block *)p - 1);
}
