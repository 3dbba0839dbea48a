/* test_validate.c - spec 3.6: a validator finds errors exactly where the strict decoder refuses, that decoder's error first, and finds it by itself too;
 * it goes on behind an error; every kind of advice is given for a file made to deserve it, and its JSON is what its schema says.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmocka.h>
#include <xxhash.h>
#include "../fuzz/counting.h"
#include "../fuzz/mend.h"
#include "../fuzz/mutate.h"
#include "norm/coder.h"
#include "random_scene.h"
#include "read/finding.h"
#include "schema_check.h"

enum { MOST = 400, N_SCENES = 40, N_MUTATIONS = 600 };

/* What a validator has said. */
typedef struct {
    ted4_finding list[MOST];
    int          n, errors;
} findings;

static void keep(void *user, const ted4_finding *f)
{
    findings *all = user;

    assert_true(all->n < MOST);
    assert_non_null(f->id);
    assert_non_null(f->text);
    assert_true(f->rules != NULL && strncmp(f->rules, "R-", 2) == 0);
    all->errors += f->severity == TED4_ERROR;
    assert_int_equal(f->severity == TED4_ERROR, strncmp(f->id, "adv.", 4) != 0);
    all->list[all->n++] = *f;
}

#define ANYWHERE SIZE_MAX

/* How often. */
static int has(const findings *all, const char *id, size_t offset)
{
    int n = 0;

    for (int i = 0; i < all->n; i++)
        n += strcmp(all->list[i].id, id) == 0 && (offset == ANYWHERE || all->list[i].offset == offset);
    return n;
}

/* Validates, with the claims that hold for every byte string. */
static findings *validate(const uint8_t *data, size_t size)
{
    static findings all;
    counting_memory memory = { 0 };
    ted4_options    o = { .allocator = counting_allocator(&memory) };
    ted4_scene     *s;
    ted4_error      e;
    const ted4_status verdict = ted4_decode(data, size, &o, &s, &e);

    all.n = all.errors = 0;
    assert_int_equal(ted4_validate(data, size, &o, keep, &all), verdict);
    assert_int_equal(all.errors > 0, verdict != TED4_OK);
    if (verdict != TED4_OK) {
        assert_string_equal(all.list[0].id, ted4_status_id(e.code));
        assert_int_equal(all.list[0].offset, e.offset);
    }
    for (int i = 0; i < all.n; i++) {
        assert_true(all.list[i].offset <= size);
        if (all.list[i].severity == TED4_ERROR)
            assert_int_equal(has(&all, all.list[i].id, all.list[i].offset), 1);
    }
    if (ted4_status_verdict(verdict) == TED4_INVALID) {
        static findings alone;
        ted4_findings   f = { .data = data, .size = size, .sink = keep, .user = &alone, .verdict = e };

        alone.n = alone.errors = 0;
        assert_int_equal(ted4_collect(&f, &o), TED4_OK);
        assert_true(f.found);
        assert_int_equal(alone.errors + 1, all.errors);
    }
    ted4_scene_free(s);
    assert_int_equal(memory.held, 0);
    return &all;
}

static uint8_t *encoded(const ted4_scene *s, int level, size_t *size)
{
    uint8_t *data = NULL;

    assert_int_equal(ted4_encode(s, level, NULL, &data, size, NULL), TED4_OK);
    return data;
}

static void valid_files(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < N_SCENES; seed++) {
        ted4_scene *s = random_scene(seed);
        size_t      size;
        uint8_t    *data = encoded(s, 0, &size);

        assert_int_equal(validate(data, size)->errors, 0);
        free(data);
        ted4_scene_free(s);
    }
}

static size_t flip(uint8_t *data, size_t size, size_t max_size)
{
    (void)max_size;
    if (size > 0)
        data[size / 2] ^= 1;
    return size;
}

