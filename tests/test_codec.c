/* test_codec.c - scenes to bytes and back: spec 5 to 10, 13 to 15 as a whole.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <pthread.h>
#include <stdlib.h>
#include "random_scene.h"

enum { SCENES = 150 };

typedef struct {
    uint8_t *data;
    size_t   size;
} file;

static file encode(const ted4_scene *s)
{
    ted4_error e;
    file       f;

    assert_int_equal(ted4_encode(s, 0, NULL, &f.data, &f.size, &e), TED4_OK);
    return f;
}

static ted4_scene *decode(file f, const ted4_options *o)
{
    ted4_scene *s;
    ted4_error  e;

    assert_string_equal(ted4_status_id(ted4_decode(f.data, f.size, o, &s, &e)),
                        "ok");
    return s;
}

static void same_blob(const ted4_blob *a, const ted4_blob *b)
{
    assert_int_equal(a->n, b->n);
    if (a->n > 0)
        assert_memory_equal(a->values, b->values, a->n * sizeof *a->values);
}

static void same_scene(const ted4_scene *a, const ted4_scene *b)
{
    const size_t n = a->head.n_anchors;

    assert_memory_equal(&a->head, &b->head, sizeof a->head);
    assert_memory_equal(a->shift, b->shift, a->shape.n_units);
    same_blob(&a->nete, &b->nete);
    same_blob(&a->netr, &b->netr);
    same_blob(&a->bank, &b->bank);
    assert_memory_equal(a->position, b->position, 6 * n);
    assert_memory_equal(a->dynamic, b->dynamic, n);
    assert_memory_equal(a->offset_bits, b->offset_bits, 2 * n);
    for (int t = 0; t < TED4_TYPES; t++)
        if (a->shape.dim[t] > 0) {
            assert_memory_equal(a->step_index[t], b->step_index[t], n);
            assert_memory_equal(a->symbol[t], b->symbol[t],
                                2 * n * a->shape.dim[t]);
        }
}

static void round_trip(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < SCENES; seed++) {
        ted4_scene *s = random_scene(seed);
        file        f, again;
        ted4_scene *t;

        assert_non_null(s);
        f = encode(s);
        again = encode(s);
        assert_int_equal(f.size, again.size);
        assert_memory_equal(f.data, again.data, f.size);
        free(again.data);
        t = decode(f, NULL);
        same_scene(s, t);
        /* canonical: what was parsed is written as it was */
        again = encode(t);
        assert_int_equal(f.size, again.size);
        assert_memory_equal(f.data, again.data, f.size);
        free(again.data);
        free(f.data);
        ted4_scene_free(s);
        ted4_scene_free(t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
