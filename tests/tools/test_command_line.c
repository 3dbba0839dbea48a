/* test_command_line.c - the parsing of the programs' command lines: file name patterns, times,
 * numbers, options from a table. The programs' helpers are in no library, so their sources are
 * included here.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tool/arguments.h"
#include "tool/output.h"
#include "tool/times.h"

static void expect_path(const char *pattern, uint32_t number, const char *want)
{
    char path[TED4_PATH_SIZE];

    assert_int_equal(ted4_pattern_make(path, pattern, number), 0);
    assert_string_equal(path, want);
}

static void test_patterns(void **state)
{
    static const char *const bad[] = { "%",    "a%s.ply", "%d%d", "a%%d", "%0d", "%-3d",
                                       "%10d", "%1$d",    "%ld",  "%n",   "%5",  "%d %" };

    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(ted4_pattern_count(bad[i]), -1);
    assert_int_equal(ted4_pattern_count("plain.ply"), 0);
    assert_int_equal(ted4_pattern_count("d/frame_%05d.ply"), 1);
    expect_path("d/frame_%05d.ply", 42, "d/frame_00042.ply");
    expect_path("%d", 1234567, "1234567");
    expect_path("%3d_", 7, "  7_");
    expect_path("plain.ply", 7, "plain.ply");
}

static void expect_range(const char *text, uint32_t first, uint32_t end, uint32_t step)
{
    ted4_range r;

    assert_int_equal(ted4_range_parse(text, &r), 0);
    assert_int_equal(r.first, first);
    assert_int_equal(r.end, end);
    assert_int_equal(r.step, step);
}

static void expect_time(const char *text, uint32_t num, uint32_t den)
{
    ted4_time t;

    assert_int_equal(ted4_time_parse(text, &t), 0);
    assert_int_equal(t.num, num);
    assert_int_equal(t.den, den);
}

static void test_times(void **state)
{
    static const char *const bad_range[] = { "",      "x",  "1:2:3:4", "5:5",        "5:3",
                                             "1:9:0", "-1", "1: 2",    "4294967295", ":x" };
    static const char *const bad_time[] = { "",     "1.5",        "2",    "-0.1",     "3/2",
                                            "1/0",  "1/16777216", "0.",   ".",        "0.12345678",
                                            "1/2x", "nan",        "1e-1", "1.0000001" };
    ted4_range r;
    ted4_time t;

    (void)state;
    expect_range(":", 0, UINT32_MAX, 1);
    expect_range("7", 7, 8, 1);
    expect_range("3:", 3, UINT32_MAX, 1);
    expect_range(":9", 0, 9, 1);
    expect_range("::4", 0, UINT32_MAX, 4);
    expect_range("2:20:3", 2, 20, 3);
    expect_time("0", 0, 1);
    expect_time("1", 1, 1);
    expect_time("1.0", 10, 10);
    expect_time(".5", 5, 10);
    expect_time("0.0333333", 333333, 10000000);
    expect_time("7/30", 7, 30);
    for (size_t i = 0; i < sizeof bad_range / sizeof *bad_range; i++)
        assert_int_equal(ted4_range_parse(bad_range[i], &r), -1);
    for (size_t i = 0; i < sizeof bad_time / sizeof *bad_time; i++)
        assert_int_equal(ted4_time_parse(bad_time[i], &t), -1);
    t = ted4_time_of_part(1.0 / 3.0);
    assert_int_equal(t.num, 3333333);
    assert_int_equal(t.den, 10000000);
    t = ted4_time_of_part(1.0);
    assert_int_equal(t.num, t.den);
    t = ted4_time_of_frame(3, 10);
    assert_int_equal(t.num, 3);
    assert_int_equal(t.den, 9);
    t = ted4_time_of_frame(0, 1);
    assert_int_equal(t.num, 0);
    assert_int_equal(t.den, 1);
    t = ted4_time_of_frame(5, 1u << 24);
    assert_int_equal(t.num, 5);
    assert_int_equal(t.den, (1u << 24) - 1);
    t = ted4_time_of_frame(3u << 23, (1u << 25) + 1); /* 3 2^23 / 2^25 = 3 / 4 */
    assert_int_equal(t.num, 3);
    assert_int_equal(t.den, 4);
    t = ted4_time_of_frame(UINT32_MAX / 2, UINT32_MAX); /* (2^31 - 1) / (2^32 - 2) = 1 / 2 */
    assert_int_equal(t.num, 1);
    assert_int_equal(t.den, 2);
    t = ted4_time_of_frame(UINT32_MAX - 2,
                           UINT32_MAX); /* (2^32 - 3) / (2^32 - 2): 16777214.996 of 2^24 - 1 */
    assert_int_equal(t.num, (1u << 24) - 1);
    assert_int_equal(t.den, (1u << 24) - 1);
    t = ted4_time_of_frame(1000000001, UINT32_MAX); /* 3906249.77 of 2^24 - 1 */
    assert_int_equal(t.num, 3906250);
    assert_int_equal(t.den, (1u << 24) - 1);
    t = ted4_time_of_frame(29, (1u << 25) - 1); /* 14.5 and 5.5 of 2^24 - 1: rounded to even */
    assert_int_equal(t.num, 14);
    assert_int_equal(t.den, (1u << 24) - 1);
    t = ted4_time_of_frame(11, (1u << 25) - 1);
    assert_int_equal(t.num, 6);
    assert_int_equal(t.den, (1u << 24) - 1);
}