/* Files changed by the fuzzer's mutator, which keeps most of what depends on the change right. */
static void changed_files(void **state)
{
    random_source r = random_seed(11);
    unsigned      refused = 0, several = 0;

    (void)state;
    for (int i = 0; i < N_MUTATIONS; i++) {
        ted4_scene *s = random_scene(random_in(&r, 0, 15));
        size_t      size, max_size;
        uint8_t    *data = encoded(s, 0, &size), *copy;
        findings   *all;

        max_size = 2 * size + 4096;
        copy = malloc(max_size);
        memcpy(copy, data, size);
        for (unsigned n = random_in(&r, 1, 3); n > 0; n--)
            size = fuzz_mutate_file(copy, size, max_size, random_u32(&r), flip);
        all = validate(copy, size);
        refused += all->errors > 0;
        several += all->errors > 1;
        free(copy);
        free(data);
        ted4_scene_free(s);
    }
    assert_true(refused > N_MUTATIONS / 4 && several > N_MUTATIONS / 50);
}

static size_t chunk_at(const uint8_t *data, size_t size, const char *type, int number)
{
    for (size_t at = 12; at < size; at += ted4_chunk_size(data, size, at))
        if (memcmp(data + at, type, 4) == 0 && number-- == 0)
            return at;
    fail();
    return 0;
}

static ted4_header small_header(void)
{
    ted4_header h = random_paper_header(200);

    h.tile_size = 64;
    h.feature_dim = 8;
    h.n_slices = 2;
    h.slice[0] = 3;
    h.slice[1] = 5;
    h.n_offsets = 4;
    h.bank_rows = 5;
    h.bank_dim = 4;
    h.deform_width = h.head_width = h.hyper_width = h.ar_width = 8;
    h.frames = 20;
    return h;
}

/* One error in each of many places: all of them are found. */
static void many_errors(void **state)
{
    enum { HEAD_VIEW = 24, HEAD_RATE = 40 };
    random_source r = random_seed(3);
    ted4_header   h = small_header();
    ted4_scene   *s = random_scene_of(&r, &h, 0);
    size_t        size, nete, netr, bank, posn, tile, ends;
    uint8_t      *data;
    findings     *all;

    (void)state;
    s->nete.mode = s->netr.mode = s->bank.mode = TED4_BLOB_RAW;
    data = encoded(s, 0, &size);
    nete = chunk_at(data, size, "NETE", 0) + 12;
    netr = chunk_at(data, size, "NETR", 0) + 12;
    bank = chunk_at(data, size, "BANK", 0) + 12;
    posn = chunk_at(data, size, "POSN", 0) + 12;
    tile = chunk_at(data, size, "TILE", 2);
    ends = chunk_at(data, size, "ENDS", 0);
    data[nete + 3] = data[nete + 7] = 21;                       /* shifts */
    ted4_store32(data + netr + 1 + 4 * 2, 0x7f800000);          /* values */
    ted4_store32(data + netr + 1 + 4 * 9, 0x80000000);
    ted4_store32(data + bank + 1, 1);
    ted4_store16(data + posn + 6 * 10, 0x8000);                 /* positions */
    memcpy(data + posn + 6 * 50, data + posn + 6 * 49, 6);
    data[ends + 4] = 0;                                         /* flags */
    ted4_mend_chunks(data, size);
    data[tile + 20] ^= 1;                                       /* its hash */
    all = validate(data, size);
    assert_int_equal(has(all, "con.reserved", ends + 4), 1);
    assert_int_equal(has(all, "con.chunk-hash", tile), 1);
    assert_int_equal(has(all, "net.shift", nete + 3), 1);
    assert_int_equal(has(all, "net.shift", nete + 7), 1);
    assert_int_equal(has(all, "net.value", netr + 1 + 8), 1);
    assert_int_equal(has(all, "net.value", netr + 1 + 36), 1);
    assert_int_equal(has(all, "net.value", bank + 1), 1);
    assert_int_equal(has(all, "pos.value", posn + 60), 1);
    assert_int_equal(has(all, "pos.order", posn + 300), 1);
    assert_int_equal(all->errors, 9);
    free(data);

    data = encoded(s, 0, &size);                                /* HEAD: three elements; nothing behind it is judged */
    ted4_store32(data + 24 + 4, 70000);
    data[24 + HEAD_VIEW] = 3;
    ted4_store32(data + 24 + HEAD_RATE, 0);                     /* step[0] */
    data[posn + 1] = 0x7f;
    ted4_mend_chunks(data, size);
    all = validate(data, size);
    assert_int_equal(has(all, "hdr.range", 24 + 4), 1);
    assert_int_equal(has(all, "hdr.range", 24 + HEAD_VIEW), 1);
    assert_int_equal(has(all, "hdr.range", 24 + HEAD_RATE), 1);
    assert_int_equal(all->errors, 3);
    free(data);
    ted4_scene_free(s);
}

