/* test_spec_inflate.c - annex L, as the text prints it, compared with zlib, which the decoder uses:
 * both accept the same streams and give the same bytes. The streams have every kind of block, and
 * each is damaged many times.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "spec_model.h" /* before cmocka, whose fail() is a macro */
#include <stdio.h>
#include <zlib.h>

#include "test.h"
#include "random_scene.h"

enum { N_STREAMS = 60, N_DAMAGES = 2000, MOST = 4096 };

static int zlib_accepts(const uint8_t *in, size_t n_in, uint8_t *out, size_t n_out)
{
    uLongf got = (uLongf)n_out;
    uLong used = (uLong)n_in;

    return uncompress2(out, &got, in, &used) == Z_OK && got == n_out && used == n_in;
}

/* Compares both verdicts and outputs. Returns whether the stream is valid. */
static int same(const uint8_t *in, size_t n_in, size_t n_out)
{
    static uint8_t a[MOST + 1], b[MOST + 1];
    const int ours = inflate_exactly(in, n_in, a, n_out), theirs = zlib_accepts(in, n_in, b, n_out);

    assert_int_equal(ours, theirs);
    if (ours)
        assert_memory_equal(a, b, n_out);
    return ours;
}

/* Bytes with structure, so that all kinds of codes occur. */
static void fill(random_source *r, uint8_t *text, size_t n)
{
    const uint32_t kind = random_in(r, 0, 3), spread = random_in(r, 1, 255);

    for (size_t i = 0; i < n; i++)
        text[i] = kind == 0 || i == 0 ? (uint8_t)random_in(r, 0, spread)
                  : kind == 1
                      ? (uint8_t)(random_in(r, 0, 15) ? text[i - 1] : random_in(r, 0, spread))
                  : kind == 2 ? text[i / 2]
                              : (uint8_t)(i * spread >> 3);
}

static size_t deflated(random_source *r, const uint8_t *text, size_t n, uint8_t *out)
{
    static const int strategy[] = { Z_DEFAULT_STRATEGY, Z_FIXED, Z_HUFFMAN_ONLY, Z_RLE };
    z_stream z;

    memset(&z, 0, sizeof z);
    assert_int_equal(deflateInit2(&z, (int)random_in(r, 0, 9), Z_DEFLATED, (int)random_in(r, 9, 15),
                                  (int)random_in(r, 1, 9), strategy[random_in(r, 0, 3)]),
                     Z_OK);
    z.next_in = (uint8_t *)(uintptr_t)text;
    z.avail_in = (unsigned)(n / 2);
    z.next_out = out;
    z.avail_out = 2 * MOST;
    assert_int_equal(deflate(&z, random_in(r, 0, 1) ? Z_NO_FLUSH : Z_FULL_FLUSH), Z_OK);
    z.avail_in = (unsigned)(n - n / 2);
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    assert_int_equal(deflateEnd(&z), Z_OK);
    return z.total_out;
}

static void damaged(void **state)
{
    static uint8_t text[MOST], stream[2 * MOST], copy[2 * MOST + 1];
    random_source r = random_seed(11);
    unsigned n_valid = 0;

    (void)state;
    for (int i = 0; i < N_STREAMS; i++) {
        const size_t n = random_in(&r, 1, i % 4 ? 300 : MOST);
        size_t size;

        fill(&r, text, n);
        size = deflated(&r, text, n, stream);
        assert_true(same(stream, size, n));
        assert_false(same(stream, size, n + 1));
        assert_false(same(stream, size, n - 1));
        assert_false(same(stream, size - 1, n));
        for (int k = 0; k < N_DAMAGES; k++) {
            memcpy(copy, stream, size);
            copy[size] = 0;
            for (uint32_t c = random_in(&r, 1, 2); c > 0; c--)
                copy[random_in(&r, 0, (uint32_t)(size < 80 || k % 2 ? size : 80) - 1)] ^=
                    (uint8_t)(1u << random_in(&r, 0, 7));
            n_valid += (unsigned)same(copy, size + (k % 16 == 0), n);
        }
    }
    assert_true(n_valid > 10); /* some bits do not matter */
}