static void expect_second(const char *text, uint32_t frames, uint32_t rate_num, uint32_t rate_den,
                          uint32_t num, uint32_t den)
{
    ted4_seconds s;

    assert_int_equal(ted4_seconds_parse(text, &s), 0);
    const ted4_time t = ted4_time_of_seconds(s, frames, rate_num, rate_den);

    if (t.num != num || t.den != den)
        fail_msg("%s: %u/%u, expected %u/%u", text, (unsigned)t.num, (unsigned)t.den, (unsigned)num,
                 (unsigned)den);
}

/* R-MED-001, with exact fractions. */
static void test_seconds(void **state)
{
    static const char *const bad[] = { "",         "s",   "1",   "1.s",         ".s",  "-1s",
                                       "1000000s", "1.5", "1 s", "0.12345678s", "1s ", "nans" };
    ted4_seconds s;

    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(ted4_seconds_parse(bad[i], &s), -1);
    expect_second("0s", 60, 30, 1, 0, 1);
    expect_second("1s", 61, 30, 1, 1, 2);
    expect_second("1.5s", 61, 30, 1, 3, 4);
    expect_second(".5s", 61, 30, 1, 1, 4);
    expect_second("1.50s", 61, 30, 1, 3, 4);
    expect_second("0.5s", 16, 30000, 1001, 1000, 1001); /* 15 frames of 30000/1001 end at 0.5005 */
    expect_second("0.5005s", 16, 30000, 1001, 1, 1);
    expect_second("99s", 61, 30, 1, 1, 1);
    expect_second("99s", 1, 30, 1, 0, 1);
    /* Denominators below 2^24 stay; others become 2^24 - 1. */
    expect_second("0.1234567s", 2, 1, 1, 1234567, 10000000);
    expect_second("0.1234567s", 4, 1, 1, 690420, 16777215); /* 690419.87 */
    /* Terms of more than 64 bits. */
    expect_second("3.0078125s", 16777214, 16777213, 130003, 385, 16640384);
    expect_second("0.5s", UINT32_MAX, UINT32_MAX - 2, 1, 8388607, 16777215); /* 8388607.50 */
    expect_second("999999.9999999s", UINT32_MAX, 1, 4294967291u, 0, 16777215);
    expect_second("999999.9999999s", UINT32_MAX, 4294967291u, 1000001, 16777198, 16777215);
}

static void test_numbers(void **state)
{
    static const char *const bad[] = { "", "x", "1x", "11", "-1", "99999999999999999999", "1.5" };
    float v[3];
    int64_t n;

    (void)state;
    assert_int_equal(ted4_arguments_number("9223372036854775807", 1, INT64_MAX, &n), 0);
    assert_int_equal(n, INT64_MAX);
    assert_int_equal(ted4_arguments_number("10", 0, 10, &n), 0);
    assert_int_equal(n, 10);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(ted4_arguments_number(bad[i], 0, 10, &n), -1);
    assert_int_equal(ted4_arguments_floats("1,-2.5,3e2", 3, v), 0);
    assert_true(v[0] == 1.0f);
    assert_true(v[1] == -2.5f);
    assert_true(v[2] == 300.0f);
    assert_int_equal(ted4_arguments_floats("1,2", 3, v), -1);
    assert_int_equal(ted4_arguments_floats("1,2,3,4", 3, v), -1);
    assert_int_equal(ted4_arguments_floats("1,,3", 3, v), -1);
    assert_int_equal(ted4_arguments_floats("1,2,inf", 3, v), -1);
}

static void test_table(void **state)
{
    static const ted4_argument table[] = {
        { 'o', "output", "FILE", "where to" },
        { 0, "long-only", NULL, "a flag" },
        { 'j', "threads", "N", "how many" },
    };
    const ted4_command c = { "prog", "FILE", "Does things.", table, 3, "The end.\n", NULL };
    char words[][16] = { "prog", "-j", "3", "file", "--long-only", "--output=x", "-oy" };
    char *argv[] = { words[0], words[1], words[2], words[3], words[4], words[5], words[6], NULL };
    char help[1024];
    const char *value;

    (void)state;
    optind = 1;
    assert_int_equal(ted4_arguments_next(&c, 7, argv, &value), 2);
    assert_string_equal(value, "3");
    assert_int_equal(ted4_arguments_next(&c, 7, argv, &value), 1);
    assert_null(value);
    assert_int_equal(ted4_arguments_next(&c, 7, argv, &value), 0);
    assert_string_equal(value, "x");
    assert_int_equal(ted4_arguments_next(&c, 7, argv, &value), 0);
    assert_string_equal(value, "y");
    assert_int_equal(ted4_arguments_next(&c, 7, argv, &value), TED4_ARGUMENTS_END);
    assert_int_equal(optind, 6);
    assert_int_equal(strcmp(argv[optind], "file"), 0);

    FILE *const f = tmpfile();
    assert_non_null(f);
    ted4_arguments_help(&c, f);
    rewind(f);
    help[fread(help, 1, sizeof help - 1, f)] = '\0';
    fclose(f);
    assert_non_null(strstr(help, "  -o, --output FILE  where to\n"));
    assert_non_null(strstr(help, "      --long-only    a flag\n"));
    assert_non_null(strstr(help, "\nThe end.\n"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_patterns), cmocka_unit_test(test_times),
        cmocka_unit_test(test_seconds),  cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
