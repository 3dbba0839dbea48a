/* test_budget.c - tool/budget.c: every byte of a file belongs to exactly one part.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "random_scene.h"
#include "tool/budget.h"

static void every_byte(void **state)
{
    static ted4_budget b;
    const ted4_options o = { .trace = ted4_budget_trace, .trace_user = &b };

    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        ted4_scene *s = random_scene(seed), *t;
        uint64_t sum = 0, bank = 0, position = 0;
        uint8_t *d;
        size_t size;

        assert_int_equal(ted4_encode(s, 0, NULL, &d, &size, NULL), TED4_OK);
        memset(&b, 0, sizeof b);
        assert_int_equal(ted4_decode(d, size, &o, &t, NULL), TED4_OK);
        assert_true(ted4_budget_finish(&b, size));
        for (int i = 0; i < b.n_rows; i++) {
            sum += b.row[i].bytes;
            if (strcmp(b.row[i].element, "bank") == 0)
                bank = b.row[i].bytes;
            if (strcmp(b.row[i].element, "position") == 0)
                position = b.row[i].bytes;
        }
        assert_int_equal(sum, size);
        assert_int_equal(position, 6 * (size_t)s->head.n_anchors);
        assert_int_equal(bank, t->bank.mode == TED4_BLOB_DEFLATED ? t->bank.deflated_size
                                                                  : 4 * t->bank.n);
        assert_int_equal(b.header[0].value, s->head.n_anchors);
        ted4_scene_free(s);
        ted4_scene_free(t);
        free(d);
    }
}

/* A trace that goes backwards, or ends before its last element, is refused. */
static void disorder(void **state)
{
    static ted4_budget b;

    (void)state;
    ted4_budget_trace(&b, 0, "magic", 0, 0);
    ted4_budget_trace(&b, 8, "major", 0, 0);
    assert_true(ted4_budget_finish(&b, 9));
    memset(&b, 0, sizeof b);
    ted4_budget_trace(&b, 0, "magic", 0, 0);
    ted4_budget_trace(&b, 8, "major", 0, 0);
    ted4_budget_trace(&b, 7, "minor", 0, 0);
    assert_false(ted4_budget_finish(&b, 9));
    memset(&b, 0, sizeof b);
    ted4_budget_trace(&b, 1, "magic", 0, 0);
    assert_false(ted4_budget_finish(&b, 9));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_byte),
        cmocka_unit_test(disorder),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