/* With a correct checksum, damage is not detected by the check at the end: only the rules on blocks
 * remain. */
static void damaged_and_fixed(void **state)
{
    static uint8_t text[MOST], stream[2 * MOST], out[MOST];
    random_source r = random_seed(12);
    unsigned n_valid = 0, n_wrong = 0;

    (void)state;
    for (int i = 0; i < 20 * N_DAMAGES; i++) {
        const size_t n = random_in(&r, 1, 64);
        size_t size, n_out = n;
        z_stream z;

        if (i % 50 == 0) {
            fill(&r, text, n);
            size = deflated(&r, text, n, stream);
        } else
            size = random_in(&r, 8, 60);
        for (size_t k = 2; k < size && i % 50 != 0; k++)
            stream[k] = (uint8_t)random_u32(&r);
        stream[0] = 0x78;
        stream[1] = 0x01;
        stream[2] = (uint8_t)((stream[2] & ~7u) | 1 | random_in(&r, 0, 2) << 1);
        memset(&z, 0, sizeof z);
        assert_int_equal(inflateInit2(&z, -15), Z_OK);
        z.next_in = stream + 2;
        z.avail_in = (unsigned)size - 2;
        z.next_out = out;
        z.avail_out = MOST;
        if (inflate(&z, Z_FINISH) == Z_STREAM_END && z.total_in + 6 <= 2 * MOST) {
            const uLong sum = adler32(adler32(0, NULL, 0), out, (unsigned)z.total_out);

            n_out = z.total_out;
            size = 2 + z.total_in;
            for (int k = 0; k < 4; k++)
                stream[size++] = (uint8_t)(sum >> (24 - 8 * k));
        }
        (void)inflateEnd(&z);
        if (same(stream, size, n_out))
            n_valid++;
        else
            n_wrong++;
    }
    assert_true(n_valid > 100);
    assert_true(n_wrong > 1000);
}

/* The bits of a stream, the lowest of each byte first. */
typedef struct {
    uint8_t byte[512];
    size_t n;
} bit_string;

static void put_bits(bit_string *b, unsigned value, int n)
{
    for (int i = 0; i < n; i++, b->n++)
        b->byte[b->n / 8] |= (uint8_t)((value >> i & 1) << b->n % 8);
}

/* Chooses lengths of a small code over four symbols: complete, incomplete, oversubscribed, with one
 * symbol or empty. */
static void some_code(random_source *r, uint8_t *length, const int symbol[4])
{
    static const uint8_t choice[][4] = {
        { 1, 0, 0, 0 }, { 1, 1, 0, 0 }, { 1, 2, 2, 0 },  { 2, 2, 2, 2 }, { 2, 2, 2, 0 },
        { 2, 0, 0, 0 }, { 1, 1, 1, 0 }, { 0, 1, 1, 0 },  { 0, 0, 0, 0 }, { 1, 2, 3, 3 },
        { 1, 2, 3, 0 }, { 0, 1, 0, 0 }, { 15, 1, 2, 3 },
    };
    const uint8_t *c = choice[random_in(r, 0, sizeof choice / sizeof *choice - 1)];

    for (int i = 0; i < 4; i++)
        length[symbol[i]] = c[i];
}

/* A dynamic block with these codes, and data. */
static bit_string block_of(const uint8_t *literal, unsigned n_literal, const uint8_t *distance,
                           unsigned n_distance, const uint32_t data[4])
{
    bit_string b = { { 0x78, 0x01 }, 16 };

    put_bits(&b, 1 | 2 << 1, 3);
    put_bits(&b, n_literal - 257, 5);
    put_bits(&b, n_distance - 1, 5);
    put_bits(&b, 15, 4);
    for (int k = 0; k < 19; k++) /* symbols 0 .. 15 of the code length code have 4 bits */
        put_bits(&b, k < 3 ? 0 : 4, 3);
    for (unsigned k = 0; k < n_literal + n_distance; k++)
        for (int bit = 3; bit >= 0; bit--)
            put_bits(&b, (k < n_literal ? literal[k] : distance[k - n_literal]) >> bit & 1, 1);
    for (int k = 0; k < 4; k++)
        put_bits(&b, data[k], 16);
    return b;
}

