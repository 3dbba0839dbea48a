/* fz_validate.c - any bytes, given to the validator and to the strict decoder. Claims: both return
 * the same verdict; the findings contain an error exactly if the file is refused, and the first
 * error has the identifier and offset of the decoder's; every finding has an identifier, its rules,
 * and a place inside the file; a second run gives the same findings in the same order; all memory
 * is freed.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include <xxhash.h>
#include "counting.h"
#include "harness.h"
#include "fix_hashes.h"

enum { TAIL = 3 };

/* The findings that a sink received. */
typedef struct {
    size_t size; /* size of the file */
    uint64_t n, errors;
    const char *first; /* identifier of the first error */
    size_t first_at;
    XXH64_hash_t hash;
} gathered;

static void sink(void *user, const ted4_finding *f)
{
    gathered *g = user;
    const int64_t what[4] = { (int64_t)f->offset, f->severity, f->n_values > 0 ? f->value[0] : 0,
                              f->n_values > 1 ? f->value[1] : 0 };

    fuzz_require(f->id != NULL && strchr(f->id, '.') != NULL && f->text != NULL && f->text[0] != 0,
                 "a finding says what it is");
    fuzz_require(f->rule != NULL && f->n_values <= 2, "its rule and values");
    fuzz_require(f->severity == TED4_ERROR || f->severity == TED4_WARNING ||
                     f->severity == TED4_HINT,
                 "its severity");
    fuzz_require(f->offset <= g->size, "a place inside the file");
    g->n++;
    g->hash = XXH3_64bits_withSeed(what, sizeof what, g->hash);
    g->hash = XXH3_64bits_withSeed(f->id, strlen(f->id), g->hash);
    if (f->severity != TED4_ERROR)
        return;
    if (g->errors++ == 0) {
        fuzz_require(g->n == 1, "an error comes before any advice");
        g->first = f->id;
        g->first_at = f->offset;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t n = ted4_without_tail(data, size, TAIL);
    counting_memory memory = { 0 };
    const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES,
                             .allocator = counting_allocator(&memory) };
    gathered a = { .size = n }, b = { .size = n };
    ted4_scene *s = NULL;
    ted4_error e = { TED4_OK, 0 };
    const ted4_status verdict = ted4_decode(data, n, &o, &s, &e);

    ted4_scene_free(s);
    fuzz_require(ted4_validate(data, n, &o, sink, &a) == verdict, "one verdict");
    fuzz_require((a.errors > 0) == (verdict != TED4_OK),
                 "an error exactly when the file is refused");
    fuzz_require(a.errors == 0 ||
                     (strcmp(a.first, ted4_status_id(e.code)) == 0 && a.first_at == e.offset),
                 "the decoder's own first");
    fuzz_require(ted4_validate(data, n, &o, sink, &b) == verdict && a.n == b.n && a.hash == b.hash,
                 "the same findings twice");
    fuzz_require(memory.held == 0, "memory given back");
    return 0;
}
