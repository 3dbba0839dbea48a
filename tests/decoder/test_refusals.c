/* test_refusals.c - breaks one rule at a time, and tests identifier and offset of the verdict (spec
 * 14).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <xxhash.h>
#include <zlib.h>

#include "test.h"
#include "random_scene.h"
#include "write/coder_write.h"
#include "write/tiles.h"

enum { MAX_CHUNKS = 16, MAX_PAYLOAD = 1 << 17 };

typedef struct {
    char type[5];
    uint32_t flags, size;
    uint8_t payload[MAX_PAYLOAD];
} chunk;

/* A file that is taken apart, changed, and put together again with correct sizes and hashes. */
static struct {
    uint8_t header[12];
    chunk chunk[MAX_CHUNKS];
    int n;
} pristine, f;

enum { HEAD, NETE, NETR, BANK, POSN, TILE0, TILE1, ENDS };

/* Offsets in the HEAD payload (spec 6.1) of a file with two slices. */
enum {
    N_ANCHORS = 0,
    TILE_SIZE = 4,
    N_OFFSETS = 8,
    FEATURE_DIM = 9,
    MOTION = 10,
    PHI_DIM = 11,
    BANK_ROWS = 12,
    TEMPORAL_MASK = 21,
    HYPER_LAYERS = 31,
    N_SLICES = 34,
    SLICE = 35,
    AR_WIDTH = 37,
    CONTEXT_BITS = 39,
    STEP = 40,
    FRAMES = 60,
    ORIGIN = 72,
    EXPONENT = 84,
    RESERVED = 88
};

static void take_apart(const uint8_t *d, size_t size)
{
    memcpy(f.header, d, 12);
    f.n = 0;
    for (size_t at = 12; at < size; f.n++) {
        chunk *c = &f.chunk[f.n];

        memcpy(c->type, d + at, 4);
        c->flags = ted4_load32(d + at + 4);
        c->size = ted4_load32(d + at + 8);
        assert_true(f.n < MAX_CHUNKS);
        assert_true(c->size < MAX_PAYLOAD);
        memcpy(c->payload, d + at + 12, c->size);
        at += 20 + c->size;
    }
}

static int setup(void **state)
{
    random_source r = random_seed(77);
    const ted4_header h = random_small_header(100);
    ted4_scene *s = random_scene_of(&r, &h, 1);
    uint8_t *d;
    size_t size;

    (void)state;
    s->nete.mode = s->netr.mode = TED4_BLOB_RAW;
    for (size_t i = 0; i < s->bank.n; i++)
        s->bank.values[i] = 0.5f; /* deflates well */
    if (ted4_encode(s, 0, NULL, &d, &size, NULL) != TED4_OK)
        return -1;
    take_apart(d, size);
    pristine = f;
    free(d);
    ted4_scene_free(s);
    return f.n == ENDS + 1 ? 0 : -1;
}

/* Returns where a chunk's type is in the file. */
static size_t place(int number)
{
    size_t at = 12;

    for (int i = 0; i < number; i++)
        at += 20 + f.chunk[i].size;
    return at;
}

static size_t put_together(uint8_t *d)
{
    size_t at = 12;

    memcpy(d, f.header, 12);
    for (int i = 0; i < f.n; i++) {
        const chunk *c = &f.chunk[i];

        memcpy(d + at, c->type, 4);
        ted4_store32(d + at + 4, c->flags);
        ted4_store32(d + at + 8, c->size);
        memcpy(d + at + 12, c->payload, c->size);
        ted4_store64(d + at + 12 + c->size, XXH3_64bits(d + at, 12 + c->size));
        at += 20 + c->size;
    }
    return at;
}

static uint8_t bytes[MAX_CHUNKS * MAX_PAYLOAD / 4];

static void expect_bytes(size_t size, const char *id, size_t offset)
{
    ted4_scene *s;
    ted4_error e;

    (void)ted4_decode(bytes, size, NULL, &s, &e);
    assert_string_equal(ted4_status_id(e.code), id);
    assert_int_equal(s != NULL, e.code == TED4_OK);
    if (e.code != TED4_OK)
        assert_int_equal(e.offset, offset);
    ted4_scene_free(s);
    f = pristine;
}