/* More errors than are listed: it says so. */
static void too_many(void **state)
{
    random_source r = random_seed(4);
    ted4_header   h = small_header();
    ted4_scene   *s = random_scene_of(&r, &h, 0);
    size_t        size, posn;
    uint8_t      *data = encoded(s, 0, &size);
    findings     *all;

    (void)state;
    posn = chunk_at(data, size, "POSN", 0) + 12;
    for (int i = 0; i < 150; i++)
        ted4_store16(data + posn + 6 * i, 0x7c00);
    ted4_mend_chunks(data, size);
    all = validate(data, size);
    assert_int_equal(all->errors, 100);
    assert_int_equal(has(all, "adv.more", ANYWHERE), 1);
    free(data);
    ted4_scene_free(s);
}

/* ---- advice ---- */

/* Each identifier that some file below was given. */
static int given[TED4_N_ADVICE];
static const char *const advice_id[TED4_N_ADVICE] = {
#define TED4_FINDING_ERROR(status, rules)
#define TED4_FINDING_ADVICE(name, id, severity, rules, text) id,
#include "read/findings.def"
#undef TED4_FINDING_ERROR
#undef TED4_FINDING_ADVICE
};

/* Is the advice given, to_be or not? */
static void expect(const uint8_t *data, size_t size, ted4_advice what, int to_be)
{
    const findings *all = validate(data, size);

    assert_int_equal(all->errors, 0);
    if ((has(all, advice_id[what], ANYWHERE) > 0) != to_be)
        print_message("%s: %s\n", advice_id[what], to_be ? "missing" : "not deserved");
    assert_int_equal(has(all, advice_id[what], ANYWHERE) > 0, to_be);
    given[what] |= to_be;
}

static void expect_scene(const ted4_scene *s, int level, ted4_advice what, int to_be)
{
    size_t   size;
    uint8_t *data = encoded(s, level, &size);

    expect(data, size, what, to_be);
    free(data);
}

/* A scene that deserves nothing that R-ENC-004 speaks of. */
static ted4_scene *useful(uint64_t seed, const ted4_header *h)
{
    random_source r = random_seed(seed);
    ted4_scene   *s = random_scene_of(&r, h, 0);

    assert_non_null(s);
    for (size_t i = 0; i < h->n_anchors; i++)
        if (s->offset_bits[i] == 0)
            s->offset_bits[i] = 1;
    for (size_t i = 0; h->activation && i < h->n_anchors; i++)
        if (s->symbol[TED4_TAU][i] <= 0)
            s->symbol[TED4_TAU][i] = 1;
    random_tidy(s);
    return s;
}

static void advice_on_masks(void **state)
{
    ted4_header   h = small_header();
    ted4_scene   *s = useful(1, &h);
    const size_t  n = h.n_anchors;

    (void)state;
    expect_scene(s, 0, TED4_ADV_STILL, 0);
    expect_scene(s, 0, TED4_ADV_TEMPORAL_MASK, 0);
    expect_scene(s, 0, TED4_ADV_OFFSET_MASK, 0);
    expect_scene(s, 0, TED4_ADV_EMPTY_ANCHORS, 0);
    memset(s->dynamic, 0, n);
    s->offset_bits[7] = 0;
    random_tidy(s);
    expect_scene(s, 0, TED4_ADV_STILL, 1);
    expect_scene(s, 0, TED4_ADV_EMPTY_ANCHORS, 1);
    memset(s->dynamic, 1, n);
    for (size_t i = 0; i < n; i++)
        s->offset_bits[i] = 15;
    expect_scene(s, 0, TED4_ADV_TEMPORAL_MASK, 1);
    expect_scene(s, 0, TED4_ADV_OFFSET_MASK, 1);
    ted4_scene_free(s);
}

