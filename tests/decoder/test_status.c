/* test_status.c - base/status.h: every status has its texts, and numbers that are none have some.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "base/status.h"

static void test_all(void **state)
{
    (void)state;
    for (int s = 0; s < TED4_N_STATUS; s++) {
        assert_true(ted4_status_id((ted4_status)s)[0] != '\0');
        assert_true(ted4_status_section((ted4_status)s)[0] != '\0');
        assert_true(ted4_status_text((ted4_status)s)[0] != '\0');
        assert_true(ted4_verdict_name(ted4_status_verdict((ted4_status)s))[0] != '\0');
    }
}

/* A program may be linked with a library of another version. */
static void test_none(void **state)
{
    static const int numbers[] = { TED4_N_STATUS, 9999, -1 };

    (void)state;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        const ted4_status s = (ted4_status)numbers[i];

        assert_string_equal(ted4_status_id(s), "unknown");
        assert_string_equal(ted4_status_text(s), "not a status of this version");
        assert_true(ted4_status_section(s)[0] != '\0');
        assert_int_equal(ted4_status_verdict(s), TED4_INVALID);
        assert_string_equal(ted4_verdict_name((ted4_verdict)numbers[i]), "unknown");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all),
        cmocka_unit_test(test_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