/* Asserts the verdict on the changed file, then restores the file. */
static void expect(const char *id, size_t offset)
{
    expect_bytes(put_together(bytes), id, offset);
}

/* Returns the offset in the file of byte at of a chunk's payload. */
static size_t at(int number, size_t byte)
{
    return place(number) + 12 + byte;
}

static void set(int number, size_t byte, unsigned width, uint32_t value)
{
    for (unsigned i = 0; i < width; i++)
        f.chunk[number].payload[byte + i] = (uint8_t)(value >> 8 * i);
}

static void expect_set(int number, size_t byte, unsigned width, uint32_t value, const char *id)
{
    const size_t offset = at(number, byte);

    set(number, byte, width, value);
    expect(id, offset);
}

static void drop_chunk(int number)
{
    memmove(&f.chunk[number], &f.chunk[number + 1], (size_t)(--f.n - number) * sizeof f.chunk[0]);
}

static void insert_chunk(int number, const char *type, uint32_t flags)
{
    memmove(&f.chunk[number + 1], &f.chunk[number], (size_t)(f.n++ - number) * sizeof f.chunk[0]);
    strcpy(f.chunk[number].type, type);
    f.chunk[number].flags = flags;
    f.chunk[number].size = 3;
}

static void file_header(void **state)
{
    (void)state;
    expect("ok", 0);
    f.header[3] = 'e';
    expect("con.magic", 0);
    f.header[8] = 2;
    expect("con.version", 8);
    f.header[9] = 200; /* a later minor version */
    expect("ok", 0);
    f.header[10] = 2;
    expect("unsupported.profile", 10);
    f.header[11] = 5;
    expect("con.level", 11);
}

/* No bytes at all, and a null address. */
static void nothing(void **state)
{
    ted4_scene *s;
    ted4_error e;

    (void)state;
    assert_int_equal(ted4_decode(NULL, 0, NULL, &s, &e), TED4_E_CON_TRUNCATED);
    assert_int_equal(e.offset, 0);
    assert_null(s);
}

static void frames(void **state)
{
    size_t n;

    (void)state;
    n = put_together(bytes);
    bytes[at(POSN, 1)] ^= 1;
    expect_bytes(n, "con.chunk-hash", place(POSN));
    n = put_together(bytes);
    bytes[n] = 0;
    expect_bytes(n + 1, "con.trailing", n);
    n = put_together(bytes);
    expect_bytes(n - 1, "con.truncated", n - 1);
    n = place(ENDS);
    put_together(bytes);
    expect_bytes(n, "con.truncated", n);
    f.chunk[NETR].flags = 5;
    expect("con.reserved", place(NETR) + 4);
    f.chunk[NETR].flags = 0;
    expect("con.reserved", place(NETR) + 4);
    insert_chunk(NETR, "ME A", 0);
    expect("con.reserved", place(NETR));
    insert_chunk(NETR, "META", 4);
    expect("con.reserved", place(NETR) + 4);
}

static void order(void **state)
{
    (void)state;
    drop_chunk(NETE);
    expect("con.chunk-order", place(NETE));
    drop_chunk(BANK);
    expect("con.chunk-order", place(BANK));
    drop_chunk(TILE1);
    expect("con.chunk-order", place(TILE1));
    drop_chunk(ENDS);
    expect("con.truncated", place(ENDS));
    f.chunk[f.n++] = f.chunk[ENDS];
    expect("con.trailing", place(ENDS + 1));
    insert_chunk(ENDS, "TILE", 1);
    expect("con.chunk-order", place(ENDS));
    insert_chunk(POSN, "HEAD", 1);
    expect("con.chunk-order", place(POSN));
    insert_chunk(POSN, "XTRA", 1);
    expect("con.unknown-critical", place(POSN));
    insert_chunk(POSN, "XTRA", 2);
    expect("ok", 0);
    insert_chunk(TILE1, "xtr4", 0);
    expect("ok", 0);
    insert_chunk(HEAD, "XTRA", 0);
    expect("con.chunk-order", place(HEAD));
}

