/* test_json_string.c - any bytes become a string of JSON; text is cut between letters.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "test.h"
#include "tool/json_string.h"

static const struct {
    const char *text, *want;
} strings[] = {
    { "", "" },
    { "plain \xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80", "plain \xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80" },
    { "no\xff", "no\xef\xbf\xbd" },
    { "cut \xe2\x82", "cut \xef\xbf\xbd\xef\xbf\xbd" },
    { "\xc3(", "\xef\xbf\xbd(" },
    { "\xed\xa0\x80", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd" }, /* a surrogate */
    { "\x80\xc3\xa9", "\xef\xbf\xbd\xc3\xa9" },
};

static void test_strings(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof strings / sizeof strings[0]; i++) {
        json_t *const s = ted4_json_string(strings[i].text);

        assert_non_null(s);
        assert_string_equal(json_string_value(s), strings[i].want);
        assert_int_equal(ted4_is_utf8(strings[i].text),
                         strcmp(strings[i].text, strings[i].want) == 0);
        json_decref(s);
    }
}

static void test_cut(void **state)
{
    (void)state;
    assert_int_equal(ted4_whole_letters("abc", 5), 3);
    assert_int_equal(ted4_whole_letters("abc", 2), 2);
    assert_int_equal(ted4_whole_letters("a\xc3\xa9", 3), 3);
    assert_int_equal(ted4_whole_letters("a\xc3\xa9", 2), 1);
    assert_int_equal(ted4_whole_letters("\xf0\x9f\x98\x80z", 3), 0);
    assert_int_equal(ted4_whole_letters("\xf0\x9f\x98\x80z", 4), 4);
    assert_int_equal(ted4_whole_letters("", 0), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_strings),
                                        cmocka_unit_test(test_cut) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
