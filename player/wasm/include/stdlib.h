/* stdlib.h - what the decoder takes of ISO C 7.22, for wasm32 without an operating system: the heap
 * (heap.c), and an environment that is empty.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_WASM_STDLIB_H
#define TED4_WASM_STDLIB_H

#include <stddef.h>

void *malloc(size_t size);
void free(void *block);

static inline char *getenv(const char *name)
{
    (void)name;
    return NULL;
}

#endif