/* A file with a BANK whose header says that nothing has a temporal feature. */
static void needless_bank(void **state)
{
    random_source r = random_seed(5);
    ted4_header h = random_small_header(100);
    ted4_scene *s;
    uint8_t *d;
    size_t size;

    (void)state;
    h.motion = TED4_MOTION_INR;
    h.phi_dim = 0;
    h.bank_rows = h.bank_dim = 0;
    s = random_scene_of(&r, &h, 0);
    assert_int_equal(ted4_encode(s, 0, NULL, &d, &size, NULL), TED4_OK);
    take_apart(d, size);
    insert_chunk(BANK, "BANK", 1);
    expect("con.chunk-order", place(BANK));
    free(d);
    ted4_scene_free(s);
}

/* Every payload with one byte too many, and with one too few. */
static void payload_sizes(void **state)
{
    static const size_t first_array[] = { 0, 0, 1, 1, 0, 0, 0, 0 };
    const ted4_header h = random_small_header(100);
    ted4_shape shape;
    size_t units;

    (void)state;
    ted4_shape_make(&shape, &h);
    units = shape.n_units;
    for (int i = HEAD; i <= ENDS; i++) {
        size_t end = at(i, f.chunk[i].size);

        f.chunk[i].payload[f.chunk[i].size++] = 0;
        if (i == TILE0 || i == TILE1)
            end = at(i, 4 + 2 + 12); /* size[] */
        if (i == BANK)               /* deflated */
            expect("net.deflate", at(i, 1));
        else
            expect("con.payload-size", end);
        if (i == TILE0 || i == TILE1 || i == HEAD || i == BANK || i == NETE)
            continue;
        f.chunk[i].size--;
        expect("con.payload-size", at(i, first_array[i]));
    }
    f.chunk[HEAD].size = 3;
    expect("con.payload-size", at(HEAD, 0));
    f.chunk[HEAD].size = 86;
    expect("con.payload-size", at(HEAD, 86));
    f.chunk[TILE0].size = 30;
    expect("con.payload-size", at(TILE0, 18));
    f.chunk[NETE].size = 10;
    expect("con.payload-size", at(NETE, 10));
    f.chunk[NETE].size--;
    expect("con.payload-size", at(NETE, units + 1));
}

static void header_values(void **state)
{
    (void)state;
    expect_set(HEAD, N_ANCHORS, 4, 0, "hdr.range");
    expect_set(HEAD, N_ANCHORS, 4, 1 << 20, "lvl.exceeded");
    expect_set(HEAD, TILE_SIZE, 4, 63, "hdr.range");
    expect_set(HEAD, N_OFFSETS, 1, 17, "hdr.range");
    expect_set(HEAD, N_OFFSETS, 1, 11, "lvl.exceeded");
    expect_set(HEAD, FEATURE_DIM, 1, 129, "hdr.range");
    expect_set(HEAD, MOTION, 1, 4, "hdr.range");
    expect_set(HEAD, PHI_DIM, 1, 33, "hdr.range");
    expect_set(HEAD, PHI_DIM, 1, 0, "hdr.combination");
    expect_set(HEAD, BANK_ROWS, 4, 65, "lvl.exceeded");
    expect_set(HEAD, TEMPORAL_MASK, 1, 2, "hdr.range");
    expect_set(HEAD, HYPER_LAYERS, 1, 5, "hdr.range");
    expect_set(HEAD, N_SLICES, 1, 0, "hdr.range");
    expect_set(HEAD, N_SLICES, 1, 17, "hdr.range");
    expect_set(HEAD, SLICE, 1, 0, "hdr.range");
    expect_set(HEAD, SLICE + 1, 1, 6, "hdr.combination");
    expect_set(HEAD, AR_WIDTH, 2, 0, "hdr.combination");
    expect_set(HEAD, AR_WIDTH, 2, 513, "hdr.range");
    expect_set(HEAD, CONTEXT_BITS, 1, 13, "hdr.range");
    expect_set(HEAD, STEP + 8, 4, 0x357fffff, "hdr.range");
    expect_set(HEAD, STEP + 16, 4, 0x44800001, "hdr.range");
    expect_set(HEAD, STEP, 4, 0xbf800000, "hdr.range");
    expect_set(HEAD, FRAMES, 4, 65, "lvl.exceeded");
    expect_set(HEAD, FRAMES + 4, 4, 1 << 24, "hdr.range");
    expect_set(HEAD, FRAMES + 8, 4, 0, "hdr.range");
    expect_set(HEAD, ORIGIN + 4, 4, 0x80000000, "hdr.range");
    expect_set(HEAD, ORIGIN + 8, 4, 0x7f800000, "hdr.range");
    expect_set(HEAD, EXPONENT, 1, 31, "hdr.range");
    expect_set(HEAD, EXPONENT, 1, 0xe1, "hdr.range"); /* -31 */
    expect_set(HEAD, EXPONENT, 1, 0xe2, "ok");
    expect_set(HEAD, RESERVED, 1, 1, "hdr.range");
    set(HEAD, 19, 2, 512); /* a wide F_deform: more values than level 1 allows */
    set(HEAD, 18, 1, 8);
    expect("lvl.exceeded", at(HEAD, RESERVED));
}

