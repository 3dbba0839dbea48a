/* test_flicker.c - data/flicker.c: which changes of brightness between pictures count as flicker,
 * and what follows from it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "data/flicker.h"
#include "data/source.h"
#include "train/model/header_from_options.h"

enum { MOST = 40 };

typedef struct {
    ted4_picture picture[MOST];
    ted4_source source[MOST];
    ted4_dataset data;
} scene;

static void add(scene *s, uint32_t camera, uint32_t frame, double level, int is_test)
{
    const size_t i = s->data.n_pictures++;

    assert_true(i < MOST);
    s->data.pictures = s->picture;
    s->data.sources = s->source;
    s->picture[i] =
        (ted4_picture) { .camera_id = camera, .frame = frame, .is_test = (uint8_t)is_test };
    s->source[i] = (ted4_source) { .level = level };
}

static void expect(const scene *s, double wanted)
{
    const double got = ted4_dataset_flicker(&s->data);

    if (!(fabs(got - wanted) < 1e-9))
        fail_msg("%g levels, not %g", got, wanted);
}

/* One lamp for all cameras, which differ in brightness; the pictures of two cameras alternate, with
 * times in descending order. */
static void test_lamp(void **state)
{
    scene s = { 0 };

    (void)state;
    for (uint32_t f = 8; f-- > 0;) {
        add(&s, 0, f, f % 2 ? 120 : 100, 0);
        add(&s, 7, f, f % 2 ? 60 : 40, 0);
    }
    expect(&s, 20);
}

static void test_steady(void **state)
{
    scene still = { 0 }, fades = { 0 }, pops = { 0 };

    (void)state;
    for (uint32_t f = 0; f < 12; f++) {
        add(&still, 3, f, 90, 0);
        add(&fades, 0, f, 40 + 15.0 * f, 0);
        add(&pops, 0, f, f > 3 && f < 9 ? 140 : 80, 0);
    }
    expect(&still, 0);
    expect(&fades, 0);
    expect(&pops, 0);
}

/* Held-out pictures are not used and leave gaps; one camera per picture, as with a moving camera,
 * gives no information either. */
static void test_unknown(void **state)
{
    scene held = { 0 }, moves = { 0 }, none = { 0 };

    (void)state;
    for (uint32_t f = 0; f < 12; f++) {
        add(&held, 0, f, f % 2 ? 50 : 100, f % 3 == 1);
        add(&held, 1, f, 70, 0);
        add(&moves, f, f, f % 2 ? 50 : 100, 0);
    }
    expect(&held, 0);
    expect(&moves, 0);
    expect(&none, 0);
}

/* If the program chooses the number of bank rows, it is one per frame for a scene that flickers. */
static void test_settled(void **state)
{
    (void)state;
    for (int rows = 0; rows < 2; rows++)
        for (int flickers = 0; flickers < 2; flickers++) {
            scene s = { 0 };
            ted4_train_options o;

            for (uint32_t f = 0; f < 12; f++)
                add(&s, 0, f, f % 2 ? 90 : 90 + (flickers ? 1.01 : 0.99) * TED4_FLICKER_SEEN, 0);
            s.data.n_frames = 12;
            assert_int_equal(ted4_options_preset(&o, "draft"), 0);
            o.bank_rows = 5 * rows;
            assert_int_equal(ted4_header_settle(&o, &s.data), 0);
            assert_int_equal(o.bank_rows, rows ? 5 : flickers ? 12 : 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lamp),
        cmocka_unit_test(test_steady),
        cmocka_unit_test(test_unknown),
        cmocka_unit_test(test_settled),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
