/* test_machine.c - machines whose size_t has 32 bits: sizes that a file claims must not overflow
 * there (spec 13.3). The walk of POSN, the coder that reads, and the ratio of a zlib stream, with
 * all that they call here, are compiled a second time with such a size_t. `make cross` runs all
 * vectors on i686.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include <stdlib.h>
#include <string.h>
#define ZLIB_CONST
#include <zlib.h>

#define size_t uint32_t
#undef SIZE_MAX
#define SIZE_MAX UINT32_MAX
#include "ref-decoder/read/inflate.c"
#include "ref-decoder/read/reader.c"
#include "ref-decoder/norm/shape.c"
#include "ref-decoder/norm/walk_positions.c"
#include "ref-decoder/base/arena.c"
#include "ref-decoder/base/status.c"

/* Walks a POSN of that many bytes, with the number of anchors that a HEAD at level 31 claims. */
static ted4_error walk(uint32_t n_anchors, uint32_t bytes)
{
    static const uint8_t payload[16];
    ted4_scene s;
    ted4_reader r;

    memset(&s, 0, sizeof s);
    s.head.n_anchors = n_anchors;
    ted4_reader_init(&r, payload, 0, bytes, 0);
    ted4_walk_positions(&r.base, &s);
    return r.base.error;
}

/* Three coordinates of two bytes: either product may overflow to a number that fits. */
static void claimed_anchors(void **state)
{
    static const uint32_t n[] = { 0x55555556, 0xaaaaaaab, 0x2aaaaaab, 0xffffffff,
                                  0x80000000, 0x7fffffff, 0x55555555, 2 };

    (void)state;
    for (unsigned i = 0; i < sizeof n / sizeof *n; i++)
        for (uint32_t bytes = 0; bytes <= 10; bytes++) {
            const ted4_error e = walk(n[i], bytes);

            assert_int_equal(e.code, TED4_E_CON_PAYLOAD_SIZE);
            assert_int_equal(e.offset, 0);
        }
}

/* 2^30 values fill the whole address space, but a stream of 5 MB may contain them: the limit is one
 * of memory, not an error in the file. */
static void claimed_values(void **state)
{
    const uint64_t n = ((uint64_t)1 << 30) + 1;
    ted4_options o = { .max_bytes = 1 << 20 };
    uint8_t stream[64] = { 0 };
    ted4_arena arena;

    (void)state;
    assert_false(ted4_inflate_impossible(5000000, n));
    assert_true(ted4_inflate_impossible(4000000, n));
    assert_true(ted4_inflate_impossible(64, (uint64_t)1 << 41));
    ted4_arena_init(&arena, &o);
    assert_int_equal(ted4_inflate(&arena, stream, 5000000, NULL, n), TED4_E_LIMIT_MEMORY);
    ted4_arena_finish(&arena);
}

/* The bank may have 2^41 values. */
static void shape_of_bank(void **state)
{
    ted4_header h;
    ted4_shape s;

    (void)state;
    memset(&h, 0, sizeof h);
    h.tile_size = 64;
    h.n_anchors = 1;
    h.motion = TED4_MOTION_BANK;
    h.phi_dim = 1;
    h.bank_rows = UINT32_MAX;
    h.bank_dim = 512;
    ted4_shape_make(&s, &h);
    assert_int_equal(s.n_bank, (uint64_t)UINT32_MAX * 512);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(claimed_anchors),
        cmocka_unit_test(claimed_values),
        cmocka_unit_test(shape_of_bank),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