static void networks(void **state)
{
    ted4_shape s;
    const ted4_header h = random_small_header(100);
    size_t mode, w;

    (void)state;
    ted4_shape_make(&s, &h);
    mode = s.n_units;
    w = mode + 1;
    expect_set(NETE, 3, 1, 21, "net.shift");
    expect_set(NETE, s.n_units - 1, 1, 200, "net.shift");
    expect_set(NETE, s.slice[1].first_unit, 1, 1, "net.shift"); /* 1 + 8 - 10 < 0 */
    expect_set(NETE, mode, 1, 2, "net.mode");
    expect_set(NETE, w + 4, 4, 0x7fc00000, "net.value");
    expect_set(NETE, w + 4, 4, 1, "net.value");
    expect_set(NETE, w + 8, 4, 0x80000000, "net.value");
    expect_set(NETE, w + 40, 4, 0x7f000000, "net.weight-range");
    /* two faults that break different rules: the one at the lower offset counts */
    set(NETE, w + 80, 4, 0x7f800000);
    expect_set(NETE, w + 40, 4, 0x7f000000, "net.weight-range");
    expect_set(NETE, w + 4 * 8 * (size_t)s.hyper.dim[0], 4, 0x7f000000,
               "net.accumulator"); /* first bias */
    expect_set(NETR, 0, 1, 3, "net.mode");
    expect_set(NETR, 1 + 400, 4, 0xff800000, "net.value");
    set(BANK, 0, 1, 0);
    expect("con.payload-size", at(BANK, 1));
}

/* Replaces the BANK by these values, deflated at a zlib level. */
static void repack(const uint8_t *raw, uLong n, int level)
{
    uLongf size = MAX_PAYLOAD - 1;

    f.chunk[BANK].payload[0] = 1;
    compress2(f.chunk[BANK].payload + 1, &size, raw, n, level);
    f.chunk[BANK].size = (uint32_t)size + 1;
}

static void deflated(void **state)
{
    uint8_t raw[84] = { 0 };

    (void)state;
    repack(raw, 80, 9); /* 20 zeros: legal, but another bank */
    expect("ok", 0);
    repack(raw, 84, 9);
    expect("net.deflate", at(BANK, 1));
    repack(raw, 76, 9);
    expect("net.deflate", at(BANK, 1));
    repack(raw, 80, 0); /* level 0 only stores: not shorter */
    expect("net.deflate", at(BANK, 1));
    repack(raw, 80, 9);
    f.chunk[BANK].payload[f.chunk[BANK].size++] = 0;
    expect("net.deflate", at(BANK, 1));
    repack(raw, 80, 9);
    f.chunk[BANK].payload[2] |= 0x20; /* FDICT */
    expect("net.deflate", at(BANK, 1));
    repack(raw, 80, 9);
    f.chunk[BANK].payload[f.chunk[BANK].size - 1] ^= 1; /* Adler-32 */
    expect("net.deflate", at(BANK, 1));
    f.chunk[BANK].size = 1;
    expect("net.deflate", at(BANK, 1));
    raw[60] = 0x80; /* sign of value 0 */
    repack(raw, 80, 9);
    expect("net.value", at(BANK, 1));
}

static void positions(void **state)
{
    (void)state;
    expect_set(POSN, 8, 2, 0x7c00, "pos.value");
    expect_set(POSN, 8, 2, 0xfe00, "pos.value");
    expect_set(POSN, 10, 2, 0x8000, "pos.value");
    expect_set(POSN, 0, 2, 0x3c01, "pos.range");
    expect_set(POSN, 14, 2, 0xbc01, "pos.range");
    memcpy(f.chunk[POSN].payload + 60, f.chunk[POSN].payload + 54, 6);
    expect("pos.order", at(POSN, 60));
    set(POSN, 60, 2, 0xbc00); /* smaller than the position before it */
    set(POSN, 62, 2, 0xbc00);
    set(POSN, 64, 2, 0x3c01); /* but its order is not judged: this value is out of range */
    expect("pos.range", at(POSN, 64));
}

