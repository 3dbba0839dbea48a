/* test_starved_writer.c - the writer when memory runs out, with each allocation failing in turn:
 * the verdict is limit.memory. It is compiled here as if size_t had 32 bits: no size exceeds
 * UINT32_MAX.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "random_scene.h"
#include "starving.h"

#undef UINT32_MAX
#define UINT32_MAX SIZE_MAX
#include "ref-encoder/write/write_file.c"

static int write_scene(size_t n, int fail_on)
{
    ted4_scene *s = random_scene(3);
    uint8_t *out;
    size_t size;

    assert_non_null(s);
    starve(n, fail_on);
    const ted4_status verdict = ted4_encode(s, 0, NULL, &out, &size, NULL);
    const int failed = feed();

    assert_int_equal(verdict, failed ? TED4_E_LIMIT_MEMORY : TED4_OK);
    assert_int_equal((out == NULL), failed);
    assert_int_equal((size == 0), failed);
    free(out);
    ted4_scene_free(s);
    return failed;
}

static void test_writer(void **state)
{
    (void)state;
    starve_each(write_scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_writer) };

    return cmocka_run_group_tests_name("starved writer", tests, NULL, NULL);
}
