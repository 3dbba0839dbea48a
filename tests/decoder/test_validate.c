/* test_validate.c - spec 3.6: a validator finds errors exactly if the strict decoder refuses the
 * file, and that decoder's error comes first, also if the validator searches on its own; it
 * continues after an error, and its JSON conforms to its schema.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>

#include "test.h"
#include "fuzz/mutate.h"
#include "run_json.h"
#include "schema_check.h"
#include "validate_case.h"
#include "vector_files.h"

enum { N_SCENES = 40, N_MUTATIONS = 600, MANY_VECTORS = 600 };

static void valid_files(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < N_SCENES; seed++) {
        ted4_scene *s = random_scene(seed);
        size_t size;
        uint8_t *data = encoded(s, 0, &size);

        assert_int_equal(validate(data, size)->errors, 0);
        free(data);
        ted4_scene_free(s);
    }
}

/* Files changed by the fuzzer's mutator, which corrects most of what depends on the change. */
static void changed_files(void **state)
{
    random_source r = random_seed(11);
    unsigned refused = 0, several = 0;

    (void)state;
    for (int i = 0; i < N_MUTATIONS; i++) {
        ted4_scene *s = random_scene(random_in(&r, 0, 15));
        size_t size, max_size;
        uint8_t *data = encoded(s, 0, &size), *copy;
        findings *all;

        max_size = 2 * size + 4096;
        copy = malloc(max_size);
        memcpy(copy, data, size);
        for (unsigned n = random_in(&r, 1, 3); n > 0; n--)
            size = fuzz_mutate_file(copy, size, max_size, random_u32(&r), fuzz_flip_middle);
        all = validate(copy, size);
        refused += all->errors > 0;
        several += all->errors > 1;
        free(copy);
        free(data);
        ted4_scene_free(s);
    }
    assert_true(refused > N_MUTATIONS / 4);
    assert_true(several > N_MUTATIONS / 50);
}

/* One error in each of many places; all of them are found. */
static void many_errors(void **state)
{
    enum { HEAD_VIEW = 24, HEAD_RATE = 40 };
    random_source r = random_seed(3);
    ted4_header h = random_small_header(200);
    ted4_scene *s = random_scene_of(&r, &h, 0);
    size_t size, nete, netr, bank, posn, tile, ends;
    uint8_t *data;
    findings *all;

    (void)state;
    s->nete.mode = s->netr.mode = s->bank.mode = TED4_BLOB_RAW;
    data = encoded(s, 0, &size);
    nete = chunk_at(data, size, "NETE", 0) + 12;
    netr = chunk_at(data, size, "NETR", 0) + 12;
    bank = chunk_at(data, size, "BANK", 0) + 12;
    posn = chunk_at(data, size, "POSN", 0) + 12;
    tile = chunk_at(data, size, "TILE", 2);
    ends = chunk_at(data, size, "ENDS", 0);
    data[nete + 3] = data[nete + 7] = 21;              /* shifts */
    ted4_store32(data + netr + 1 + 4 * 2, 0x7f800000); /* values */
    ted4_store32(data + netr + 1 + 4 * 9, 0x80000000);
    ted4_store32(data + bank + 1, 1);
    ted4_store16(data + posn + 6 * 10, 0x8000); /* positions */
    memcpy(data + posn + 6 * 50, data + posn + 6 * 49, 6);
    data[ends + 4] = 0; /* flags */
    ted4_fix_hashes(data, size);
    data[tile + 20] ^= 1; /* its hash */
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

    data = encoded(s, 0, &size); /* HEAD: three elements; nothing after it is checked */
    ted4_store32(data + 24 + 4, 70000);
    data[24 + HEAD_VIEW] = 3;
    ted4_store32(data + 24 + HEAD_RATE, 0); /* step[0] */
    data[posn + 1] = 0x7f;
    ted4_fix_hashes(data, size);
    all = validate(data, size);
    assert_int_equal(has(all, "hdr.range", 24 + 4), 1);
    assert_int_equal(has(all, "hdr.range", 24 + HEAD_VIEW), 1);
    assert_int_equal(has(all, "hdr.range", 24 + HEAD_RATE), 1);
    assert_int_equal(all->errors, 3);
    free(data);
    ted4_scene_free(s);
}

/* More errors than are listed: a finding says so. */
static void too_many(void **state)
{
    random_source r = random_seed(4);
    ted4_header h = random_small_header(200);
    ted4_scene *s = random_scene_of(&r, &h, 0);
    size_t size, posn;
    uint8_t *data = encoded(s, 0, &size);
    findings *all;

    (void)state;
    posn = chunk_at(data, size, "POSN", 0) + 12;
    for (int i = 0; i < 150; i++)
        ted4_store16(data + posn + 6 * i, 0x7c00);
    ted4_fix_hashes(data, size);
    all = validate(data, size);
    assert_int_equal(all->errors, 100);
    assert_int_equal(has(all, "adv.more", ANYWHERE), 1);
    free(data);
    ted4_scene_free(s);
}

/* Nearly all vectors of the suite that break a rule break only that one, so nothing else must be
 * found in them. (Vectors on precedence, which contain several errors on purpose, are not counted.)
 * The exceptions, by parts of their paths; conformance/GAPS.md explains them. */
static const char *const of_several[] = {
    "/levels/",           "/NEG-range-feature_dim-", "/NEG-range-slice0-",
    "/NEG-range-motion-", "/NEG-range-head_layers-", "/NEG-range-hyper_layers-",
    "/NEG-size-HEAD-",    "/NEG-swapped-",           "/NEG-tile-swapped.",
    "-wrong-before."
};
static int n_negative, n_alone, n_unexplained;

