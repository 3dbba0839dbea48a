/* test_meta_lines.c - tool/meta_lines.c: which lines of META are printed, and that none of them can
 * control a terminal.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "test.h"
#include "base/bytes.h"
#include "tool/meta_lines.h"

enum { CAPACITY = 4096 };

static uint8_t file[CAPACITY];
static size_t size;

/* Adds a chunk; meta_lines.c reads only types and sizes. */
static void add_chunk(const char *type, const char *text, size_t n)
{
    memcpy(file + size, type, 4);
    ted4_store32(file + size + 4, 2);
    ted4_store32(file + size + 8, (uint32_t)n);
    memcpy(file + size + 12, text, n);
    memset(file + size + 12 + n, 0, 8);
    size += 20 + n;
}

static void begin(void)
{
    memset(file, 0, sizeof file);
    size = 12;
    add_chunk("HEAD", "capacity.1=none\n", 16);
}

static void expect(const char *const *lines, size_t n)
{
    json_t *list = ted4_meta_lines_json(file, size, "capacity");

    assert_int_equal(json_array_size(list), n);
    for (size_t i = 0; i < n; i++)
        assert_string_equal(json_string_value(json_array_get(list, i)), lines[i]);
    json_decref(list);
}

static void test_lines(void **state)
{
    static const char text[] =
        "title=x\ncapacity=auto\ncapacity.1=one\ncapacityx=no\ncapacity\n\ncapacity.2=two=2\n";
    static const char *const want[] = { "capacity=auto", "capacity.1=one", "capacity.2=two=2",
                                        "capacity.3=no end" };

    (void)state;
    begin();
    add_chunk("META", text, strlen(text));
    add_chunk("xyzw", "capacity=other\n", 15);
    add_chunk("META", "capacity.3=no end", 17);
    expect(want, 4);
}

static void test_steering(void **state)
{
    static const char text[] = "capacity=\x1b[2J\x07\xc2\x9b"
                               "1m\x7f!\n";
    static const char *const want[] = { "capacity=?[2J???1m?!" };

    (void)state;
    begin();
    add_chunk("META", text, strlen(text));
    expect(want, 1);
}

/* Text of any language is shown as it is; bytes that are no UTF-8, or whose character is not seen
 * or turns the text around, are not. */
static void test_languages(void **state)
{
    static const char text[] = "capacity=\xc3\xa9 \xd0\xb6 \xe6\x97\xa5 \xf0\x9f\x8c\x8d\n"
                               "capacity=\xc1\xbf \xe0\x9f\xbf \xed\xa0\x80 \xf4\x90\x80\x80\n"
                               "capacity=\xe2\x80\xae \xe2\x80\xa8 \xc2\xad \xef\xbb\xbf\n"
                               "capacity=\xe9t\xc3 \xf8\x88\x80\x80\x80 \xbf\xe6\x97\n";
    static const char *const want[] = { "capacity=\xc3\xa9 \xd0\xb6 \xe6\x97\xa5 \xf0\x9f\x8c\x8d",
                                        "capacity=?? ??? ??? ????", "capacity=??? ??? ?? ???",
                                        "capacity=?t? ????? ???" };

    (void)state;
    begin();
    add_chunk("META", text, strlen(text));
    expect(want, 4);
}

static void test_none(void **state)
{
    static char long_line[2000];

    (void)state;
    begin();
    expect(NULL, 0);
    add_chunk("META", "", 0);
    expect(NULL, 0);
    memset(long_line, 'a', sizeof long_line);
    memcpy(long_line, "capacity=", 9);
    add_chunk("META", long_line, sizeof long_line);

    json_t *list = ted4_meta_lines_json(file, size, "capacity");

    assert_int_equal(json_array_size(list), 1);
    assert_int_equal(strlen(json_string_value(json_array_get(list, 0))), 1000);
    json_decref(list);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_lines),
                                        cmocka_unit_test(test_steering),
                                        cmocka_unit_test(test_languages),
                                        cmocka_unit_test(test_none) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
