/* adapter.h - the contract of conformance/README.md for a decoder that is a library: fill a
 * ted4_adapter, call ted4_adapter_main from main, link adapter.c and ref-decoder/tool/sha256.c. C11
 * and its standard library, nothing else. ours.c is an example.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ADAPTER_H
#define TED4_ADAPTER_H

#include <stddef.h>
#include <stdint.h>

/* What a decoder says of a file. */
typedef struct {
    const char *result; /* "valid", "invalid", "limit" or "unsupported" */
    const char *error;  /* identifier of chapter 14, a constant; not looked at when valid */
    uint64_t offset;    /* of invalid and unsupported */
} ted4_adapter_verdict;

/* Takes pieces of a byte string, in order. */
typedef void ted4_adapter_sink(void *user, const void *bytes, size_t size);

typedef struct {
    const char *name, *version;
    int max_level;             /* 1 .. 4, 31 */
    int class_x;               /* 1: class X; 0: no T5 */
    int bounded, bounded_work; /* 1: decode keeps max_bytes, max_work; else vectors that need that
                                  knob are left out */
    /* data stays until release. max_bytes: of memory; max_work: of steps (spec 13.4); 0: no bound.
     * Of a valid file a scene that is not NULL, of another one NULL. */
    void *(*decode)(const uint8_t *data, size_t size, uint64_t max_bytes, uint64_t max_work,
                    ted4_adapter_verdict *v);
    /* T0 to T4 of annex J. 0, or -1: no memory. */
    int (*tier)(void *scene, int tier, ted4_adapter_sink *sink, void *user);
    /* T5 of a query: NULL, or the identifier of why it has no result. May be NULL without class X.
     */
    const char *(*query)(void *scene, uint32_t num, uint32_t den, const float camera[3],
                         ted4_adapter_sink *sink, void *user);
    void (*release)(void *scene);
} ted4_adapter;

/* Exit code for main: 0 answered; 3 wrong usage, no memory. */
int ted4_adapter_main(const ted4_adapter *a, int argc, char **argv);

#endif
