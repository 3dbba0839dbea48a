/* fz_dump.c - the byte strings that conformance hashes (annex J), for any file; up to three bytes
 * after the chunk ENDS give the number of an allocation that fails. Claims: tier T0 returns the
 * verdict and the offset of the decoder; if the file is accepted, T0 consists of whole records
 * whose bytes lie in the file, T1 has 15 bytes per anchor, and all of T1 to T4 are written, equal
 * if written twice; a failing allocation gives limit.memory, and nothing leaks.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include <xxhash.h>
#include "base/bytes.h"
#include "counting.h"
#include "harness.h"
#include "fix_hashes.h"

enum { TAIL = 3, TIERS = 5, RECORD = 6, PER_ANCHOR = 15 };

/* The bytes that a sink received. */
typedef struct {
    const uint8_t *data; /* the file that is dumped */
    size_t size, n, calls;
    XXH64_hash_t hash;
} sunk;

static void sink(void *user, const void *bytes, size_t size)
{
    sunk *s = user;
    const uint8_t *p = bytes;

    fuzz_require(p != NULL && size > 0, "bytes");
    if (p >= s->data && p < s->data + s->size)
        fuzz_require(size <= s->size - (size_t)(p - s->data), "bytes of the file");
    s->hash = XXH3_64bits_withSeed(bytes, size, s->hash);
    s->n += size;
    s->calls++;
}

static sunk sink_of(const uint8_t *data, size_t size)
{
    return (sunk) { data, size, 0, 0, 0 };
}

static void dump_tiers(const ted4_scene *s, const uint8_t *data, size_t size, uint64_t fail_at)
{
    ted4_info info;

    ted4_scene_info(s, &info);
    for (int tier = 1; tier < TIERS; tier++) {
        counting_memory memory = { .fail_at = fail_at };
        const ted4_options o = { .allocator = counting_allocator(&memory) };
        sunk a = sink_of(data, size), b = a, c = a;

        fuzz_require(ted4_dump_tier(s, tier, NULL, sink, &a) == TED4_OK, "a tier");
        fuzz_require(ted4_dump_tier(s, tier, NULL, sink, &b) == TED4_OK && a.n == b.n &&
                         a.hash == b.hash,
                     "twice the same");
        fuzz_require(tier != 1 || a.n == PER_ANCHOR * (size_t)info.n_anchors, "the size of T1");

        const ted4_status verdict = ted4_dump_tier(s, tier, &o, sink, &c);

        fuzz_require(verdict ==
                         (fail_at > 0 && memory.n >= fail_at ? TED4_E_LIMIT_MEMORY : TED4_OK),
                     "limit.memory exactly when one failed");
        fuzz_require(memory.held == 0, "no leak");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES };
    const size_t n = ted4_without_tail(data, size, TAIL);
    fuzz_source in = { data + n, data + size };
    const uint16_t fail_at = fuzz_u16(&in);
    sunk t0 = sink_of(data, n);
    ted4_scene *s = NULL;
    ted4_error e = { TED4_OK, 0 }, f = e;
    const ted4_status verdict = ted4_decode(data, n, &o, &s, &e);

    fuzz_require(ted4_dump_syntax(data, n, &o, sink, &t0, &f) == verdict && e.code == f.code &&
                     e.offset == f.offset,
                 "one verdict");
    if (s != NULL) {
        fuzz_require(t0.n > n / 8 + RECORD, "records");
        dump_tiers(s, data, n, fail_at % 16);
    }
    ted4_scene_free(s);
    return 0;
}