static int explained(const char *path)
{
    for (size_t i = 0; i < sizeof of_several / sizeof *of_several; i++)
        if (strstr(path, of_several[i]) != NULL)
            return 1;
    return 0;
}

/* Returns whether the vector's descriptor names that rule. */
static int is_named(const char *path, const char *rule)
{
    char name[1024];
    json_t *d, *rules;
    int named = 0;

    snprintf(name, sizeof name, "%.*s.json", (int)(strlen(path) - strlen(".ted4")), path);
    d = json_load_file(name, 0, NULL);
    assert_non_null(d);
    rules = json_object_get(d, "rules");
    for (size_t i = 0; i < json_array_size(rules); i++)
        named |= strcmp(json_string_value(json_array_get(rules, i)), rule) == 0;
    json_decref(d);
    return named;
}

static void count_errors(const uint8_t *data, size_t size, const char *path)
{
    const findings *all = validate(data, size);
    const int n = all->errors;

    if (!is_named(path, all->list[0].rule)) {
        print_error("%s: %s is no rule of it\n", path, all->list[0].rule);
        n_unexplained++;
    }
    if (strstr(path, "/precedence/") != NULL)
        return;
    n_alone += n == 1;
    n_negative++;
    if (n != 1 && !explained(path)) {
        print_error("%s: %d errors\n", path, n);
        n_unexplained++;
    }
}

static void negative_vectors(void **state)
{
    (void)state;
    each_vector("-path '*/invalid/*'", count_errors);
    print_message("%d of %d vectors hold one error and no other\n", n_alone, n_negative);
    assert_true(n_alone >= MANY_VECTORS);
    assert_true(10 * n_alone >= 9 * n_negative);
    assert_int_equal(n_unexplained, 0);
}

/* Lets every allocation fail, alone and with all later ones: the strict decoder's verdict stays,
 * whatever a validator looks for beyond it, and all memory is freed. */
static void starve(const uint8_t *data, size_t size)
{
    static findings all;
    ted4_status verdict;
    int calm = 0, hints = 0;

    for (uint64_t n = 1; !calm; n++) {
        counting_memory memory = { .fail_at = n, .fail_on = 1 };
        ted4_options o = { .allocator = counting_allocator(&memory) };
        ted4_salvage what;
        ted4_scene *s;

        verdict = ted4_decode(data, size, &o, &s, NULL);
        ted4_scene_free(s);
        memory = (counting_memory) { .fail_at = n, .fail_on = 1 };
        all.n = all.errors = 0;
        assert_int_equal(ted4_validate(data, size, &o, keep, &all), verdict);
        assert_int_equal(all.errors > 0, verdict != TED4_OK);
        assert_int_equal(memory.held, 0);
        calm = memory.n < n;
        assert_true(has(&all, "adv.memory", 0) <= !calm);
        assert_true(has(&all, "limit.memory", ANYWHERE) <= (verdict == TED4_E_LIMIT_MEMORY));
        hints += has(&all, "adv.memory", 0);
        memory = (counting_memory) { .fail_at = n, .fail_on = 1 };
        (void)ted4_decode_lenient(data, size, &o, &s, &what);
        ted4_scene_free(s);
        assert_int_equal(memory.held, 0);
        calm &= memory.n < n;
    }
    assert_true(hints > 0);
}

static void no_memory(void **state)
{
    random_source r = random_seed(8);
    ted4_header h = random_small_header(200);
    ted4_scene *s = random_scene_of(&r, &h, 0);
    size_t size;
    uint8_t *data = encoded(s, 0, &size);

    (void)state;
    starve(data, size);
    starve(data, size - 100);
    data[chunk_at(data, size, "TILE", 2) + 30] ^= 1;
    ted4_fix_hashes(data, size);
    starve(data, size);
    free(data);
    ted4_scene_free(s);
}

/* ---- the program ---- */

static void expect_run(json_t *schema, const uint8_t *data, size_t size, int code,
                       const char *verdict)
{
    json_t *printed;

    assert_int_equal(run_json("ted4info --validate --json", data, size, &printed), code);
    assert_true(schema_holds(schema, printed));
    assert_string_equal(json_string_value(json_object_get(printed, "verdict")), verdict);
    assert_int_equal(json_array_size(json_object_get(printed, "findings")),
                     validate(data, size)->n);
    json_object_set_new(printed, "more", json_null());
    assert_false(schema_holds(schema, printed));
    json_decref(printed);
}

static void program(void **state)
{
    ted4_header h = random_small_header(200);
    ted4_scene *s = useful(6, &h);
    json_t *schema;
    size_t size;
    uint8_t *data;

    (void)state;
    if (getenv("TED4_BUILD") == NULL) {
        print_message("skipped: TED4_BUILD is not set\n");
        ted4_scene_free(s);
        skip();
    }
    schema = json_load_file("conformance/schema/validate.schema.json", 0, NULL);
    assert_non_null(schema);
    data = encoded(s, 0, &size);
    expect_run(schema, data, size, 0, "valid");
    data[9] = 1;
    expect_run(schema, data, size, 2, "valid");
    data[size - 1] ^= 1;
    expect_run(schema, data, size, 1, "invalid");
    data[10] = 2;
    expect_run(schema, data, size, 1, "unsupported");
    json_decref(schema);
    free(data);
    ted4_scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(valid_files),      cmocka_unit_test(changed_files),
        cmocka_unit_test(many_errors),      cmocka_unit_test(too_many),
        cmocka_unit_test(negative_vectors), cmocka_unit_test(no_memory),
        cmocka_unit_test(program),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
