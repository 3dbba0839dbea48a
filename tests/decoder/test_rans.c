/* test_rans.c - substreams written by write/coder_write.c and read by read/reader.c (spec 9.2 to
 * 9.4), and damaged ones.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "read/reader.h"
#include "substream_case.h"

/* The extreme case: the largest sums that two networks can give, with the largest symbols. */
static void push_out(symbols *s, uint64_t seed)
{
    random_source r = random_seed(seed);

    for (size_t i = 0; i < s->n; i++) {
        s->mu[i] = random_in(&r, 0, 1) ? 2 * TED4_OUTPUT_MAX : -2 * TED4_OUTPUT_MAX;
        s->k[i] = random_in(&r, 0, 1) ? 32767 : -32767;
    }
}

static const char *read_symbols(const uint8_t *data, size_t size, const symbols *s, int16_t *k)
{
    ted4_reader r;
    uint32_t length;

    ted4_reader_init(&r, data, 0, size, 0);
    r.base.ops->sizes(&r.base, &length, 1);
    r.base.ops->open(&r.base, s->n);
    r.base.ops->gauss(&r.base, s->n, s->mu, s->sigma, k);
    r.base.ops->close(&r.base);
    return ted4_status_id(r.base.error.code);
}

static void round_trip(void **state)
{
    static const size_t count[] = { 1, 2, 1000, 4095, 8191, 8192, 16384, 200000, 600000 };

    (void)state;
    for (size_t i = 0; i < 2 * sizeof count / sizeof *count; i++) {
        symbols s = symbols_make(i, count[i / 2], 0, TED4_N_SIGMA - 1);
        int16_t *k = malloc(s.n * sizeof *k);
        ted4_writer w;

        if (i % 2)
            push_out(&s, i);
        symbols_write(&w, &s);
        assert_string_equal(read_symbols(w.out.data, w.out.size, &s, k), "ok");
        assert_memory_equal(k, s.k, s.n * sizeof *k);
        ted4_writer_finish(&w);
        free(k);
        symbols_free(&s);
    }
}

static void lanes(void **state)
{
    (void)state;
    assert_int_equal(ted4_rans_lanes(1), 1);
    assert_int_equal(ted4_rans_lanes(8191), 1);
    assert_int_equal(ted4_rans_lanes(8192), 2);
    assert_int_equal(ted4_rans_lanes(4096 * 64 - 1), 32);
    assert_int_equal(ted4_rans_lanes(4096 * 64), 64);
    assert_int_equal(ted4_rans_lanes((size_t)1 << 30), 64);
}

static void bits(void **state)
{
    enum { N = 100000 };
    random_source r = random_seed(3);
    static uint32_t prob[N];
    static uint8_t bit[N];
    ted4_writer w;
    ted4_reader d;
    uint32_t size;

    (void)state;
    ted4_writer_init(&w);
    w.base.ops->sizes(&w.base, &size, 1);
    w.base.ops->open(&w.base, N);
    for (size_t i = 0; i < N; i++) {
        prob[i] = i % 3 ? random_in(&r, 1, 65535) : i % 2 ? 1 : 65535;
        bit[i] = random_u32(&r) % 65536 < prob[i];
        (void)w.base.ops->bit(&w.base, prob[i], bit[i]);
    }
    w.base.ops->close(&w.base);
    ted4_reader_init(&d, w.out.data, 0, w.out.size, 0);
    d.base.ops->sizes(&d.base, &size, 1);
    d.base.ops->open(&d.base, N);
    for (size_t i = 0; i < N; i++)
        if (d.base.ops->bit(&d.base, prob[i], 0) != bit[i])
            fail();
    d.base.ops->close(&d.base);
    assert_int_equal(d.base.error.code, TED4_OK);
    ted4_writer_finish(&w);
}

/* Returns the identifier with which a damaged substream is refused. change: bytes appended, or
 * removed if negative. */
static void damaged(void **state)
{
    symbols s = symbols_make(9, 500, 0, TED4_N_SIGMA - 1);
    int16_t k[500];
    ted4_writer w;
    uint8_t *d;
    size_t n;

    (void)state;
    symbols_write(&w, &s);
    d = malloc(w.out.size + 2);
    n = w.out.size;
    memcpy(d, w.out.data, n);
    memset(d + n, 0, 2);
    ted4_store32(d, (uint32_t)(n - 4 + 2));
    assert_string_equal(read_symbols(d, n + 2, &s, k), "ent.final");
    ted4_store32(d, (uint32_t)(n - 4 - 2));
    assert_string_equal(read_symbols(d, n - 2, &s, k), "ent.underrun");
    ted4_store32(d, (uint32_t)(n - 4 - 1));
    assert_string_equal(read_symbols(d, n - 1, &s, k), "ent.size");
    ted4_store32(d, 2);
    assert_string_equal(read_symbols(d, 6, &s, k), "ent.size");
    ted4_store32(d, (uint32_t)(n - 4));
    assert_string_equal(read_symbols(d, n - 1, &s, k), "con.payload-size");
    assert_string_equal(read_symbols(d, n, &s, k), "ok");
    d[6] = d[7] = 0;
    assert_string_equal(read_symbols(d, n, &s, k), "ent.state");
    free(d);
    ted4_writer_finish(&w);
    symbols_free(&s);
}

