/* test_kernel_gauss.c - each kernel/gauss_many_*.c that this machine can run gives the results of
 * read/reader.c, which reads one symbol at a time: symbols, error, and number of words read; for
 * every number of lanes, calls of any size, escapes, symbols out of range, and damaged substreams.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "base/level.h"
#include "read/reader.h"
#include "substream_case.h"
#include "use_kernels.h"

typedef struct {
    ted4_error error;
    size_t left; /* bytes of words that were not read */
    int16_t *k;
} outcome;

/* Reads the symbols in calls of step symbols each. */
static outcome read_symbols(const uint8_t *data, size_t size, const symbols *s, size_t step,
                            ted4_gauss_many many)
{
    ted4_reader r;
    uint32_t length;
    outcome o = { { TED4_OK, 0 }, 0, calloc(s->n, sizeof *o.k) };

    ted4_reader_init(&r, data, 0, size, 0);
    r.many = many;
    r.base.ops->sizes(&r.base, &length, 1);
    r.base.ops->open(&r.base, s->n);
    for (size_t i = 0; i < s->n; i += step)
        r.base.ops->gauss(&r.base, s->n - i < step ? s->n - i : step, s->mu + i, s->sigma + i,
                          o.k + i);
    r.base.ops->close(&r.base);
    o.error = r.base.error;
    o.left = (size_t)(r.rans.end - r.rans.word);
    return o;
}

/* Asserts that both give the same result, and returns it. */
static ted4_status compare(const uint8_t *data, size_t size, const symbols *s, ted4_gauss_many many)
{
    static const size_t step[] = { 1 << 20, 4096, 1001, 64, 7 };
    const outcome want = read_symbols(data, size, s, s->n, NULL);

    for (size_t i = 0; i < sizeof step / sizeof step[0]; i++) {
        const outcome got = read_symbols(data, size, s, step[i], many);

        assert_int_equal(got.error.code, want.error.code);
        assert_int_equal(got.error.offset, want.error.offset);
        if (want.error.code == TED4_OK) {
            assert_int_equal(got.left, want.left);
            assert_memory_equal(got.k, want.k, s->n * sizeof *got.k);
        }
        free(got.k);
    }
    free(want.k);
    return want.error.code;
}

typedef struct {
    ted4_level level;
    ted4_gauss_many many;
} variant;

/* Returns the variant of a test; skips the test if this machine does not have it. */
static ted4_gauss_many variant_of(void **state)
{
    const variant *v = *state;

    if (v->level > ted4_level_of_machine()) {
        print_message("skipped: this machine has no %s\n", ted4_level_name(v->level));
        skip();
    }
    return v->many;
}

/* From 1 to 64 lanes. */
static void test_same(void **state)
{
    static const size_t count[] = { 1, 8192, 16384, 16385, 20000, 40000, 70001, 140000, 262144 };
    static const unsigned far[] = { 0, 2000, 9 }, widest[] = { 20, 100, TED4_N_SIGMA - 1 };
    const ted4_gauss_many many = variant_of(state);

    for (size_t i = 0; i < sizeof count / sizeof count[0]; i++)
        for (unsigned f = 0; f < 3; f++)
            for (unsigned v = 0; v < 3; v++) {
                symbols s = symbols_make(3 * i + f, count[i], far[f], widest[v]);
                ted4_writer w;

                symbols_write(&w, &s);
                compare(w.out.data, w.out.size, &s, many);
                ted4_writer_finish(&w);
                symbols_free(&s);
            }
}

/* Symbols are read with means further out than those with which they were written: the last symbol
 * leaves the range of 16 bits, once without an escape and once with one. */
static void test_outside(void **state)
{
    static const size_t at[] = { 0, 1, 100, 4099, 39999 };
    const ted4_gauss_many many = variant_of(state);

    for (size_t i = 0; i < 4 * sizeof at / sizeof at[0]; i++) {
        const int sign = i % 2 ? -1 : 1, escapes = i / 2 % 2 != 0;
        symbols s = symbols_make(7, 40000, 0, 60);
        const size_t k = at[i / 4];
        ted4_writer w;

        s.k[k] = (int16_t)(32767 * sign);
        s.mu[k] = (escapes ? 30000 : 32767) * 256 * sign;
        symbols_write(&w, &s);
        assert_int_equal(compare(w.out.data, w.out.size, &s, many), TED4_OK);
        s.mu[k] += 256 * sign;
        assert_int_equal(compare(w.out.data, w.out.size, &s, many), TED4_E_ENT_SYMBOL_RANGE);
        ted4_writer_finish(&w);
        symbols_free(&s);
    }
}

