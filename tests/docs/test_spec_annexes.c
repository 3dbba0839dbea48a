/* test_spec_annexes.c - annexes A, B, C and H, and the hashes of functions in annex J, equal what
 * their generators print now, and the lints of the specification pass. Runs in the top folder, as
 * make does.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "tests/gen/annex_b_compact.h" /* before cmocka, whose fail() is a macro */
#include "tests/gen/annex_a.h"
#include "tests/gen/annex_c.h"
#include "tests/gen/annex_h.h"
#include "tests/gen/attest.h"
#include "test.h"
#include <jansson.h>

/* Returns the contents of a file, to be freed by the caller. Fails the test if the file cannot be
 * read. */
static char *contents(const char *path, size_t *size)
{
    FILE *f = fopen(path, "rb");
    char *text;

    if (f == NULL)
        print_error("%s: cannot be read\n", path);
    assert_non_null(f);
    assert_int_equal(fseek(f, 0, SEEK_END), 0);
    *size = (size_t)ftell(f);
    rewind(f);
    text = malloc(*size + 1);
    assert_int_equal(fread(text, 1, *size, f), *size);
    fclose(f);
    return text;
}

static void current(const char *path, void (*print)(FILE *out))
{
    char *made = NULL, *kept;
    size_t n_made = 0, n_kept;
    FILE *out = open_memstream(&made, &n_made);

    assert_non_null(out);
    print(out);
    fclose(out);
    kept = contents(path, &n_kept);
    if (n_made != n_kept || memcmp(made, kept, n_made) != 0)
        print_error("%s is not what its generator prints: make spec-annexes\n", path);
    assert_int_equal(n_made, n_kept);
    assert_memory_equal(made, kept, n_made);
    free(made);
    free(kept);
}

static void tables(void **state)
{
    (void)state;
    current("spec/annex-a-tables.md", annex_a);
}

static void examples(void **state)
{
    (void)state;
    current("spec/annex-b-examples.md", annex_b_all);
}

static void levels(void **state)
{
    (void)state;
    current("spec/annex-c-levels.md", annex_c);
}

static void limits(void **state)
{
    (void)state;
    current("spec/annex-h-limits.md", annex_h);
}

/* Each line that attest_short and attest_samples print, one for each function, stands in annex
 * J.9. */
static void functions(void **state)
{
    size_t n = 0, n_rows = 0, n_seen = 0;
    char *rows = NULL, *text = contents("spec/annex-j-dumps.md", &n);
    FILE *out = open_memstream(&rows, &n_rows);

    (void)state;
    text[n] = 0;
    assert_non_null(out);
    attest_short(out);
    attest_samples(out);
    fclose(out);
    for (char *row = strtok(rows, "\n"); row != NULL; row = strtok(NULL, "\n")) {
        if (strstr(text, row) == NULL)
            print_error("spec/annex-j-dumps.md: J.9 lacks: %s\n", row);
        assert_non_null(strstr(text, row));
        n_seen++;
    }
    assert_int_equal(n_seen, 9);
    free(rows);
    free(text);
}

/* The index of rules and the table of errors are valid JSON for programs. */
static void indices(void **state)
{
    json_t *const rules = json_load_file("spec/rules.json", JSON_REJECT_DUPLICATES, NULL);
    json_t *const errors = json_load_file("spec/errors.json", JSON_REJECT_DUPLICATES, NULL);

    (void)state;
    assert_int_equal(json_array_size(json_object_get(errors, "errors")), TED4_N_STATUS - 1);
    assert_true(json_array_size(json_object_get(rules, "rules")) > 100);
    json_decref(rules);
    json_decref(errors);
}

/* No valid file of the profile is shorter; B.1 and B.3 explain why. */
static void smallest(void **state)
{
    size_t size;
    uint8_t *data = annex_b_encode(annex_b_smallest(), &size);

    (void)state;
    assert_int_equal(size,
                     12 + 6 * 20 + 88 + (23 + 1 + 11) + (1 + 11) + 6 + (4 + 3 * 4 + 3 * 4) + 16);
    free(data);
    data = annex_b_encode(annex_b_smallest_compact(), &size);
    assert_int_equal(size, 12 + 6 * 20 + 88 + (23 + 1 + 4) + (1 + 11) + (1 + 4) +
                               (4 + 3 * 4 + 3 * 4) + 16);
    free(data);
}

static void lints(void **state)
{
    static const char *const lint[] = { "errors", "sections", "spec_rules", "spec_text",
                                        "spec_json" };

    (void)state;
    for (size_t i = 0; i < sizeof lint / sizeof *lint; i++) {
        char command[64];

        snprintf(command, sizeof command, "sh tests/lint/%s.sh", lint[i]);
        assert_int_equal(system(command), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables),   cmocka_unit_test(examples),  cmocka_unit_test(levels),
        cmocka_unit_test(limits),   cmocka_unit_test(functions), cmocka_unit_test(indices),
        cmocka_unit_test(smallest), cmocka_unit_test(lints),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
