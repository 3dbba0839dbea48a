/* fz_inflate.c - a deflated blob (spec 7.2): u8 kind, u16 number n of values, u16 memory limit,
 * then the deflated bytes; kind 1: then the values, which the harness deflates first. Claims: the
 * blob is accepted exactly if the bytes are one zlib stream that ends where they end, gives 4 n
 * bytes, and is shorter than these (compared with zlib's own uncompress(), which gets more room
 * than that); the memory used stays within the limit, and all of it is freed; the values are
 * unshuffled correctly; a ratio that DEFLATE cannot reach is refused before any allocation.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include <zlib.h>
#include "base/bytes.h"
#include "counting.h"
#include "harness.h"
#include "read/inflate.h"

enum { CAPACITY = 1 << 19 };

/* Tests whether zlib itself obtains exactly 4 n bytes and uses the whole input. */
static int zlib_accepts(const uint8_t *data, size_t size, size_t n, uint8_t *out)
{
    uLongf n_out = CAPACITY;
    uLong n_in = size;

    if (size == 0 || size >= 4 * n)
        return 0;
    return uncompress2(out, &n_out, data, &n_in) == Z_OK && n_out == 4 * n && n_in == size;
}

static void check(const uint8_t *data, size_t size, size_t n, uint64_t bound)
{
    static uint8_t out[CAPACITY];
    counting_memory memory = { 0 };
    const ted4_options o = { .max_bytes = bound, .allocator = counting_allocator(&memory) };
    float *const values = calloc(n + 1, sizeof *values);
    ted4_arena arena;
    ted4_status verdict;
    const int good = zlib_accepts(data, size, n, out);

    fuzz_require(values != NULL, "memory");
    ted4_arena_init(&arena, &o);
    verdict = ted4_inflate(&arena, data, size, values, n);
    fuzz_require(memory.most <= bound && memory.held == 0 && arena.used == 0, "memory");
    fuzz_require(!good || !ted4_inflate_impossible(size, n), "a possible ratio");
    fuzz_require(!ted4_inflate_impossible(size, n) ||
                     (memory.n == 0 && verdict == TED4_E_NET_DEFLATE),
                 "refused before memory is taken");
    if (verdict == TED4_E_LIMIT_MEMORY)
        fuzz_require(bound < 4 * n + (1 << 17), "only when it is short");
    else
        fuzz_require((verdict == TED4_OK) == good, "accepted exactly when zlib does");
    for (size_t i = 0; i < n && verdict == TED4_OK; i++)
        for (unsigned b = 0; b < 4; b++)
            fuzz_require((ted4_float_bits(values[i]) >> 8 * b & 255) == out[b * n + i],
                         "unshuffled");
    ted4_arena_finish(&arena);
    free(values);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static uint8_t packed[CAPACITY];
    fuzz_source in = { data, data + size };
    const int kind = fuzz_u8(&in);
    size_t n = fuzz_u16(&in);
    const uint16_t knob = fuzz_u16(&in);
    const uint64_t bound = knob == 0 ? 1 << 24 : 64 + (uint64_t)knob * 16;
    uLongf n_packed = CAPACITY;

    if (kind & 1) {
        n = kind & 2 ? n : (size_t)(in.end - in.at) / 4;
        if (compress2(packed, &n_packed, in.at, (uLong)(in.end - in.at), kind >> 4 & 7) != Z_OK)
            return 0;
        check(packed, n_packed, n, bound);
    } else {
        check(in.at, (size_t)(in.end - in.at), n, bound);
    }
    return 0;
}
