/* test_tables.c - compares norm/tables.c with its formulas (annex A).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "tests/gen/table_math.h"
#include "norm/tables.h"

/* Entry i of the compiled table number t of table_list. */
static int64_t compiled(int t, int i)
{
    switch (t) {
    case 0: return ted4_half[i];
    case 1: return ted4_inv[i];
    case 2: return ted4_phi[i];
    case 3: return ted4_sin[i];
    case 4: return ted4_step[i];
    case 5: return ted4_stepi[i];
    default: return ted4_where[i];
    }
}

static void formulas(void **state)
{
    (void)state;
    for (int t = 0; t < N_TABLES; t++)
        for (int i = 0; i < table_list[t].n; i++)
            assert_int_equal(compiled(t, i), table_list[t].entry(i));
}

static void known_values(void **state)
{
    (void)state;
    assert_int_equal(ted4_half[64], 6); /* sigma = 1 */
    assert_int_equal(ted4_inv[64], 1 << 17);
    assert_int_equal(ted4_inv[0], 1 << 21); /* sigma = 1/16 */
    assert_int_equal(ted4_half[239], 4095);
    assert_int_equal(ted4_phi[512], 1 << 23);
    assert_int_equal(ted4_sin[256], 4096);
    assert_int_equal(ted4_sin[768], -4096);
    assert_int_equal(ted4_step[128], 0x3f800000); /* 1.0f */
    assert_int_equal(ted4_stepi[160], 8192);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formulas),
        cmocka_unit_test(known_values),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
