/* test_spec_compact.c - the code that 9.5 and 9.6 print for profile Compact, against the
 * library's coders of the same things (norm/octree.h, norm/coded_weights.h): what these write, it
 * reads, and of damaged substreams both say the same.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "spec_model.h" /* first: its fail() is a function, that of cmocka a macro */
#include "test.h"

#include "norm/coded_weights.h"
#include "norm/half.h"
#include "norm/octree.h"
#include "random_scene.h"
#include "read/reader.h"
#include "write/coder_write.h"

static void begin(ted4_writer *w)
{
    uint32_t size;

    ted4_writer_init(w);
    w->base.ops->sizes(&w->base, &size, 1);
    w->base.ops->open(&w->base, 1);
}

/* Opens a substream behind its size of four bytes. */
static struct coder opened(const uint8_t *bytes, size_t size)
{
    struct coder c;

    open_substream(&c, bytes + 4, size - 4, 1);
    return c;
}

/* Positions of a scene are read again, pattern by pattern. */
static void positions(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        ted4_scene *const s = random_scene(seed);
        const size_t n = s->head.n_anchors;
        uint64_t *const back = malloc(n * sizeof *back);
        ted4_writer w;
        struct coder c;

        begin(&w);
        assert_int_equal(ted4_octree_walk(&w.base, 16, n, s->position), 1);
        w.base.ops->close(&w.base);
        c = opened(w.out.data, w.out.size);
        assert_int_equal(take_tree(&c, 16, n, back), 1);
        close_substream(&c, 1);
        assert_null(c.error);
        for (size_t i = 0; i < n; i++)
            for (int j = 0; j < 3; j++)
                assert_int_equal(coordinate(place_of(back[i], 16, j), 16),
                                 s->position[3 * i + (size_t)j]);
        ted4_writer_finish(&w);
        free(back);
        ted4_scene_free(s);
    }
}

static void grids(void **state)
{
    (void)state;
    for (int depth = 6; depth <= 12; depth++)
        for (uint32_t place = 0; place < 1u << depth; place++) {
            const float x = (float)place / (float)(1 << (depth - 1)) - 1;

            assert_int_equal(coordinate(place, depth), ted4_float_to_half(x));
            assert_true(ted4_half_to_float(coordinate(place, depth)) == x);
        }
}

/* One byte is wrong: the same leaves as far as both go, and the same error. */
static void damaged(void **state)
{
    ted4_scene *const s = random_scene(3);
    const size_t n = s->head.n_anchors;
    uint64_t *const keys = calloc(n, sizeof *keys);
    uint16_t *const ours = calloc(3 * n, sizeof *ours), *const theirs =
                                                            calloc(3 * n, sizeof *theirs);
    ted4_writer w;

    (void)state;
    begin(&w);
    ted4_octree_walk(&w.base, 16, n, s->position);
    w.base.ops->close(&w.base);
    for (size_t at = 4; at < w.out.size; at++) {
        struct coder c;
        ted4_reader r;
        uint32_t length;

        w.out.data[at] ^= (uint8_t)(1u << at % 8);
        ted4_reader_init(&r, w.out.data, 0, w.out.size, 0);
        r.base.ops->sizes(&r.base, &length, 1);
        r.base.ops->open(&r.base, 1);
        c = opened(w.out.data, w.out.size);
        if (c.error == NULL)
            assert_int_equal(take_tree(&c, 16, n, keys), ted4_octree_walk(&r.base, 16, n, theirs));
        assert_string_equal(c.error == NULL ? "ok" : c.error, ted4_status_id(r.base.error.code));
        for (size_t i = 0; i < 3 * n; i++)
            ours[i] = coordinate(place_of(keys[i / 3], 16, (int)(i % 3)), 16);
        if (c.error == NULL)
            assert_memory_equal(ours, theirs, 3 * n * sizeof *ours);
        w.out.data[at] ^= (uint8_t)(1u << at % 8);
    }
    ted4_writer_finish(&w);
    free(keys);
    free(ours);
    free(theirs);
    ted4_scene_free(s);
}

