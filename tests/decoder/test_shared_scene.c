/* test_shared_scene.c - a decoded scene is only read by what is made from it, so that several
 * threads may share it: its memory is made read-only, and a write ends the test.
 * SPDX-License-Identifier: BSD-2-Clause */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include <stdlib.h>
#include <sys/mman.h>

#include "test.h"
#include "ted4.h"
#include "tool/cli.h"

enum { ROOM = 1 << 26, ALIGNMENT = 64, TIERS = 4 };

/* Memory in pages of its own, given out from its beginning and never taken back. */
typedef struct {
    unsigned char *pages;
    size_t used;
} pages;

static void *give(void *user, size_t size)
{
    pages *const p = user;
    const size_t at = p->used;

    size = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    if (size > ROOM - at)
        return NULL;
    p->used = at + size;
    return p->pages + at;
}

static void take_back(void *user, void *block)
{
    (void)user;
    (void)block;
}

static void sink(void *user, const void *bytes, size_t size)
{
    (void)bytes;
    *(size_t *)user += size;
}

static void expect_only_read(const char *path)
{
    static const ted4_query q = { 1, 2, { 0, 0, 0 } };
    pages p = { mmap(NULL, ROOM, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0), 0 };
    const ted4_options o = { .allocator = { give, take_back, &p } };
    size_t size, n = 0;
    uint8_t *file = ted4_read_file(path, &size);
    ted4_gaussians g;
    ted4_scene *s;
    ted4_recon *r;
    ted4_info info;

    assert_ptr_not_equal(p.pages, MAP_FAILED);
    assert_non_null(file);
    assert_int_equal(ted4_decode(file, size, &o, &s, NULL), TED4_OK);
    assert_int_equal(mprotect(p.pages, ROOM, PROT_READ), 0);
    ted4_scene_info(s, &info);
    for (int tier = 1; tier <= TIERS; tier++)
        assert_int_equal(ted4_dump_tier(s, tier, NULL, sink, &n), TED4_OK);
    assert_true(n > 0);
    assert_int_equal(ted4_recon_new(&r, s, NULL), TED4_OK);
    assert_int_equal(ted4_recon_query(r, &q, NULL, &g), TED4_OK);
    ted4_recon_free(r);
    assert_int_equal(mprotect(p.pages, ROOM, PROT_READ | PROT_WRITE), 0);
    ted4_scene_free(s);
    munmap(p.pages, ROOM);
    free(file);
}

static void profile_main(void **state)
{
    (void)state;
    expect_only_read("conformance/vectors/content/CNT-pop-0.002.ted4");
}

static void profile_compact(void **state)
{
    (void)state;
    expect_only_read("conformance/vectors/valid/compact/CMP-order.ted4");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(profile_main),
        cmocka_unit_test(profile_compact),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
