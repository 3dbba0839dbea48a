/* test_target.c - the program ted4enc with --target-size and --stage1: the file is at most as large
 * as requested and close to that, and a second run begins where stage 1 ended. The program is taken
 * from $TED4_BUILD (set by tests/run.sh); the test is skipped if that is not set.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <sys/wait.h>
#include <unistd.h>

#include "test.h"
#include "ball_scene.h"

static tiny_folder folder;
static const char *build;

/* Runs ted4enc on the scene with small networks. Returns its exit code; standard error is in
 * FOLDER/err. */
static int encode(const char *arguments)
{
    char command[4096];

    if (build == NULL) {
        print_message("skipped: TED4_BUILD is not set\n");
        skip();
    }

    snprintf(
        command, sizeof command,
        "cd '%s' && '%s'/ted4enc . -f -j1 --preset draft --capacity fixed --iterations 150,250 "
        "--set offsets=4 --set feature=8 --set phi=4"
        " --set bank_dim=8 --set deform_width=8 --set head_width=12 --set hyper_width=8 --set "
        "ar_width=8 --set slices=2"
        " --set octaves=4 --set init_anchors=150 --set max_anchors=260 %s 2>err",
        folder.path, build, arguments);

    const int status = system(command);

    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static long size_of(const char *name)
{
    FILE *f = fopen(tiny_path(&folder, name), "rb");

    assert_non_null(f);
    fseek(f, 0, SEEK_END);

    const long size = ftell(f);

    fclose(f);
    return size;
}

static int contains(const char *name, const char *text)
{
    static char all[1 << 16];
    FILE *f = fopen(tiny_path(&folder, name), "rb");

    assert_non_null(f);
    all[fread(all, 1, sizeof all - 1, f)] = '\0';
    fclose(f);
    return strstr(all, text) != NULL;
}

static int same(const char *a, const char *b)
{
    char command[1024];

    snprintf(command, sizeof command, "cd '%s' && cmp -s %s %s", folder.path, a, b);
    return system(command) == 0;
}

/* Returns how many trials the last search reported, or 0 if it used all of them: a search ends
 * early if a trial comes close enough. */
static int trials(void)
{
    enum { MOST = 8 }; /* as in target.c */
    static char all[1 << 16];
    FILE *f = fopen(tiny_path(&folder, "err"), "rb");
    int n = 0;

    assert_non_null(f);
    all[fread(all, 1, sizeof all - 1, f)] = '\0';
    fclose(f);
    for (const char *at = all; (at = strstr(at, "lambda ")) != NULL; at++)
        n++;
    if (n < 1 || n > MOST)
        fail_msg("%d trials", n);
    return n < MOST ? n : 0;
}

/* A size between those of two lambdas far apart, approached from either side: the result is close
 * to it, or as close as all trials came. */
static void test_met(void **state)
{
    static const char *const lambdas[] = { "1e-5", "1" };
    char arguments[128];
    long size[2], target;

    (void)state;
    for (int i = 0; i < 2; i++) {
        snprintf(arguments, sizeof arguments, "-o end%d.ted4 --lambda %s --stage1 s1", i,
                 lambdas[i]);
        assert_int_equal(encode(arguments), 0);
        size[i] = size_of(i ? "end1.ted4" : "end0.ted4");
    }
    assert_true(size[1] < size[0] * 97 / 100);
    target = (size[0] + size[1]) / 2;
    for (int i = 0; i < 2; i++) {
        snprintf(arguments, sizeof arguments,
                 "-o target.ted4 --lambda %s --target-size %ld --stage1 s1 --json >json",
                 lambdas[i], target);
        if (encode(arguments) != 0)
            fail_msg("%ld bytes were not met", target);

        const int n = trials();
        const long made = size_of("target.ted4"), least = target * (n > 0 ? 98 : 85) / 100;

        if (made > target || made < least)
            fail_msg("%ld bytes asked for, %ld made", target, made);
        /* Time per step: the steps of all trials count, as their time does. */
        snprintf(arguments, sizeof arguments, "\"steps\":%d,", 150 + 250 * (n > 0 ? n : 8));
        assert_true(contains("json", arguments));
    }
}

static void test_not_met(void **state)
{
    (void)state;
    assert_int_equal(encode("-o small.ted4 --target-size 500"), 2);
    assert_true(contains("err", "warning"));
    assert_true(size_of("small.ted4") > 500);
    assert_true(size_of("small.ted4") < size_of("end0.ted4"));
}

/* A lambda that leaves no Gaussian bounds the search, which goes on below it: the first one that is
 * tried, which cannot be used by itself, or a later one. */
static void test_too_high(void **state)
{
    const char name[] = "high.ted4", most[] = "--iterations 150,1200 --set mask_weight=1";
    char arguments[160];

    (void)state;
    snprintf(arguments, sizeof arguments, "-o %s %s --lambda 10", name, most);
    assert_int_equal(encode(arguments), 3);
    assert_true(contains("err", "nothing is left to encode: at lambda 10, every Gaussian"));
    assert_int_equal(access(tiny_path(&folder, name), F_OK), -1);
    for (int i = 0; i < 2; i++) {
        snprintf(arguments, sizeof arguments, "-o %s %s --lambda %s --target-size 500", name, most,
                 i ? "0.1" : "10");
        assert_int_equal(encode(arguments), 2);
        assert_true(contains("err", "no Gaussian is left"));
        assert_true(contains("err", "this is the smallest file"));
        assert_true(size_of(name) > 500);
    }
}

/* The same file results from a shared end of stage 1, which the run does not write again; that of
 * another scene or of other options is refused. */
static void test_stage1(void **state)
{
    (void)state;
    assert_int_equal(encode("-o whole.ted4 --lambda 0.01"), 0);
    assert_int_equal(encode("-o first.ted4 --stage1 s2"), 0);
    assert_int_equal(encode("-o shared.ted4 --lambda 0.01 --stage1 s2"), 0);
    assert_true(same("whole.ted4", "shared.ted4"));
    assert_true(!same("whole.ted4", "first.ted4"));
    assert_int_equal(encode("-o other.ted4 --set view=0 --stage1 s2"), 3);
    assert_true(contains("err", "s2: not a checkpoint"));
    assert_int_equal(access(tiny_path(&folder, "other.ted4"), F_OK), -1);
}

/* A search that was interrupted begins again at the end of stage 1, where the checkpoint is, and
 * gives the same file. */
static void test_resumed(void **state)
{
    char arguments[128];
    const char stage1[] = "\"stage\":\"1\"";

    (void)state;
    for (int i = 0; i < 2; i++) {
        snprintf(arguments, sizeof arguments,
                 "-o searched%d.ted4 --target-size %ld --checkpoint search --resume --log "
                 "searched%d.jsonl",
                 i, (size_of("end0.ted4") + size_of("end1.ted4")) / 2, i);
        assert_int_equal(encode(arguments), 0);
    }
    assert_true(same("searched0.ted4", "searched1.ted4"));
    assert_true(contains("searched0.jsonl", stage1));
    assert_true(!contains("searched1.jsonl", stage1));
}

/* A checkpoint of stage 2 contains only the lambda with which it was made: no search can begin
 * there, and the end of stage 1 cannot be written. */
static void test_too_late(void **state)
{
    (void)state;
    assert_int_equal(encode("-o late.ted4 --checkpoint late --checkpoint-every 0 --lambda 0.01"),
                     0);
    assert_int_equal(
        encode("-o later.ted4 --lambda 0.01 --checkpoint late --resume --target-size 20000"), 3);
    assert_true(
        contains("err", "late: inside stage 2; a search for a size begins at the end of stage 1"));
    assert_int_equal(access(tiny_path(&folder, "later.ted4"), F_OK), -1);
    assert_int_equal(
        encode("-o later.ted4 --lambda 0.01 --checkpoint late --resume --stage1 never"), 0);
    assert_true(contains("err", "warning: never is not written: stage 1 is over in late"));
    assert_int_equal(access(tiny_path(&folder, "never"), F_OK), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_met),      cmocka_unit_test(test_not_met),
        cmocka_unit_test(test_stage1),   cmocka_unit_test(test_resumed),
        cmocka_unit_test(test_too_high), cmocka_unit_test(test_too_late),
    };

    build = getenv("TED4_BUILD");
    folder = tiny_new();
    ball_scene(&folder, 5, 1);

    const int failed = cmocka_run_group_tests(tests, NULL, NULL);

    tiny_free(&folder);
    return failed;
}