static void advice_on_time(void **state)
{
    ted4_header  h = small_header();
    const size_t n = h.n_anchors;
    ted4_scene  *s = useful(2, &h);

    (void)state;
    expect_scene(s, 0, TED4_ADV_ACTIVATION, 0);
    expect_scene(s, 0, TED4_ADV_ONE_FRAME, 0);
    expect_scene(s, 0, TED4_ADV_BANK_CONSTANT, 0);
    expect_scene(s, 0, TED4_ADV_BANK_ROWS, 0);
    for (size_t i = 0; i < n; i++) {
        s->symbol[TED4_TAU][i] = 0;
        s->symbol[TED4_TAU][2 * n + i] = 32767;
    }
    expect_scene(s, 0, TED4_ADV_ACTIVATION, 1);
    s->symbol[TED4_TAU][n - 1] = 1;
    expect_scene(s, 0, TED4_ADV_ACTIVATION, 0);
    for (size_t i = 0; i < s->bank.n; i++)
        s->bank.values[i] = s->bank.values[i % h.bank_dim];
    expect_scene(s, 0, TED4_ADV_BANK_CONSTANT, 1);
    s->head.frames = 1;
    expect_scene(s, 0, TED4_ADV_ONE_FRAME, 1);
    expect_scene(s, 0, TED4_ADV_BANK_ROWS, 1);
    s->head.frames = 2;                 /* times 0 and 1: the rows between are not seen */
    expect_scene(s, 0, TED4_ADV_BANK_ROWS, 1);
    s->head.frames = 3;                 /* 0, 2, 4 of 5 */
    expect_scene(s, 0, TED4_ADV_BANK_ROWS, 1);
    s->head.frames = 4;                 /* 0, 4/3, 8/3, 4 */
    expect_scene(s, 0, TED4_ADV_BANK_ROWS, 0);
    ted4_scene_free(s);
}

static void advice_on_files(void **state)
{
    ted4_header h = small_header();
    ted4_scene *s = useful(3, &h);
    size_t      size;
    uint8_t    *data;

    (void)state;
    for (size_t i = 0; i < s->bank.n; i++)
        s->bank.values[i] = 0.5f;
    s->bank.values[0] = 1;
    expect_scene(s, 0, TED4_ADV_LEVEL, 0);
    expect_scene(s, 3, TED4_ADV_LEVEL, 1);
    expect_scene(s, 0, TED4_ADV_BLOB_RAW, 0);
    s->bank.mode = TED4_BLOB_RAW;
    expect_scene(s, 0, TED4_ADV_BLOB_RAW, 1);
    data = encoded(s, 0, &size);
    expect(data, size, TED4_ADV_MINOR, 0);
    data[9] = 3;
    expect(data, size, TED4_ADV_MINOR, 1);
    free(data);
    ted4_scene_free(s);
}

/* A file with a chunk more, behind HEAD. */
static void expect_chunk(const uint8_t *data, size_t size, const char *type, uint32_t flags, const char *payload,
                         ted4_advice what, int to_be)
{
    const size_t head = 12 + ted4_chunk_size(data, size, 12), n = strlen(payload), more = 20 + n;
    uint8_t     *with = malloc(size + more);

    memcpy(with, data, head);
    memcpy(with + head, type, 4);
    ted4_store32(with + head + 4, flags);
    ted4_store32(with + head + 8, (uint32_t)n);
    memcpy(with + head + 12, payload, n);
    ted4_store64(with + head + 12 + n, XXH3_64bits(with + head, 12 + n));
    memcpy(with + head + more, data + head, size - head);
    expect(with, size + more, what, to_be);
    free(with);
}

