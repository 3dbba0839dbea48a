/* fz_decode.c - any bytes, given to the strict decoder with settings that up to two bytes after the
 * chunk ENDS select (knobs): order in which tiles run, trace, alignment in memory, limits on memory
 * and work, kernel. Claims: the decoder returns one verdict; a refusal has an offset inside the
 * file; verdict, offset and hash do not depend on the knobs, apart from limit.memory under a lower
 * limit; limit.work is returned exactly if pass 1 and HEAD are valid and W_E (spec 13.4) is above
 * the limit; the memory held exceeds neither the limit nor the bound that follows from size and
 * level (SECURITY.md), and all of it is freed; the input is not modified.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "base/bytes.h"
#include "counting.h"
#include "harness.h"
#include "fix_hashes.h"
#include "norm/limits.h"
#include "order.h"
#include "read/container.h"

enum { KNOB_BYTES = 2, TRACE = 4, WORK = 8, PLAIN = 1 };

/* The result of decoding a file. */
typedef struct {
    ted4_status code;
    ted4_error e;
    ted4_info info;
} outcome;

static void count_element(void *user, size_t offset, const char *element, int64_t index,
                          int64_t value)
{
    size_t *last = user;

    (void)index;
    (void)value;
    fuzz_require(element != NULL && element[0] != 0, "a name for every element");
    *last = offset;
}

static outcome decode(const uint8_t *data, size_t size, const ted4_options *o)
{
    outcome r;
    ted4_scene *s = NULL;

    memset(&r, 0, sizeof r);
    r.code = ted4_decode(data, size, o, &s, &r.e);
    fuzz_require(r.code == r.e.code && (s != NULL) == (r.code == TED4_OK), "one verdict");
    fuzz_require(r.e.offset <= size, "an offset in the file");
    fuzz_require(r.code != TED4_E_IO && r.code != TED4_E_QUERY && r.code != TED4_E_REC_NONFINITE,
                 "a verdict on a file");
    if (s != NULL)
        ted4_scene_info(s, &r.info);
    ted4_scene_free(s);
    return r;
}

/* Returns a limit of at least 1 KiB; knob 0: FUZZ_MAX_BYTES. */
static uint64_t bound_of(uint8_t knob)
{
    return knob >> 4 == 0 ? FUZZ_MAX_BYTES : (uint64_t)1 << (9 + (knob >> 4));
}

/* Returns a limit of at least 2^10 steps. */
static uint64_t work_bound_of(const uint8_t *knob)
{
    return knob[0] & WORK ? (uint64_t)1 << (10 + (knob[1] >> 4)) : 0;
}

/* Returns W_E, or 0 if pass 1 or HEAD is not valid. */
static uint64_t work_of(const uint8_t *data, size_t size)
{
    ted4_reader whole, head;
    ted4_chunk_place p;
    ted4_header h;
    ted4_shape shape;

    memset(&h, 0, sizeof h);
    ted4_reader_init(&whole, data, 0, size, 1);
    ted4_container_check(&whole);
    if (whole.base.error.code != TED4_OK)
        return 0;
    ted4_reader_init(&whole, data, TED4_FILE_HEADER_SIZE, size, 1);
    p = ted4_container_next(&whole);
    ted4_reader_init(&head, data, p.payload, p.end, 0);
    ted4_walk_header(&head.base, &h, &shape, data[11], size);
    return head.base.error.code == TED4_OK ? ted4_count_work(&h, &shape, size) : 0;
}

/* Returns the bound of SECURITY.md. data[11] is the level. */
static uint64_t most_memory(const uint8_t *data, size_t size)
{
    const ted4_limits *l = size > 11 ? ted4_limits_of(data[11]) : NULL;
    const uint64_t per_byte = 8192 + (l != NULL ? 32 * l->symbols_per_byte : 0);

    if (l != NULL && l->level == TED4_LEVEL_UNBOUNDED)
        return FUZZ_MAX_BYTES;
    return ((uint64_t)4 << 20) + per_byte * size;
}

/* too_much: the limit on work forbids the file. */
static void same(const outcome *a, const outcome *b, int tighter, int too_much)
{
    if (tighter && b->code == TED4_E_LIMIT_MEMORY)
        return;
    fuzz_require((b->code == TED4_E_LIMIT_WORK) == too_much, "limit.work by the formula");
    if (too_much)
        return;
    fuzz_require(a->code == b->code && a->e.offset == b->e.offset, "one verdict under all knobs");
    fuzz_require(memcmp(a->info.hash, b->info.hash, sizeof a->info.hash) == 0,
                 "one hash under all knobs");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t n = ted4_without_tail(data, size, KNOB_BYTES);
    const uint8_t knob[KNOB_BYTES] = { size > n ? data[n] : 0, size > n + 1 ? data[n + 1] : 0 };
    counting_memory default_memory = { 0 }, memory = { 0 };
    ted4_options plain = { .max_bytes = FUZZ_MAX_BYTES,
                           .allocator = counting_allocator(&default_memory) };
    ted4_options o = { .max_bytes = bound_of(knob[0]), .allocator = counting_allocator(&memory) };
    ted4_parallel parallel = order_parallel(knob[0] & 3);
    uint8_t *const copy = malloc(n + 64);
    size_t last = 0;
    outcome a, b;

    fuzz_require(copy != NULL, "memory");
    a = decode(data, n, &plain);
    fuzz_require(default_memory.held == 0 && default_memory.most <= FUZZ_MAX_BYTES,
                 "memory given back");
    fuzz_require(default_memory.most <= most_memory(data, n), "memory by the formula");
    o.parallel = (knob[0] & 3) != 0 ? &parallel : NULL;
    o.trace = knob[0] & TRACE ? count_element : NULL;
    o.trace_user = &last;
    o.max_work = work_bound_of(knob);
    memcpy(copy + knob[1] / 2 % 64, data, n);
    use_kernels(knob[1] & PLAIN ? "plain" : NULL);
    b = decode(copy + knob[1] / 2 % 64, n, &o);
    use_kernels(NULL);
    fuzz_require(memory.held == 0 && memory.most <= o.max_bytes, "no more memory than allowed");
    fuzz_require(last <= n && memcmp(copy + knob[1] / 2 % 64, data, n) == 0, "input left alone");
    same(&a, &b, o.max_bytes<FUZZ_MAX_BYTES, o.max_work> 0 && work_of(data, n) > o.max_work);
    free(copy);
    return 0;
}