/* With a word changed, or words cut off and the size adjusted, the verdict is the same. */
static void test_damaged(void **state)
{
    const ted4_gauss_many many = variant_of(state);
    symbols s = symbols_make(5, 40000, 3000, 100);
    random_source r = random_seed(11);
    ted4_writer w;

    symbols_write(&w, &s);
    for (int i = 0; i < 30; i++) {
        const size_t at = random_in(&r, 4, (uint32_t)w.out.size - 1);

        w.out.data[at] ^= (uint8_t)(1u << random_in(&r, 0, 7));
        compare(w.out.data, w.out.size, &s, many);
    }
    for (size_t cut = 2; cut < 60; cut += 6) {
        const uint32_t left = (uint32_t)(w.out.size - 4 - cut);

        for (int k = 0; k < 4; k++)
            w.out.data[k] = (uint8_t)(left >> 8 * k);
        compare(w.out.data, w.out.size - cut, &s, many);
    }
    ted4_writer_finish(&w);
    symbols_free(&s);
}

/* The kernel handles the calls for which it was made. */
static void test_takes(void **state)
{
    const ted4_gauss_many many = variant_of(state);
    symbols s = symbols_make(6, 40000, 0, 60);
    ted4_writer w;
    ted4_reader r;
    uint32_t length;

    symbols_write(&w, &s);
    ted4_reader_init(&r, w.out.data, 0, w.out.size, 0);
    r.base.ops->sizes(&r.base, &length, 1);
    r.base.ops->open(&r.base, s.n);
    assert_int_equal(r.rans.n_lanes, 8);

    ted4_gauss_lanes lanes = { r.rans.state, 8, 0, r.rans.word, r.rans.end };
    int16_t *k = calloc(s.n, sizeof *k);
    const size_t done = many(&lanes, s.n, s.mu, s.sigma, k);

    assert_int_equal(done, s.n);
    assert_memory_equal(k, s.k, done * sizeof *k);
    free(k);
    ted4_writer_finish(&w);
    symbols_free(&s);
}

/* Indices of sigma at both ends, means with every fraction, and symbols at the ends of the
 * window. */
static void test_ends(void **state)
{
    static const uint8_t sigma[] = { 0, 1, 38, 64, 100, 150, 200, TED4_N_SIGMA - 1 };
    const ted4_gauss_many many = variant_of(state);
    symbols s = symbols_make(9, 262144, 0, 100);
    random_source r = random_seed(3);
    ted4_writer w;

    for (size_t i = 0; i < s.n; i++) {
        const int hw = ted4_half[s.sigma[i] = sigma[random_in(&r, 0, 7)]];
        const int ends[] = { 0, 1, -hw, -hw - 1, hw + 1, hw + 2, hw, -hw + 1 };

        s.mu[i] = (int32_t)random_in(&r, 0, 512) - 256;
        s.k[i] = (int16_t)(ends[random_in(&r, 0, 7)] + ted4_floor_shift(s.mu[i], TED4_MU_BITS));
    }
    symbols_write(&w, &s);
    assert_int_equal(compare(w.out.data, w.out.size, &s, many), TED4_OK);
    ted4_writer_finish(&w);
    symbols_free(&s);
}

static void test_selected(void **state)
{
    const variant *v = *state;
    const ted4_gauss_many many = variant_of(state);

    use_kernels(ted4_level_name(v->level));
    assert_ptr_equal(ted4_select_gauss_many(), many);
    use_kernels("plain");
    assert_null(ted4_select_gauss_many());
    use_kernels(NULL);
}

#define TESTS(v)                                                                                 \
    cmocka_unit_test_prestate(test_same, &(v)), cmocka_unit_test_prestate(test_outside, &(v)),   \
        cmocka_unit_test_prestate(test_damaged, &(v)),                                           \
        cmocka_unit_test_prestate(test_takes, &(v)), cmocka_unit_test_prestate(test_ends, &(v)), \
        cmocka_unit_test_prestate(test_selected, &(v))

int main(void)
{
#if defined(__x86_64__)
    static variant v3 = { TED4_LEVEL_V3, ted4_gauss_many_avx2 },
                   v4 = { TED4_LEVEL_V4, ted4_gauss_many_avx512 };
    const struct CMUnitTest tests[] = { TESTS(v3), TESTS(v4) };
#elif defined(__AARCH64EL__)
    static variant neon = { TED4_LEVEL_BASE, ted4_gauss_many_neon };
    const struct CMUnitTest tests[] = { TESTS(neon) };
#else
    static variant none = { TED4_LEVELS, NULL };
    const struct CMUnitTest tests[] = { TESTS(none) };
#endif

    return cmocka_run_group_tests(tests, NULL, NULL);
}