static void advice_on_chunks(void **state)
{
    static const char *const wrong[] = { "a=b", "=b\n", "ab\n", "a=\xff\n", "a=\xc0\x80\n", "a=\xed\xa0\x80\n", "a=b\n\n", "a=\x01\n",
                                         "a=\xf5\x80\x80\x80\n", "a=\xe2\x82\n" };
    static const char *const right[] = { "", "a=b\n", "a=\nb=\xc3\xa9=\xe2\x82\xac\xf0\x9f\x98\x80\n", "aa=1\na=1\n" };
    ted4_header h = small_header();
    ted4_scene *s = useful(4, &h);
    size_t      size;
    uint8_t    *data = encoded(s, 0, &size);

    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        expect_chunk(data, size, "META", 2, wrong[i], TED4_ADV_META_TEXT, 1);
    for (size_t i = 0; i < sizeof right / sizeof *right; i++) {
        expect_chunk(data, size, "META", 2, right[i], TED4_ADV_META_TEXT, 0);
        expect_chunk(data, size, "META", 2, right[i], TED4_ADV_META_KEY, 0);
        expect_chunk(data, size, "META", 2, right[i], TED4_ADV_META_FLAGS, 0);
        expect_chunk(data, size, "META", 2, right[i], TED4_ADV_CHUNK, 0);
    }
    expect_chunk(data, size, "META", 2, "a=1\nb=2\na=3\n", TED4_ADV_META_KEY, 1);
    expect_chunk(data, size, "META", 0, "a=1\n", TED4_ADV_META_FLAGS, 1);
    expect_chunk(data, size, "Meta", 2, "a=1\n", TED4_ADV_CHUNK, 1);
    expect_chunk(data, size, "xETA", 0, "", TED4_ADV_PRIVATE, 1);
    expect_chunk(data, size, "xETA", 0, "", TED4_ADV_CHUNK, 0);
    free(data);
    ted4_scene_free(s);
}

/* The hyperprior's last layer says the same for every anchor: b of output o of P. */
static void set_outputs(ted4_scene *s, unsigned first, unsigned n, float b)
{
    const ted4_net_shape *net = &s->shape.hyper;
    const unsigned last = net->n_layers - 1u, in = net->dim[last], out = net->dim[last + 1];
    size_t at = net->first;

    for (unsigned i = 0; i < last; i++)
        at += ((size_t)net->dim[i] + 1) * net->dim[i + 1];
    for (unsigned o = first; o < first + n; o++) {
        memset(s->nete.values + at + (size_t)o * in, 0, in * sizeof(float));
        s->nete.values[at + (size_t)in * out + o] = b;
    }
}

static void snap(ted4_scene *s)
{
    ted4_snap(&s->head, &s->shape, s->nete.values, s->shift);
    assert_int_equal(ted4_scene_steps(s, NULL, NULL), TED4_OK);
}

static void advice_on_symbols(void **state)
{
    ted4_header h = small_header();
    ted4_scene *s;
    unsigned    scaling;

    (void)state;
    s = useful(5, &h);
    scaling = s->shape.first_output[TED4_SCALING];
    expect_scene(s, 0, TED4_ADV_CONTEXT, 0);
    expect_scene(s, 0, TED4_ADV_PROB, 0);
    expect_scene(s, 0, TED4_ADV_PROB_EXTREME, 0);
    set_outputs(s, scaling, 12, 0);                             /* mu 0, s 0: sigma index 64, a step */
    snap(s);
    memset(s->symbol[TED4_SCALING], 0, 6 * h.n_anchors * sizeof(int16_t));
    expect_scene(s, 0, TED4_ADV_ESCAPES, 0);
    for (size_t i = 0; i < h.n_anchors; i++)
        s->symbol[TED4_SCALING][i] = 100;                       /* 100 sigma */
    expect_scene(s, 0, TED4_ADV_ESCAPES, 1);
    expect_scene(s, 0, TED4_ADV_SIGMA, 0);
    set_outputs(s, scaling + 6, 6, -100);
    snap(s);
    expect_scene(s, 0, TED4_ADV_SIGMA, 1);
    set_outputs(s, s->shape.first_step_output, s->shape.n_types, 0);
    snap(s);
    expect_scene(s, 0, TED4_ADV_STEP, 0);
    set_outputs(s, s->shape.first_step_output, 1, 100);
    snap(s);
    expect_scene(s, 0, TED4_ADV_STEP, 1);
    s->symbol[TED4_FEATURE][3] = 32767;
    expect_scene(s, 0, TED4_ADV_CONTEXT, 1);
    s->prob[0] = 40000;                                         /* of dynamic, of which one in five is 1 */
    expect_scene(s, 0, TED4_ADV_PROB, 1);
    s->prob[0] = 1;
    expect_scene(s, 0, TED4_ADV_PROB_EXTREME, 1);
    ted4_scene_free(s);
}

