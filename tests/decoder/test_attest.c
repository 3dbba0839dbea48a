/* test_attest.c - samples of the functions of annex J.9 against conformance/attest/sample.txt and
 * the annex; all of their values: `make attest`. pow2 is what it is named for, to two units in the
 * last place.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tests/gen/attest.h"

enum { STRIDE = 4093 }; /* a prime: every exponent occurs with many fractions */

static void as_attested(void **state)
{
    char now[512] = "", kept[2048] = "";
    FILE *f = tmpfile();

    (void)state;
    assert_non_null(f);
    attest_samples(f);
    rewind(f);
    now[fread(now, 1, sizeof now - 1, f)] = '\0';
    fclose(f);
    f = fopen("conformance/attest/sample.txt", "r");
    assert_non_null(f);
    kept[fread(kept, 1, sizeof kept - 1, f)] = '\0';
    fclose(f);
    if (strcmp(now, kept) != 0)
        print_message("%s", now);
    assert_string_equal(now, kept);
}

static void accurate(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < (uint64_t)1 << 32; i += STRIDE) {
        const float x = ted4_bits_float((uint32_t)i);
        const double exact = exp2(fmin(fmax((double)x, -126), 126));

        if (x == x)
            assert_true(fabs((double)ted4_pow2(x) - exact) <= 0x1p-22 * exact);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(as_attested), cmocka_unit_test(accurate) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
