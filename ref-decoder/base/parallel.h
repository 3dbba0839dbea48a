/* parallel.h - how a caller lends its threads to the library; the library starts none
 * (SECURITY.md). Results never depend on which thread runs which index.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PARALLEL_H
#define TED4_PARALLEL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* run() calls body(arg, i) once for each i in [0, n), in any order, on any threads, and returns
 * when all are done. */
typedef struct {
    void (*run)(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg);
    void *user;
} ted4_parallel;

/* Calls body(arg, i) for each i in [0, n). p may be NULL: then the calling thread does everything,
 * in order. */
static inline void ted4_parallel_for(const ted4_parallel *p, size_t n,
                                     void (*body)(void *arg, size_t i), void *arg)
{
    if (p != NULL && n > 1) {
        p->run(p->user, n, body, arg);
        return;
    }
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

#ifdef __cplusplus
}
#endif

#endif
