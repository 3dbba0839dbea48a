/* fz_positions.c - a POSN payload (spec 8): binary16 patterns, three per anchor. Claims: the
 * reading walk gives the same verdict and place as a literal implementation of the rules (values as
 * long doubles, Morton codes bit by bit); what it accepts is written as the same bytes; if all
 * values are legal, the same anchors are accepted after ted4_positions_sort(), and can be written
 * and read in profile Compact, as can the nearest ones of every grid; the conversion of binary16 to
 * X and binary32 is exact, and reversible; places of a grid stand for the coordinates of 8.2, and
 * coordinates beside it have none. SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>
#include "harness.h"
#include "norm/scene.h"
#include "places.h"
#include "read/reader.h"
#include "write/coded.h"
#include "write/coder_write.h"
#include "write/snap.h"

enum { MAX_N = 300 };

static long double value(uint16_t h)
{
    const int e = h >> 10 & 31, m = h & 0x3ff;
    const long double v = e > 0 ? ldexpl(1024 + m, e - 25) : ldexpl(m, -24);

    return h >> 15 ? -v : v;
}

/* The Morton code of an anchor, bit by bit, from the images of spec 8: integers with the order of
 * the binary16 values, so that the patterns of negative ones are reversed. */
static uint64_t code(const uint16_t *p)
{
    uint64_t c = 0;

    for (int bit = 15; bit >= 0; bit--)
        for (int j = 0; j < 3; j++) {
            const uint32_t image = p[j] >> 15 ? 0xffffu - p[j] : p[j] + 0x8000u;

            c = c << 1 | (image >> bit & 1);
        }
    return c;
}

static ted4_error expected(const uint16_t *p, size_t n)
{
    ted4_error e = { TED4_OK, 0 };

    for (size_t i = 0; i < n && e.code == TED4_OK; i++) {
        for (size_t j = 0; j < 3; j++) {
            const uint16_t h = p[3 * i + j];

            if ((h >> 10 & 31) == 31 || h == 0x8000)
                ted4_fail(&e, TED4_E_POS_VALUE, 6 * i + 2 * j);
            else if (fabsl(value(h)) > 1)
                ted4_fail(&e, TED4_E_POS_RANGE, 6 * i + 2 * j);
        }
        if (i > 0 && code(p + 3 * i) <= code(p + 3 * i - 3))
            ted4_fail(&e, TED4_E_POS_ORDER, 6 * i);
    }
    return e;
}

static ted4_error walk(const uint8_t *bytes, uint16_t *p, size_t n)
{
    ted4_scene s = { .head = { .n_anchors = (uint32_t)n }, .position = p };
    ted4_reader r;

    ted4_reader_init(&r, bytes, 0, 6 * n, 0);
    ted4_walk_positions(&r.base, &s);
    return r.base.error;
}

static void write_again(const uint8_t *bytes, uint16_t *p, size_t n)
{
    ted4_scene s = { .head = { .n_anchors = (uint32_t)n }, .position = p };
    ted4_writer w;

    ted4_writer_init(&w);
    ted4_walk_positions(&w.base, &s);
    fuzz_require(w.base.error.code == TED4_OK && w.out.size == 6 * n &&
                     memcmp(w.out.data, bytes, 6 * n) == 0,
                 "the same bytes");
    ted4_writer_finish(&w);
}

static int is_place(long double x, unsigned grid)
{
    const long double scaled = ldexpl(x + 1, (int)grid - 1);

    return scaled == floorl(scaled) && scaled >= 0 && scaled < ldexpl(1, (int)grid);
}

static void check_places(uint16_t h)
{
    for (unsigned grid = 6; grid <= 16; grid += grid == 12 ? 4 : 1) {
        const uint32_t place = ted4_grid_place(h, grid);

        if (grid < 16)
            fuzz_require(is_place(value(h), grid) == (place != UINT32_MAX), "a place of the grid");
        if (place == UINT32_MAX)
            continue;
        fuzz_require(ted4_grid_half(place, grid) == h, "and back");
        if (grid < 16)
            fuzz_require(value(h) == ldexpl(place, 1 - (int)grid) - 1, "its coordinate");
    }
}

/* The payload of profile Compact. A substream has at least a bit an anchor (R-ENT-016). */
static void in_compact(uint16_t *p, size_t n)
{
    static uint16_t back[3 * MAX_N];
    ted4_scene s = { .head = { .n_anchors = (uint32_t)n },
                     .profile = TED4_PROFILE_COMPACT,
                     .position = p },
               t = s;
    ted4_writer w;
    ted4_reader r;

    s.grid = (uint8_t)ted4_coarsest_grid(p, n);
    t.position = back;
    ted4_writer_init(&w);
    ted4_walk_positions(&w.base, &s);
    if (w.base.error.code == TED4_OK) {
        ted4_reader_init(&r, w.out.data, 0, w.out.size, 0);
        ted4_walk_positions(&r.base, &t);
        fuzz_require(r.base.error.code == TED4_OK && t.grid == s.grid &&
                         memcmp(back, p, 6 * n) == 0,
                     "the same positions in profile Compact");
    } else {
        fuzz_require(w.base.error.code == TED4_E_ENT_SIZE, "written in profile Compact");
    }
    ted4_writer_finish(&w);
}

static void sort_them(const uint16_t *p, size_t n)
{
    static uint16_t sorted[3 * MAX_N];
    static uint8_t bytes[6 * MAX_N];
    static uint32_t order[MAX_N];
    const size_t kept = ted4_positions_sort(p, n, order);
    int legal = 1;

    fuzz_require(kept <= n && (kept > 0) == (n > 0), "sorted");
    for (size_t i = 0; i < 3 * kept; i++) {
        sorted[i] = p[3 * order[i / 3] + i % 3];
        legal = legal && expected(sorted + i - i % 3, 1).code == TED4_OK;
        ted4_store16(bytes + 2 * i, sorted[i]);
    }
    if (!legal || kept == 0)
        return;
    fuzz_require(walk(bytes, sorted, kept).code == TED4_OK, "sorted anchors are in order");
    in_compact(sorted, kept);
    for (unsigned grid = 6; grid <= 12; grid++)
        if (fuzz_settle(sorted, kept, grid))
            in_compact(sorted, kept);
}

static void convert(uint16_t h)
{
    const float v = ted4_half_to_float(h);

    if ((h >> 10 & 31) == 31)
        return;
    fuzz_require((long double)v == value(h) && (signbit(v) != 0) == h >> 15,
                 "binary16 to binary32");
    fuzz_require(ted4_float_to_half(v) == h, "and back");
    if (fabsl(value(h)) > 1)
        return;
    if (h != 0x8000)
        check_places(h);
    fuzz_require((long double)ted4_half_q24(h) == ldexpl(value(h), 24), "X is exact");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static uint16_t p[3 * MAX_N];
    const size_t n = size / 6 < MAX_N ? size / 6 : MAX_N;
    ted4_error is, want;

    for (size_t i = 0; i < 3 * n; i++) {
        p[i] = ted4_load16(data + 2 * i);
        convert(p[i]);
    }
    want = expected(p, n);
    is = walk(data, p, n);
    fuzz_require(is.code == want.code && is.offset == want.offset, "the verdict of the rules");
    if (is.code == TED4_OK && n > 0)
        write_again(data, p, n);
    sort_them(p, n);
    return 0;
}
