/* test_options.c - train/model/options.h: presets, name=value with every possible error, the hash
 * that ties checkpoints to options, the help table.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "train/model/options.h"

typedef struct {
    const char *name;
    char kind;
    int stage;
    double lo, hi;
} option;

static const option table[] = {
#define TED4_OPTION(kind, stage, name, lo, hi, a, b, c, d, e, help) \
    { #name, #kind[0], stage, lo, hi },
#include "train/model/options.def"
#undef TED4_OPTION
};

enum { N_OPTIONS = (int)(sizeof table / sizeof table[0]) };

static const char *const presets[] = { "draft", "fast", "medium", "slow", "paper" };

static int set_to(ted4_train_options *o, const option *t, double value)
{
    char text[128], why[256] = "";
    int result;

    snprintf(text, sizeof text, "%s=%.17g", t->name, value);
    result = ted4_options_set(o, text, why, sizeof why);
    assert_int_equal((result == 0), (why[0] == '\0'));
    return result;
}

static void test_presets(void **state)
{
    ted4_train_options o;

    (void)state;
    for (size_t p = 0; p < sizeof presets / sizeof presets[0]; p++) {
        memset(&o, 0xff, sizeof o);
        assert_int_equal(ted4_options_preset(&o, presets[p]), 0);
        assert_int_equal(o.seed, 0);
#define TED4_OPTION(kind, stage, name, lo, hi, a, b, c, d, e, help) \
    assert_true((double)o.name >= (lo));                            \
    assert_true((double)o.name <= (hi));                            \
    assert_true((double)o.name == ((const double[]) { a, b, c, d, e })[p]);
#include "train/model/options.def"
#undef TED4_OPTION
    }
    assert_int_equal(ted4_options_preset(&o, "Draft"), -1);
    assert_int_equal(ted4_options_preset(&o, ""), -1);
}

static void test_set(void **state)
{
    ted4_train_options o;

    (void)state;
    assert_int_equal(ted4_options_preset(&o, "medium"), 0);
    for (int i = 0; i < N_OPTIONS; i++) {
        const double span = table[i].hi - table[i].lo;

        assert_int_equal(set_to(&o, &table[i], table[i].lo), 0);
        assert_int_equal(set_to(&o, &table[i], table[i].hi), 0);
        assert_int_equal(set_to(&o, &table[i], table[i].lo - 1), -1);
        assert_int_equal(set_to(&o, &table[i], table[i].hi + 1), -1);
        assert_int_equal(set_to(&o, &table[i], table[i].lo + 0.3125 * (span > 1 ? 1 : span)),
                         table[i].kind == 'I' ? -1 : 0);
    }
    assert_int_equal(o.stage1, 10000000);
    assert_true(o.lambda == 0.3125);
}

static void test_bad_text(void **state)
{
    static const char *const bad[] = {
        "",
        "=",
        "=5",
        "stage1",
        "stage1=",
        "stage1 =5",
        "stage=5",
        "stage11=5",
        "Stage1=5",
        "nothing=1",
        "stage1=five",
        "stage1=5x",
        "stage1=5 ",
        "stage1=5,6",
        "stage1=-1",
        "stage1=nan",
        "stage1=1e99",
        "lambda=nan",
        "lambda=inf",
        "lambda=1e999",
        "lambda=1e-400",
        "lambda=--1",
        "lambda=0.1.2",
        "seed=1",
    };
    ted4_train_options o, before;

    (void)state;
    assert_int_equal(ted4_options_preset(&o, "fast"), 0);
    before = o;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char why[256] = "", narrow[8];

        if (ted4_options_set(&o, bad[i], why, sizeof why) != -1)
            fail_msg("%s was taken", bad[i]);
        assert_non_null(strstr(why, bad[i]));
        assert_non_null(strstr(why, "expected"));
        assert_int_equal(ted4_options_set(&o, bad[i], narrow, sizeof narrow), -1);
        assert_non_null(memchr(narrow, '\0', sizeof narrow));
    }
    assert_memory_equal(&o, &before, sizeof o);
}

/* A change of any single option gives a different hash; an option of stage 2 does not change the
 * hash of stage 1. */
static void test_hash(void **state)
{
    static uint64_t hash[N_OPTIONS + 2];
    ted4_train_options o, base;

    (void)state;
    assert_int_equal(ted4_options_preset(&base, "draft"), 0);
    hash[N_OPTIONS] = ted4_options_hash(&base, 2);
    o = base;
    o.seed = 1;
    hash[N_OPTIONS + 1] = ted4_options_hash(&o, 2);
    for (int i = 0; i < N_OPTIONS; i++) {
        o = base;
        assert_int_equal(set_to(&o, &table[i], table[i].lo), 0);
        if (ted4_options_hash(&o, 2) == hash[N_OPTIONS])
            assert_int_equal(set_to(&o, &table[i], table[i].hi), 0);
        hash[i] = ted4_options_hash(&o, 2);
        assert_int_equal(ted4_options_hash(&o, 2), hash[i]);
        assert_int_equal((ted4_options_hash(&o, 1) == ted4_options_hash(&base, 1)),
                         (table[i].stage == 2));
    }
    for (int i = 0; i < N_OPTIONS + 2; i++)
        for (int k = 0; k < i; k++)
            if (hash[i] == hash[k])
                fail_msg("options %d and %d have one hash", i, k);
}

static void test_help(void **state)
{
    static char text[1 << 15];
    FILE *f = tmpfile();

    (void)state;
    assert_non_null(f);
    ted4_options_help(f);
    rewind(f);
    text[fread(text, 1, sizeof text - 1, f)] = '\0';
    fclose(f);
    for (int i = 0; i < N_OPTIONS; i++)
        assert_non_null(strstr(text, table[i].name));
    for (size_t p = 0; p < sizeof presets / sizeof presets[0]; p++)
        assert_non_null(strstr(text, presets[p]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_presets),  cmocka_unit_test(test_set),
        cmocka_unit_test(test_bad_text), cmocka_unit_test(test_hash),
        cmocka_unit_test(test_help),
    };

    return cmocka_run_group_tests_name("options", tests, NULL, NULL);
}
