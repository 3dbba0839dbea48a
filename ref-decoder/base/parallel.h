/* parallel.h - the interface by which a caller lends its threads to the library, which starts none
 * itself (SECURITY.md). Results never depend on which thread runs which index.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PARALLEL_H
#define TED4_PARALLEL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* run(user, n, body, arg) calls body(arg, i) exactly once for each i in [0, n), in any order and on
 * any threads, and returns when all calls have returned. */
typedef struct {
    void (*run)(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg);
    void *user;
} ted4_parallel;

/* Calls body(arg, i) for each i in [0, n). If p is NULL, the calling thread makes all calls, in
 * order. */
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
