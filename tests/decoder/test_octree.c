/* test_octree.c - the octree of cells (norm/octree.h), integers (norm/coded_integer.h), and the
 * adaptive probabilities of both (norm/adaptive.h): what is written is read again, at every depth;
 * a wrong number of cells is noticed; any bytes end, after a bounded number of symbols;
 * probabilities keep their bounds.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include <stdlib.h>
#include <string.h>
#include "norm/coded_integer.h"
#include "norm/half.h"
#include "norm/octree.h"
#include "random_source.h"
#include "read/reader.h"
#include "write/coder_write.h"

static int compare(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return (x > y) - (x < y);
}

/* Fills key with up to n different keys in increasing order, and returns their number. near: keys
 * agree in that many upper bits. */
static size_t random_keys(random_source *r, unsigned depth, unsigned near, size_t n, uint64_t *key)
{
    const unsigned bits = 3 * depth > near ? 3 * depth - near : 1;
    size_t kept = 0;

    for (size_t i = 0; i < n; i++)
        key[i] = ((uint64_t)random_u32(r) << 32 | random_u32(r)) & ((((uint64_t)1) << bits) - 1);
    qsort(key, n, sizeof *key, compare);
    for (size_t i = 0; i < n; i++)
        if (i == 0 || key[i] != key[kept - 1])
            key[kept++] = key[i];
    return kept;
}

/* Calls the walk with positions in place of keys, which it reads or fills. */
static int walk_keys(ted4_coder *c, unsigned depth, size_t n, uint64_t *key)
{
    uint16_t *const position = malloc(3 * n * sizeof *position);
    int right;

    for (size_t i = 0; i < 3 * n; i++)
        position[i] = c->reads ? 0xffff
                               : ted4_grid_half(ted4_gather3(key[i / 3] >> (2 - i % 3)), depth);
    right = ted4_octree_walk(c, depth, n, position);
    for (size_t i = 0; c->reads && i < n; i++)
        if (position[3 * i] != 0xffff || position[3 * i + 1] != 0xffff ||
            position[3 * i + 2] != 0xffff)
            key[i] = ted4_octree_key(position + 3 * i, depth);
    free(position);
    return right;
}

static void write_tree(ted4_writer *w, unsigned depth, size_t n, uint64_t *key)
{
    uint32_t size;

    ted4_writer_init(w);
    w->base.ops->sizes(&w->base, &size, 1);
    w->base.ops->open(&w->base, 1);
    assert_int_equal(walk_keys(&w->base, depth, n, key), 1);
    w->base.ops->close(&w->base);
    assert_int_equal(w->base.error.code, TED4_OK);
}

/* Returns what the walk returned, with the error in *status. */
static int read_tree(const uint8_t *data, size_t size, unsigned depth, size_t n, uint64_t *key,
                     ted4_status *status)
{
    ted4_reader r;
    uint32_t length;
    int right;

    ted4_reader_init(&r, data, 0, size, 0);
    r.base.ops->sizes(&r.base, &length, 1);
    r.base.ops->open(&r.base, 1);
    right = walk_keys(&r.base, depth, n, key);
    if (right)
        r.base.ops->close(&r.base);
    *status = r.base.error.code;
    return right;
}

static void round_trip(void **state)
{
    enum { MOST = 3000 };
    static const size_t count[] = { 1, 2, 7, 100, MOST };
    static uint64_t key[MOST], back[MOST];
    random_source r = random_seed(1);

    (void)state;
    for (unsigned depth = 1; depth <= TED4_OCTREE_DEPTH; depth += depth == 12 ? 4 : 1)
        for (size_t i = 0; i < 3 * sizeof count / sizeof *count; i++) {
            const size_t n = random_keys(&r, depth, 12 * (unsigned)(i % 3), count[i / 3], key);
            ted4_status status;
            ted4_writer w;

            write_tree(&w, depth, n, key);
            memset(back, 0xff, sizeof back);
            assert_int_equal(read_tree(w.out.data, w.out.size, depth, n, back, &status), 1);
            assert_int_equal(status, TED4_OK);
            assert_memory_equal(back, key, n * sizeof *key);
            ted4_writer_finish(&w);
        }
}

/* All cells of a grid are coded for next to nothing, and cells that lie anywhere for what their set
 * takes at the least: log2 of the binomial coefficient, 16.6 bits each. */
static void costs(void **state)
{
    enum { MOST = 4096 };
    static uint64_t key[MOST];
    random_source r = random_seed(5);
    ted4_writer w;

    (void)state;
    for (size_t i = 0; i < MOST; i++)
        key[i] = i;
    write_tree(&w, 4, MOST, key);
    assert_in_range(w.out.size, 1, 64);
    ted4_writer_finish(&w);

    const size_t n = random_keys(&r, 9, 0, MOST, key);

    write_tree(&w, 9, n, key);
    assert_in_range(8 * w.out.size, 16 * n, 18 * n);
    ted4_writer_finish(&w);
}

static void counts(void **state)
{
    enum { N = 50 };
    static uint64_t key[N], back[N + 1];
    random_source r = random_seed(2);
    const size_t n = random_keys(&r, 8, 0, N, key);
    ted4_status status;
    ted4_writer w;

    (void)state;
    write_tree(&w, 8, n, key);
    memset(back, 0xff, sizeof back);
    assert_int_equal(read_tree(w.out.data, w.out.size, 8, n - 1, back, &status), 0);
    assert_int_equal(status, TED4_OK);
    assert_true(back[n - 1] == UINT64_MAX); /* no room for it was promised */
    assert_int_equal(read_tree(w.out.data, w.out.size, 8, n + 1, back, &status), 0);
    assert_int_equal(status, TED4_OK);
    ted4_writer_finish(&w);
}