static void integers(void **state)
{
    enum { N = 5000 };
    static int32_t x[N];
    static struct integers m;
    random_source r = random_seed(4);
    ted4_integer_model model;
    ted4_writer w;
    struct coder c;

    (void)state;
    ted4_integer_model_init(&model);
    begin(&w);
    for (size_t i = 0; i < N; i++) {
        x[i] = (int32_t)(random_u32(&r) >> 1 >> random_in(&r, 0, 31)) * (i % 2 ? 1 : -1);
        ted4_code_integer(&w.base, &model, i % TED4_INTEGER_LENGTHS, x[i]);
    }
    w.base.ops->close(&w.base);
    reset_integers(&m);
    c = opened(w.out.data, w.out.size);
    for (size_t i = 0; i < N; i++)
        assert_int_equal(take_integer(&c, &m, i % TED4_INTEGER_LENGTHS), x[i]);
    close_substream(&c, 1);
    assert_null(c.error);
    ted4_writer_finish(&w);
}

/* Units of all lengths and exponents, those among them whose values binary32 does not have. */
static void weights(void **state)
{
    enum { UNITS = 400, MOST = 60 };
    static float x[UNITS][MOST], back[MOST];
    static uint32_t printed[MOST];
    static struct integers m;
    random_source r = random_seed(5);
    ted4_integer_model model;
    ted4_writer w;
    ted4_reader d;
    struct coder c;
    uint32_t size;

    (void)state;
    ted4_integer_model_init(&model);
    begin(&w);
    for (int u = 0; u < UNITS; u++) {
        for (int i = 0; i < MOST; i++) {
            const int32_t k = (int32_t)(random_u32(&r) >> 8 >> random_in(&r, 0, 24));

            x[u][i] = ldexpf((float)(i % 3 ? k : -k), u % 200 - 100);
        }
        ted4_code_weights(&w.base, &model, u % 200 - 100, x[u], (size_t)(u % MOST));
    }
    w.base.ops->close(&w.base);
    ted4_integer_model_init(&model);
    reset_integers(&m);
    ted4_reader_init(&d, w.out.data, 0, w.out.size, 0);
    d.base.ops->sizes(&d.base, &size, 1);
    d.base.ops->open(&d.base, 1);
    c = opened(w.out.data, w.out.size);
    for (int u = 0; u < UNITS; u++) {
        const size_t n = (size_t)(u % MOST);

        ted4_code_weights(&d.base, &model, u % 200 - 100, back, n);
        take_unit(&c, &m, u % 200 - 100, n, printed);
        for (size_t i = 0; i < n; i++)
            assert_true(back[i] == x[u][i]);
        assert_memory_equal(back, printed, n * sizeof *back);
    }
    close_substream(&c, 1);
    d.base.ops->close(&d.base);
    assert_null(c.error);
    assert_int_equal(d.base.error.code, TED4_OK);
    ted4_writer_finish(&w);
}

static void values(void **state)
{
    static const int32_t k[] = { 0,       1,         -1,       3,         8388607,
                                 8388608, -16777215, 16777216, INT32_MAX, -INT32_MAX };

    (void)state;
    for (size_t i = 0; i < sizeof k / sizeof *k; i++)
        for (int e = -256; e <= 256; e++) {
            const float ours = ted4_weight_value(k[i], e);
            const double exact = ldexp(k[i], e);
            const int legal = (double)(float)k[i] == (double)k[i] &&
                              (k[i] == 0 || (fabs(exact) >= 0x1p-126 && fabs(exact) < 0x1p128));

            assert_int_equal(ted4_float_bits(ours), weight(k[i], e));
            assert_true(legal ? (double)ours == exact : ours == INFINITY);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(positions), cmocka_unit_test(grids),   cmocka_unit_test(damaged),
        cmocka_unit_test(integers),  cmocka_unit_test(weights), cmocka_unit_test(values),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
