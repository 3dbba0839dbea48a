/* thread_start.h - starts a thread with a stack that is large enough on every system. A header
 * alone, so that libraries and tools that link nothing else of this folder can use it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_THREAD_START_H
#define TED4_THREAD_START_H

#include <pthread.h>

/* Bytes. The largest frame of any function has 131,200 (gcc -fstack-usage), and calls of the
 * decoder library take up to 256 KiB (SECURITY.md), but musl gives a thread 128 KiB if nothing is
 * said. */
enum { TED4_THREAD_STACK = 1 << 20 };

/* As pthread_create with default attributes, but for the stack, which has at least
 * TED4_THREAD_STACK bytes. Returns 0, or an error number. */
static inline int ted4_thread_start(pthread_t *thread, void *(*body)(void *), void *arg)
{
    pthread_attr_t attributes;
    size_t size = 0;
    int error = pthread_attr_init(&attributes);

    if (error != 0)
        return error;
    if (pthread_attr_getstacksize(&attributes, &size) == 0 && size < TED4_THREAD_STACK)
        error = pthread_attr_setstacksize(&attributes, TED4_THREAD_STACK);
    if (error == 0)
        error = pthread_create(thread, &attributes, body, arg);
    pthread_attr_destroy(&attributes);
    return error;
}

#endif
