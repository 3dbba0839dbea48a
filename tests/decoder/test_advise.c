/* test_advise.c - a validator's advice on valid files: each kind of advice is given for a file that
 * was made to deserve it, and not for a similar one that does not.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <xxhash.h>

#include "test.h"
#include "validate_case.h"

/* Set for each kind of advice that some file below was given. */
static int given[TED4_N_ADVICE];
static const char *const advice_id[TED4_N_ADVICE] = {
#define TED4_FINDING_ERROR(status, ...)
#define TED4_FINDING_ADVICE(name, id, severity, rule, text) id,
#include "read/findings.def"
#undef TED4_FINDING_ERROR
#undef TED4_FINDING_ADVICE
};

/* Asserts that the advice is given (to_be) or not given. */
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
    size_t size;
    uint8_t *data = encoded(s, level, &size);

    expect(data, size, what, to_be);
    free(data);
}

static void advice_on_masks(void **state)
{
    ted4_header h = random_small_header(200);
    ted4_scene *s = useful(1, &h);
    const size_t n = h.n_anchors;

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
    ted4_header h = random_small_header(200);
    const size_t n = h.n_anchors;
    ted4_scene *s = useful(2, &h);

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
    s->head.frames = 2; /* times 0 and 1: the rows between them are not used */
    expect_scene(s, 0, TED4_ADV_BANK_ROWS, 1);
    s->head.frames = 3; /* rows 0, 2, 4 of 5 */
    expect_scene(s, 0, TED4_ADV_BANK_ROWS, 1);
    s->head.frames = 4; /* rows 0, 4/3, 8/3, 4 */
    expect_scene(s, 0, TED4_ADV_BANK_ROWS, 0);
    ted4_scene_free(s);
}

static void advice_on_files(void **state)
{
    ted4_header h = random_small_header(200);
    ted4_scene *s = useful(3, &h);
    size_t size;
    uint8_t *data;

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
    data[9] = 1;
    expect(data, size, TED4_ADV_MINOR, 1);
    free(data);
    ted4_scene_free(s);
}

/* A file with one more chunk after HEAD. */
static void expect_chunk(const uint8_t *data, size_t size, const char *type, uint32_t flags,
                         const char *payload, ted4_advice what, int to_be)
{
    const size_t head = 12 + ted4_chunk_size(data, size, 12), n = strlen(payload), more = 20 + n;
    uint8_t *with = malloc(size + more);

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
    static const char *const wrong[] = { "a=b",         "=b\n",         "ab\n",
                                         "a=\xff\n",    "a=\xc0\x80\n", "a=\xed\xa0\x80\n",
                                         "a=b\n\n",     "a=\x01\n",     "a=\xf5\x80\x80\x80\n",
                                         "a=\xe2\x82\n" };
    static const char *const right[] = { "", "a=b\n",
                                         "a=\nb=\xc3\xa9=\xe2\x82\xac\xf0\x9f\x98\x80\n",
                                         "aa=1\na=1\n" };
    ted4_header h = random_small_header(200);
    ted4_scene *s = useful(4, &h);
    size_t size;
    uint8_t *data = encoded(s, 0, &size);

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
    expect_chunk(data, size, "CAMS", 0, "", TED4_ADV_MINOR, 1);
    data[9] = 1;
    expect_chunk(data, size, "CAMS", 0, "", TED4_ADV_MINOR, 0);
    expect_chunk(data, size, "THMB", 0, "", TED4_ADV_MINOR, 0);
    expect_chunk(data, size, "META", 2, "a=1\n", TED4_ADV_MINOR, 1);
    expect_chunk(data, size, "CAMS", 0, "", TED4_ADV_CHUNK, 0);
    expect_chunk(data, size, "CAMS", 0, "", TED4_ADV_CHUNK_FLAGS, 0);
    expect_chunk(data, size, "CAMS", 2, "", TED4_ADV_CHUNK_FLAGS, 1);
    expect_chunk(data, size, "THMB", 0, "", TED4_ADV_CHUNK, 0);
    expect_chunk(data, size, "THMB", 2, "", TED4_ADV_CHUNK_FLAGS, 1);
    expect_chunk(data, size, "Meta", 2, "a=1\n", TED4_ADV_CHUNK, 1);
    expect_chunk(data, size, "xETA", 0, "", TED4_ADV_PRIVATE, 1);
    expect_chunk(data, size, "xETA", 0, "", TED4_ADV_CHUNK, 0);
    free(data);
    ted4_scene_free(s);
}

/* Makes the hyperprior's last layer give the same outputs for every anchor: b for n outputs from
 * first on. */
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
    ted4_header h = random_small_header(200);
    ted4_scene *s;
    unsigned scaling;

    (void)state;
    s = useful(5, &h);
    scaling = s->shape.first_output[TED4_SCALING];
    expect_scene(s, 0, TED4_ADV_CONTEXT, 0);
    expect_scene(s, 0, TED4_ADV_PROB, 0);
    expect_scene(s, 0, TED4_ADV_PROB_EXTREME, 0);
    set_outputs(s, scaling, 12, 0); /* mu 0, s 0: sigma index 64, a step */
    snap(s);
    memset(s->symbol[TED4_SCALING], 0, 6 * h.n_anchors * sizeof(int16_t));
    expect_scene(s, 0, TED4_ADV_ESCAPES, 0);
    for (size_t i = 0; i < h.n_anchors; i++)
        s->symbol[TED4_SCALING][i] = 100; /* 100 sigma */
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
    s->prob[0] = 40000; /* probability of dynamic, which is 1 for one anchor in five */
    expect_scene(s, 0, TED4_ADV_PROB, 1);
    s->prob[0] = 1;
    expect_scene(s, 0, TED4_ADV_PROB_EXTREME, 1);
    ted4_scene_free(s);
}

/* Runs last: every kind of advice was given for some file. */
static void all_given(void **state)
{
    (void)state;
    given[TED4_ADV_MORE] = given[TED4_ADV_MEMORY] = 1; /* tested in test_validate.c */
    for (int i = 0; i < TED4_N_ADVICE; i++) {
        if (!given[i])
            print_message("%s: never given\n", advice_id[i]);
        assert_true(given[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(advice_on_masks),   cmocka_unit_test(advice_on_time),
        cmocka_unit_test(advice_on_files),   cmocka_unit_test(advice_on_chunks),
        cmocka_unit_test(advice_on_symbols), cmocka_unit_test(all_given),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