/* Reads a substream of one symbol, mu 0 and sigma 1: a high escape followed by the bits of E. */
static const char *read_escape(uint32_t E, int16_t *k)
{
    int32_t mu = 0;
    uint8_t sigma = 64;
    const symbols s = { 1, &mu, &sigma, NULL };
    const unsigned n = ted4_log2_floor(E);
    const ted4_slots half[2] = { { 0, 32768 }, { 32768, 32768 } };
    ted4_rans_enc e = { 0 };
    ted4_buffer out = { 0 };
    const char *verdict;

    memset(ted4_buffer_add(&out, 4), 0, 4);
    ted4_rans_enc_init(&e, 1);
    ted4_rans_enc_put(&e, ted4_gauss_of(mu, sigma, 1000).slots);
    for (unsigned i = 0; i < n; i++)
        ted4_rans_enc_put(&e, half[1]);
    ted4_rans_enc_put(&e, half[0]);
    for (unsigned i = n; i > 0; i--)
        ted4_rans_enc_put(&e, half[E >> (i - 1) & 1]);
    ted4_rans_enc_finish(&e, &out);
    ted4_store32(out.data, (uint32_t)out.size - 4);
    verdict = read_symbols(out.data, out.size, &s, k);
    ted4_rans_enc_free(&e);
    ted4_buffer_free(&out);
    return verdict;
}

/* hw = 6: k = 8 + e = 7 + E. */
static void escapes(void **state)
{
    int16_t k;

    (void)state;
    assert_string_equal(read_escape(1, &k), "ok");
    assert_int_equal(k, 8);
    assert_string_equal(read_escape(32760, &k), "ok");
    assert_int_equal(k, 32767);
    assert_string_equal(read_escape(32761, &k), "ent.symbol-range");
    assert_string_equal(read_escape((1 << 20) - 1, &k), "ent.symbol-range");
    assert_string_equal(read_escape(1 << 20, &k), "ent.escape");
    assert_string_equal(read_escape(1u << 31, &k), "ent.escape");
}

static void refused_by_the_writer(void **state)
{
    const int32_t mu = 0;
    const uint8_t sigma = 64;
    int16_t k = -32768;
    ted4_writer w;
    uint32_t size;

    (void)state;
    ted4_writer_init(&w);
    w.base.ops->sizes(&w.base, &size, 1);
    w.base.ops->open(&w.base, 1);
    w.base.ops->gauss(&w.base, 1, &mu, &sigma, &k);
    assert_int_equal(w.base.error.code, TED4_E_ENT_SYMBOL_RANGE);
    ted4_writer_finish(&w);
}

/* Reads one symbol with slots [0, 2^15) in each lane, from states set by hand, with some words left
 * over. */
static ted4_status end_of(size_t n, const uint32_t *state, size_t n_lanes, size_t words)
{
    uint8_t data[32] = { 0 };
    const ted4_slots half = { 0, 1 << 15 };
    ted4_rans_dec d;

    for (size_t i = 0; i < n_lanes; i++)
        ted4_store32(data + 4 * i, state[i]);
    assert_int_equal(ted4_rans_dec_init(&d, data, 4 * n_lanes + 2 * words, n), TED4_OK);
    assert_int_equal(d.n_lanes, n_lanes);
    for (size_t i = 0; i < n_lanes; i++) {
        ted4_rans_dec_take(&d, half);
        ted4_rans_dec_next(&d);
    }
    return ted4_rans_dec_finish(&d);
}

/* R-ENT-005, each half of it alone: 2^15 (x / 2^16) + slot is 2^16 for x = 2 2^16, and larger for a
 * larger slot or quotient. */
static void final_state(void **state)
{
    const uint32_t good[2] = { 2u << 16, 2u << 16 }, slot[2] = { 2u << 16, (2u << 16) + 1 },
                   high[2] = { 3u << 16, 2u << 16 };

    (void)state;
    assert_int_equal(end_of(1, good, 1, 0), TED4_OK);
    assert_int_equal(end_of(1, good, 1, 1), TED4_E_ENT_FINAL);
    assert_int_equal(end_of(1, high, 1, 0), TED4_E_ENT_FINAL);
    assert_int_equal(end_of(8192, good, 2, 0), TED4_OK);
    assert_int_equal(end_of(8192, slot, 2, 0), TED4_E_ENT_FINAL);
    assert_int_equal(end_of(8192, high, 2, 0), TED4_E_ENT_FINAL);
    assert_int_equal(end_of(8192, good, 2, 3), TED4_E_ENT_FINAL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip),
        cmocka_unit_test(lanes),
        cmocka_unit_test(bits),
        cmocka_unit_test(damaged),
        cmocka_unit_test(escapes),
        cmocka_unit_test(final_state),
        cmocka_unit_test(refused_by_the_writer),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
