/* fz_alloc_fail.c - a file, and up to 3 bytes after its chunk ENDS: u16 number of the allocation
 * that fails, u8 whether all later ones fail too. The decoder and the reconstruction get a caller's
 * allocator; the malloc, calloc and realloc of the writer are wrapped by the linker (-Wl,--wrap).
 * Claims: nothing leaks; the verdict is limit.memory or the one that the file gets with unlimited
 * memory, and always the latter if no allocation failed; nothing else is returned together with
 * limit.memory.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "counting.h"
#include "harness.h"
#include "fix_hashes.h"
#include "write/encode.h"

enum { TAIL = 3 };

void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__real_realloc(void *block, size_t size);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *block, size_t size);
void __wrap_free(void *block);

/* State of the wrapped functions, which count and fail only while on is set. */
static struct {
    int on, fail_on;
    size_t n, fail_at;
    int64_t live; /* blocks allocated and not yet freed */
} wrapped;

static int fails(void)
{
    if (!wrapped.on)
        return 0;
    wrapped.n++;
    if (wrapped.fail_at > 0 &&
        (wrapped.n == wrapped.fail_at || (wrapped.fail_on && wrapped.n > wrapped.fail_at)))
        return 1;
    wrapped.live++;
    return 0;
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
    void *const p = fails() ? NULL : __real_realloc(block, size);

    if (wrapped.on && p != NULL && block != NULL)
        wrapped.live--;
    return p;
}

void __wrap_free(void *block)
{
    if (wrapped.on && block != NULL)
        wrapped.live--;
    __real_free(block);
}

static void check_recon(const ted4_scene *s, uint64_t fail_at, int fail_on)
{
    counting_memory memory = { .fail_at = fail_at, .fail_on = fail_on };
    const ted4_options o = { .allocator = counting_allocator(&memory) };
    const ted4_query q = { 0, 1, { 0, 0, 0 } };
    ted4_recon *r = NULL;
    ted4_gaussians g;
    const ted4_status verdict = ted4_recon_new(&r, s, &o);

    fuzz_require(verdict == TED4_OK || (verdict == TED4_E_LIMIT_MEMORY && r == NULL), "recon");
    fuzz_require((verdict == TED4_OK) == (fail_at == 0 || memory.n < fail_at),
                 "refused exactly when one failed");
    if (r != NULL) {
        const uint64_t before = memory.n;

        (void)ted4_recon_query(r, &q, NULL, &g);
        fuzz_require(memory.n == before, "a query takes no memory");
    }
    ted4_recon_free(r);
    fuzz_require(memory.held == 0, "no leak in recon");
}

static void check_writer(const ted4_scene *s, size_t fail_at, int fail_on)
{
    uint8_t *out = NULL;
    size_t n_out = 1;
    ted4_status verdict;

    memset(&wrapped, 0, sizeof wrapped);
    wrapped.fail_at = fail_at;
    wrapped.fail_on = fail_on;
    wrapped.on = 1;
    verdict = ted4_encode(s, 0, NULL, &out, &n_out, NULL);
    free(out);
    wrapped.on = 0;
    fuzz_require(wrapped.live == 0, "no leak in the writer");
    fuzz_require(verdict == TED4_OK ||
                     (verdict == TED4_E_LIMIT_MEMORY && out == NULL && n_out == 0),
                 "the writer");
    fuzz_require(verdict == TED4_OK || (fail_at > 0 && wrapped.n >= fail_at),
                 "limit.memory only when one failed");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t n = ted4_without_tail(data, size, TAIL);
    fuzz_source in = { data + n, data + size };
    counting_memory all = { 0 }, memory = { .fail_at = fuzz_u16(&in), .fail_on = fuzz_u8(&in) & 1 };
    ted4_options o = { .max_bytes = FUZZ_MAX_BYTES, .allocator = counting_allocator(&all) };
    ted4_scene *s = NULL, *t = NULL;
    ted4_error e, f;
    const ted4_status want = ted4_decode(data, n, &o, &s, &e);

    /* A file without these bytes gets a failing allocation chosen by its size. */
    if (n == size)
        memory.fail_at = all.n > 0 ? 1 + size % all.n : 1;
    o.allocator = counting_allocator(&memory);

    const ted4_status is = ted4_decode(data, n, &o, &t, &f);

    fuzz_require(is == want || is == TED4_E_LIMIT_MEMORY, "the right verdict");
    fuzz_require(is == f.code && (t != NULL) == (is == TED4_OK) && f.offset <= n,
                 "and nothing beside it");
    fuzz_require(memory.fail_at <= memory.n ? 1 : is == want && f.offset == e.offset,
                 "unless one failed");
    ted4_scene_free(t);
    fuzz_require(memory.held == 0, "no leak in the decoder");
    if (s != NULL) {
        check_recon(s, memory.fail_at, memory.fail_on);
        check_writer(s, (size_t)memory.fail_at, memory.fail_on);
    }
    ted4_scene_free(s);
    fuzz_require(all.held == 0, "no leak");
    return 0;
}