/* Returns the number of bytes that zlib uses for the blocks alone, or 0 if they are invalid; output
 * in out. */
static size_t blocks_end(const bit_string *b, uint8_t out[MOST], size_t *n_out)
{
    z_stream z;
    int verdict;

    memset(&z, 0, sizeof z);
    assert_int_equal(inflateInit2(&z, -15), Z_OK);
    z.next_in = (uint8_t *)(uintptr_t)b->byte + 2;
    z.avail_in = sizeof b->byte - 2;
    z.next_out = out;
    z.avail_out = MOST;
    verdict = inflate(&z, Z_FINISH);
    (void)inflateEnd(&z);
    *n_out = z.total_out;
    return verdict == Z_STREAM_END ? 2 + z.total_in : 0;
}

static int same_with_sum(bit_string b, size_t end, const uint8_t *out, size_t n_out)
{
    const uLong sum = adler32(adler32(0, NULL, 0), out, (unsigned)n_out);

    b.n = 8 * end;
    memset(b.byte + end, 0, sizeof b.byte - end);
    for (int k = 3; k >= 0; k--)
        put_bits(&b, (unsigned)(sum >> 8 * k & 255), 8);
    return same(b.byte, b.n / 8, n_out);
}

/* One dynamic block with codes of the kinds that R-NET-007 distinguishes, and random bits; and the
 * same with more codes than allowed. */
static void codes(void **state)
{
    static const int literals[4] = { 256, 65, 257, 285 }, distances[4] = { 0, 1, 5, 29 };
    static uint8_t out[MOST];
    random_source r = random_seed(14);
    unsigned n_valid = 0;

    (void)state;
    for (int i = 0; i < 20 * N_DAMAGES; i++) {
        uint8_t literal[288] = { 0 }, distance[32] = { 0 };
        const uint32_t data[4] = { random_u32(&r), random_u32(&r), random_u32(&r), random_u32(&r) };
        bit_string b;
        size_t end, n_out;

        some_code(&r, literal, literals);
        some_code(&r, distance, distances);
        b = block_of(literal, 286, distance, 30, data);
        end = blocks_end(&b, out, &n_out);
        if (end == 0) {
            assert_false(same(b.byte, b.n / 8, n_out));
            continue;
        }
        assert_true(same_with_sum(b, end, out, n_out));
        n_valid++;
        for (size_t more = 0; more < 2;
             more++) { /* 4 or 8 further bits may end in the same byte or in the next */
            assert_false(
                same_with_sum(block_of(literal, 287, distance, 30, data), end + more, out, n_out));
            assert_false(
                same_with_sum(block_of(literal, 288, distance, 30, data), end + more, out, n_out));
            assert_false(
                same_with_sum(block_of(literal, 286, distance, 31, data), end + more, out, n_out));
            assert_false(
                same_with_sum(block_of(literal, 286, distance, 32, data), end + more, out, n_out));
        }
    }
    assert_true(n_valid > 100);
}

/* R-NET-007 "distance": CINFO states a window of 256 bytes, and a distance of 300 is still
 * accepted. */
static void narrow_window(void **state)
{
    static uint8_t text[1024], stream[2 * MOST];
    random_source r = random_seed(13);
    uLongf size = sizeof stream;

    (void)state;
    for (int i = 0; i < 1024; i++)
        text[i] = i < 300 ? (uint8_t)random_u32(&r) : text[i - 300];
    assert_int_equal(compress2(stream, &size, text, sizeof text, 9), Z_OK);
    stream[0] = 0x08;
    stream[1] = 0x1d;
    assert_true(size < 400);
    assert_true(same(stream, size, sizeof text));
    stream[0] = 0x88; /* CINFO = 8 */
    stream[1] = 0x1c;
    assert_int_equal((256 * stream[0] + stream[1]) % 31, 0);
    assert_false(same(stream, size, sizeof text));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged),
        cmocka_unit_test(damaged_and_fixed),
        cmocka_unit_test(codes),
        cmocka_unit_test(narrow_window),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
