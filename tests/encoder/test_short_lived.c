/* test_short_lived.c - train/densify/short_lived.h: which initial points are found to be
 * short-lived, and when they exist.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "ball_scene.h"
#include "train/densify/photo_votes.h"
#include "train/densify/short_lived.h"
#include "train/step/trainer_init.h"

enum { FRAMES = 5 };

typedef struct {
    tiny_folder folder;
    ted4_dataset data;
    ted4_trainer trainer;
} scene;

static void load_scene(scene *s, int moving)
{
    const ted4_dataset_options o = { .downscale = 1, .seed = 3, .cache_bytes = 1 };
    ted4_message m;

    s->folder = tiny_new();
    ball_scene(&s->folder, FRAMES, moving);
    if (ted4_dataset_load(&s->data, s->folder.path, &o, &m) != 0)
        fail_msg("%s", m.text);
}

static void begin(scene *s, int activation, int short_lived)
{
    ted4_train_options train;

    assert_int_equal(ted4_options_preset(&train, "draft"), 0);
    train.activation = activation;
    train.transients = short_lived;
    if (ted4_trainer_init(&s->trainer, &train, &s->data, NULL) != 0)
        fail_msg("%s", s->trainer.message.text);
}

static void open_scene(scene *s, int moving, int activation, int short_lived)
{
    load_scene(s, moving);
    begin(s, activation, short_lived);
}

static void close_scene(scene *s)
{
    ted4_trainer_finish(&s->trainer);
    ted4_dataset_free(&s->data);
    tiny_free(&s->folder);
}

/* Distance, in radii, of anchor i from the centre of a ball at a time. */
static double radii(const ted4_trainer *t, size_t i, int which, double time)
{
    const ted4_header *h = &t->layout.head;
    const ball b = ball_at(which, time);
    double square = 0;

    for (int k = 0; k < 3; k++) {
        const double x =
            (double)h->origin[k] +
            ldexp((double)*ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, k), h->exponent);

        square += (x - b.centre[k]) * (x - b.centre[k]);
    }
    return sqrt(square) / b.radius;
}

static float tau(const ted4_trainer *t, size_t i, int c)
{
    return *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_TAU] + c);
}

/* The blue ball's points get spans around the times at which the ball was there; those of the green
 * ball, far from its path, get none. */
static void test_moving(void **state)
{
    scene s;
    size_t found = 0, blue = 0;

    (void)state;
    open_scene(&s, 1, 1, 1);
    for (size_t i = 0; i < s.trainer.anchors.n; i++) {
        if (!ted4_is_short_lived(&s.trainer, i)) {
            assert_true(tau(&s.trainer, i, 0) == 0.0f);
            assert_true(tau(&s.trainer, i, 2) == 1.0f);
            continue;
        }
        const double from = (double)tau(&s.trainer, i, 0), to = (double)tau(&s.trainer, i, 2);

        found++;
        assert_true(-0.11 < from);
        assert_true(from < to);
        assert_true(to < 1.11);
        assert_true(to - from < 1);
        assert_true(fabs((double)tau(&s.trainer, i, 1) - log2(0.35 / (FRAMES - 1))) < 1e-6);
        assert_true(radii(&s.trainer, i, 1, 0) > 1.3);
        blue += radii(&s.trainer, i, 2, 0.5 * (from + to)) < 1.5;
    }
    assert_true(found >= 10);
    if (blue * 10 < found * 9)
        fail_msg("%zu of %zu spans are where the ball is", blue, found);
    close_scene(&s);
}

static void expect_none(int moving, int activation, int short_lived)
{
    scene s;

    open_scene(&s, moving, activation, short_lived);
    for (size_t i = 0; i < s.trainer.anchors.n; i++)
        assert_false(ted4_is_short_lived(&s.trainer, i));
    close_scene(&s);
}

static void test_still(void **state)
{
    (void)state;
    expect_none(0, 1, 1);
}

static void test_no_activation(void **state)
{
    (void)state;
    expect_none(1, 0, 1);
}

static void test_off(void **state)
{
    (void)state;
    expect_none(1, 1, 0);
}

/* With two cameras, no picture is read: their files are gone. */
static void test_two_cameras(void **state)
{
    scene s;

    (void)state;
    load_scene(&s, 1);
    for (size_t i = 0; i < s.data.n_pictures; i++)
        s.data.pictures[i].is_test = s.data.pictures[i].camera_id >= TED4_CAMERAS_NEEDED - 1;
    begin(&s, 1, 0);
    tiny_free(&s.folder);
    assert_int_equal(ted4_init_short_lived(&s.trainer, s.trainer.anchors.n), 0);
    for (size_t i = 0; i < s.trainer.anchors.n; i++)
        assert_false(ted4_is_short_lived(&s.trainer, i));
    ted4_trainer_finish(&s.trainer);
    ted4_dataset_free(&s.data);
}

/* The spans do not depend on how many anchors are looked at together. */
static void test_in_parts(void **state)
{
    enum { PARTS = 7 };
    scene s[2];

    (void)state;
    for (int i = 0; i < 2; i++)
        open_scene(&s[i], 1, 1, i == 0);
    assert_int_equal(ted4_init_short_lived(&s[1].trainer, s[1].trainer.anchors.n / PARTS), 0);
    for (size_t i = 0; i < s[0].trainer.anchors.n; i++)
        for (int c = 0; c < 4; c++)
            assert_true(tau(&s[0].trainer, i, c) == tau(&s[1].trainer, i, c));
    for (int i = 0; i < 2; i++)
        close_scene(&s[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_moving),        cmocka_unit_test(test_still),
        cmocka_unit_test(test_no_activation), cmocka_unit_test(test_off),
        cmocka_unit_test(test_two_cameras),   cmocka_unit_test(test_in_parts),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
