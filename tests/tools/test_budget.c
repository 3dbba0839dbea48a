/* test_budget.c - tool/budget.c: every byte of a file belongs to exactly one part.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "test.h"
#include "base/bytes.h"
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

enum { MANY = 1000, CHUNK = 12 + 3 + 8, END = 12 + 16 + 8 };

/* Writes an ancillary chunk of the type "x" and three digits. */
static void put_chunk(uint8_t *to, int number)
{
    char type[5];

    snprintf(type, sizeof type, "x%03d", number);
    memcpy(to, type, 4);
    ted4_store32(to + 4, 0);
    ted4_store32(to + 8, 3);
    memcpy(to + 12, "abc", 3);
    ted4_store64(to + 15, XXH3_64bits(to, 15));
}

static const ted4_budget_row *row(const ted4_budget *b, const char *chunk, const char *element)
{
    for (int i = 0; i < b->n_rows; i++)
        if (strcmp(b->row[i].chunk, chunk) == 0 && strcmp(b->row[i].element, element) == 0)
            return &b->row[i];
    return NULL;
}

/* A valid file may have any number of types of ancillary chunks. Those without a row of their own
 * share one, and what comes after them has its own. */
static void many_types(void **state)
{
    static ted4_budget b;
    const ted4_options o = { .trace = ted4_budget_trace, .trace_user = &b };
    ted4_scene *s = random_scene(1), *t;
    uint64_t sum = 0;
    uint8_t *d, *many;
    size_t size;
    int own = 0;

    (void)state;
    assert_int_equal(ted4_encode(s, 0, NULL, &d, &size, NULL), TED4_OK);
    many = malloc(size + MANY * CHUNK);
    assert_non_null(many);
    memcpy(many, d, size - END);
    for (int i = 0; i < MANY; i++)
        put_chunk(many + size - END + i * CHUNK, i);
    memcpy(many + size - END + MANY * CHUNK, d + size - END, END);
    size += MANY * CHUNK;
    memset(&b, 0, sizeof b);
    assert_int_equal(ted4_decode(many, size, &o, &t, NULL), TED4_OK);
    assert_true(ted4_budget_finish(&b, size));
    for (int i = 0; i < b.n_rows; i++) {
        sum += b.row[i].bytes;
        own += b.row[i].chunk[0] == 'x' && strcmp(b.row[i].element, "ancillary") == 0;
    }
    assert_int_equal(sum, size);
    assert_true(own >= 40 && own < MANY);
    assert_int_equal(row(&b, "x000", "ancillary")->bytes, 3);
    assert_int_equal(row(&b, "other", "ancillary")->bytes, 3 * (MANY - own));
    assert_int_equal(row(&b, "other", "frame")->bytes, 20 * (MANY - own));
    assert_int_equal(row(&b, "ENDS", "frame")->bytes, 20);
    ted4_scene_free(s);
    ted4_scene_free(t);
    free(many);
    free(d);
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
        cmocka_unit_test(many_types),
        cmocka_unit_test(disorder),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
