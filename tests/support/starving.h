/* starving.h - makes allocations fail in everything that is linked into a test: a single one, or
 * all from one on. The linker wraps the functions (-Wl,--wrap); each such test is a program of its
 * own.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STARVING_H
#define TED4_STARVING_H

#include <stddef.h>

#include "test.h"

void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__real_realloc(void *block, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *block, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

static struct {
    int on, fail_on;
    size_t n, fail_at;
} wrapped;

static inline int fails(void)
{
    if (!wrapped.on)
        return 0;
    wrapped.n++;
    return wrapped.n == wrapped.fail_at || (wrapped.fail_on && wrapped.n > wrapped.fail_at);
}

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t n, size_t size)
{
    return fails() ? NULL : __real_calloc(n, size);
}

void *__wrap_realloc(void *block, size_t size)
{
    return fails() ? NULL : __real_realloc(block, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return fails() ? NULL : __real_aligned_alloc(alignment, size);
}

/* From now on, allocation number n fails and, if fail_on is set, so do all that follow. */
static inline void starve(size_t n, int fail_on)
{
    wrapped.fail_at = n;
    wrapped.fail_on = fail_on;
    wrapped.n = 0;
    wrapped.on = 1;
}

/* Ends the failures. Returns whether an allocation failed. */
static inline int feed(void)
{
    wrapped.on = 0;
    return wrapped.n >= wrapped.fail_at;
}

/* Calls deed with n = 1, 2, ... until it returns that no allocation failed: first with single
 * failures, then with all allocations from n on failing. */
static inline void starve_each(int (*deed)(size_t n, int fail_on))
{
    for (int fail_on = 0; fail_on < 2; fail_on++) {
        size_t n = 1;

        while (deed(n, fail_on))
            n++;
        assert_true(n > 3);
    }
}

#endif