/* Runs last: no advice is left that no file was given. */
static void all_given(void **state)
{
    (void)state;
    given[TED4_ADV_MORE] = 1;           /* above */
    for (int i = 0; i < TED4_N_ADVICE; i++) {
        if (!given[i])
            print_message("%s: never given\n", advice_id[i]);
        assert_true(given[i]);
    }
}

/* ---- the program ---- */

static char folder[] = "/tmp/ted4-validate-XXXXXX";

/* ted4info --validate --json on bytes: its exit code, and what it prints. */
static int run(const uint8_t *data, size_t size, json_t **printed)
{
    char  command[512], path[64];
    FILE *f;
    int   status;

    snprintf(path, sizeof path, "%s/x.ted4", folder);
    f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    fclose(f);
    snprintf(command, sizeof command, "%s/ted4info --validate --json %s", getenv("TED4_BUILD"), path);
    f = popen(command, "r");
    assert_non_null(f);
    *printed = json_loadf(f, 0, NULL);
    status = pclose(f);
    remove(path);
    assert_non_null(*printed);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void expect_run(json_t *schema, const uint8_t *data, size_t size, int code, const char *verdict)
{
    json_t *printed;

    assert_int_equal(run(data, size, &printed), code);
    assert_true(schema_holds(schema, printed));
    assert_string_equal(json_string_value(json_object_get(printed, "verdict")), verdict);
    assert_int_equal(json_array_size(json_object_get(printed, "findings")), validate(data, size)->n);
    json_object_set_new(printed, "more", json_null());
    assert_false(schema_holds(schema, printed));
    json_decref(printed);
}

static void program(void **state)
{
    ted4_header h = small_header();
    ted4_scene *s = useful(6, &h);
    json_t     *schema;
    size_t      size;
    uint8_t    *data;

    (void)state;
    if (getenv("TED4_BUILD") == NULL) {
        print_message("skipped: TED4_BUILD is not set\n");
        ted4_scene_free(s);
        skip();
    }
    schema = json_load_file("conformance/schema/validate.schema.json", 0, NULL);
    assert_non_null(schema);
    assert_non_null(mkdtemp(folder));
    data = encoded(s, 0, &size);
    expect_run(schema, data, size, 0, "valid");
    data[9] = 1;
    expect_run(schema, data, size, 2, "valid");
    data[size - 1] ^= 1;
    expect_run(schema, data, size, 1, "invalid");
    data[10] = 1;
    expect_run(schema, data, size, 1, "unsupported");
    rmdir(folder);
    json_decref(schema);
    free(data);
    ted4_scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(valid_files), cmocka_unit_test(changed_files), cmocka_unit_test(many_errors), cmocka_unit_test(too_many),
        cmocka_unit_test(advice_on_masks), cmocka_unit_test(advice_on_time), cmocka_unit_test(advice_on_files),
        cmocka_unit_test(advice_on_chunks), cmocka_unit_test(advice_on_symbols), cmocka_unit_test(all_given),
        cmocka_unit_test(program),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
