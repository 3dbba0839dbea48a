/* order.h - choices on which no result may depend: the order in which the indices of a parallel-for
 * run, and the kernels that run.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_ORDER_H
#define TED4_FUZZ_ORDER_H

#include <stddef.h>
#include "base/parallel.h"
#include "use_kernels.h"

static inline void order_forward(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

static inline void order_backward(void *user, size_t n, void (*body)(void *arg, size_t i),
                                  void *arg)
{
    (void)user;
    for (size_t i = n; i > 0; i--)
        body(arg, i - 1);
}

/* Runs the odd indices first. */
static inline void order_split(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
    for (size_t i = 1; i < n; i += 2)
        body(arg, i);
    for (size_t i = 0; i < n; i += 2)
        body(arg, i);
}

/* which: 1 in order, 2 backwards, any other value odd indices first. */
static inline ted4_parallel order_parallel(int which)
{
    return (ted4_parallel) { which == 1   ? order_forward
                             : which == 2 ? order_backward
                                          : order_split,
                             NULL };
}

#endif