/* ---- any bytes ---- */

typedef struct {
    ted4_coder base; /* must be first */
    random_source r;
    unsigned ones; /* of 8 bits, how many are 1 */
    size_t n;
} noise;

static int noise_bit(ted4_coder *c, uint32_t prob, int value)
{
    noise *const x = (noise *)c;

    (void)value;
    assert_in_range(prob, TED4_ADAPTIVE_LEAST, 65536 - TED4_ADAPTIVE_LEAST);
    x->n++;
    return random_in(&x->r, 0, 7) < x->ones;
}

static void bounded(void **state)
{
    enum { MOST = 500 };
    const ted4_coder_ops ops = { .bit = noise_bit };
    uint16_t position[3 * MOST];

    (void)state;
    for (unsigned i = 0; i < 2000; i++) {
        const unsigned depth = 1 + i % TED4_OCTREE_DEPTH;
        const size_t n = 1 + i % MOST;
        noise x = { { .ops = &ops, .reads = 1 }, random_seed(i), i % 9, 0 };

        (void)ted4_octree_walk(&x.base, depth, n, position);
        assert_in_range(x.n, 1, 8 * depth * (n + 1));
    }
}

static void damaged(void **state)
{
    enum { N = 200 };
    static uint64_t key[N], back[N];
    random_source r = random_seed(3);
    const size_t n = random_keys(&r, 10, 6, N, key);
    ted4_status status;
    ted4_writer w;

    (void)state;
    write_tree(&w, 10, n, key);
    for (size_t at = 4; at < w.out.size; at++) {
        const uint8_t right = w.out.data[at];

        w.out.data[at] = (uint8_t)random_u32(&r);
        (void)read_tree(w.out.data, w.out.size, 10, n, back, &status);
        w.out.data[at] = right;
    }
    ted4_store32(w.out.data, (uint32_t)(w.out.size - 4 - 10));
    assert_int_equal(read_tree(w.out.data, w.out.size - 10, 10, n, back, &status), 0);
    assert_int_equal(status, TED4_E_ENT_UNDERRUN);
    ted4_writer_finish(&w);
}

/* ---- probabilities ---- */

static void probabilities(void **state)
{
    ted4_adaptive m;

    (void)state;
    for (int value = 0; value < 2; value++) {
        ted4_adaptive_init(&m, 1);
        assert_int_equal(m.p, 32768);
        for (int i = 0; i < 1000; i++) {
            const uint16_t before = m.p;

            ted4_adaptive_update(&m, value);
            assert_true(value ? m.p >= before : m.p <= before);
            assert_in_range(m.p, TED4_ADAPTIVE_LEAST, 65536 - TED4_ADAPTIVE_LEAST);
            assert_in_range(m.seen, 1, TED4_ADAPTIVE_MEMORY);
        }
        assert_int_equal(m.p, value ? 65536 - TED4_ADAPTIVE_LEAST : TED4_ADAPTIVE_LEAST);
    }
    ted4_adaptive_init(&m, 1);
    for (int i = 0; i < 10000; i++)
        ted4_adaptive_update(&m, i % 4 == 0);
    assert_in_range(m.p, 16384 - 2048, 16384 + 2048);
}

/* Every state keeps its bounds, whatever comes next. */
static void all_states(void **state)
{
    (void)state;
    for (uint8_t seen = 0; seen <= TED4_ADAPTIVE_MEMORY; seen++)
        for (uint32_t p = TED4_ADAPTIVE_LEAST; p <= 65536 - TED4_ADAPTIVE_LEAST; p++)
            for (int value = 0; value < 2; value++) {
                ted4_adaptive m = { (uint16_t)p, seen };

                ted4_adaptive_update(&m, value);
                if (m.p < TED4_ADAPTIVE_LEAST || m.p > 65536 - TED4_ADAPTIVE_LEAST ||
                    m.seen > TED4_ADAPTIVE_MEMORY || (value ? m.p < p : m.p > p))
                    fail();
            }
}

/* ---- integers ---- */

static void integers(void **state)
{
    enum { N = 20000 };
    static int32_t x[N];
    random_source r = random_seed(7);
    ted4_integer_model m;
    ted4_writer w;
    ted4_reader d;
    uint32_t size;

    (void)state;
    for (size_t i = 0; i < N; i++)
        x[i] = i < 4 ? (int32_t)(i % 2 ? INT32_MAX : -INT32_MAX)
                     : (int32_t)(random_u32(&r) >> 1 >> random_in(&r, 0, 31)) * (i % 3 ? 1 : -1);
    ted4_integer_model_init(&m);
    ted4_writer_init(&w);
    w.base.ops->sizes(&w.base, &size, 1);
    w.base.ops->open(&w.base, 1);
    for (size_t i = 0; i < N; i++)
        assert_int_equal(ted4_code_integer(&w.base, &m, i % TED4_INTEGER_LENGTHS, x[i]), x[i]);
    w.base.ops->close(&w.base);
    ted4_integer_model_init(&m);
    ted4_reader_init(&d, w.out.data, 0, w.out.size, 0);
    d.base.ops->sizes(&d.base, &size, 1);
    d.base.ops->open(&d.base, 1);
    for (size_t i = 0; i < N; i++)
        assert_int_equal(ted4_code_integer(&d.base, &m, i % TED4_INTEGER_LENGTHS, 0), x[i]);
    d.base.ops->close(&d.base);
    assert_int_equal(d.base.error.code, TED4_OK);
    ted4_writer_finish(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip), cmocka_unit_test(costs),    cmocka_unit_test(counts),
        cmocka_unit_test(bounded),    cmocka_unit_test(damaged),  cmocka_unit_test(probabilities),
        cmocka_unit_test(all_states), cmocka_unit_test(integers),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