static void tiles(void **state)
{
    /* tile_index, dynamic_prob, offset_prob[6], size[7]: masks, two slices, scaling, offset, phi,
     * tau */
    const size_t sizes = 4 + 2 + 12, body = sizes + 28;
    const uint32_t first = ted4_load32(f.chunk[TILE1].payload + sizes);
    const uint32_t second = ted4_load32(f.chunk[TILE1].payload + sizes + 4);

    (void)state;
    expect_set(TILE1, 0, 4, 0, "ent.tile-index");
    expect_set(TILE0, 4, 2, 0, "ent.prob");
    expect_set(TILE0, 16, 2, 0, "ent.prob");
    expect_set(TILE1, sizes, 4, first + 1, "con.payload-size");
    set(TILE1, sizes, 4, first - 1); /* the sum is right, the parts are impossible */
    set(TILE1, sizes + 4, 4, second + 1);
    expect("ent.size", at(TILE1, body));
    set(TILE1, body, 4, 65535);
    expect("ent.state", at(TILE1, body));
    set(TILE1, sizes, 4, first - 2);
    set(TILE1, sizes + 4, 4, second + 2);
    expect("ent.underrun", at(TILE1, body));
    set(TILE1, body + first, 4, 65535);
    expect("ent.state", at(TILE1, body + first));
    memset(f.chunk[TILE1].payload + body + first, 0xff, second);
    expect("ent.escape", at(TILE1, body + first));
    /* the first of two bad tiles */
    set(TILE0, 16, 2, 0);
    set(TILE1, 0, 4, 7);
    expect("ent.prob", at(TILE0, 16));
}

static void hashes(void **state)
{
    (void)state;
    expect_set(ENDS, 0, 1, f.chunk[ENDS].payload[0] ^ 1u, "syn.hash");
}

/* The bytes of a tile that breaks R-ATT-001: the writing walk has produced them before it checks
 * that rule. */
static void tau_order(void **state)
{
    random_source r = random_seed(77);
    const ted4_header h = random_small_header(100);
    ted4_scene *s = random_scene_of(&r, &h, 1);
    ted4_draft d;
    ted4_writer w;
    void *work = aligned_alloc(64, 64 * ((ted4_tile_work_size(s) + 63) / 64));
    uint32_t before = 0;

    (void)state;
    s->symbol[TED4_TAU][70] = 5; /* an anchor of the second tile */
    s->symbol[TED4_TAU][270] = 4;
    assert_int_equal(ted4_draft_init(&d, s), TED4_OK);
    assert_int_equal(ted4_prior_load(&d.prior, s->nete.values, s->shift, NULL), TED4_OK);
    ted4_writer_init(&w);
    ted4_walk_tile(&w.base, &d.s, &d.prior, 1, work);
    assert_int_equal(w.base.error.code, TED4_E_ATT_TAU_ORDER);
    memcpy(f.chunk[TILE1].payload, w.out.data, w.out.size);
    f.chunk[TILE1].size = (uint32_t)w.out.size;
    for (int i = 0; i < 6; i++)
        before += ted4_load32(w.out.data + 18 + 4 * i);
    expect("att.tau-order", at(TILE1, 18 + 28 + before));
    ted4_writer_finish(&w);
    ted4_draft_finish(&d);
    ted4_scene_free(s);
    free(work);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(file_header),   cmocka_unit_test(nothing),
        cmocka_unit_test(frames),        cmocka_unit_test(order),
        cmocka_unit_test(needless_bank), cmocka_unit_test(payload_sizes),
        cmocka_unit_test(header_values), cmocka_unit_test(networks),
        cmocka_unit_test(deflated),      cmocka_unit_test(positions),
        cmocka_unit_test(tiles),         cmocka_unit_test(hashes),
        cmocka_unit_test(tau_order),
    };

    return cmocka_run_group_tests(tests, setup, NULL);
}
