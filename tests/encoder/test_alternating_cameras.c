/* test_alternating_cameras.c - train/densify/alternating_cameras.h: alternating cameras, with one
 * picture per frame. Anchors for a ball without initial points are found from pictures of several
 * frames.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>

#include "test.h"

#define BALL_FRAMES 24
#include "ball_group.h"
#include "ball_missing.h"
#include "train/densify/mv_seed.h"
#include "train/densify/alternating_cameras.h"
#include "train/step/events.h"

/* The blue ball moves by 0.3 of its radius per frame. */
enum { SPEED = 2, STEPS = 80 };

static int set_up_without_blue(void **state)
{
    (void)state;
    ball_load_without_blue(&folder, &balls, FRAMES, SPEED);
    return 0;
}

/* At frame f only camera f % cameras takes a picture, and none if f is not a multiple of gap. */
static void alternate(uint32_t cameras, uint32_t gap)
{
    for (size_t i = 0; i < balls.n_pictures; i++) {
        const ted4_picture *p = &balls.pictures[i];

        balls.pictures[i].is_test = p->camera_id != p->frame % cameras || p->frame % gap != 0;
    }
}

static ted4_train_options options(void)
{
    ted4_train_options o = ball_options();

    o.sprouts = 0.5;
    o.max_anchors = 400;
    return o;
}

static int reach_now(void)
{
    const ted4_train_options o = options();
    ted4_trainer t;
    int reach;

    ball_begin(&t, &o, &balls, NULL);
    reach = ted4_alternating_reach(&t);
    ted4_trainer_finish(&t);
    return reach;
}

static int reach_of(uint32_t cameras, uint32_t gap)
{
    alternate(cameras, gap);
    return reach_now();
}

/* Four cameras alternate in the first frames; then one of them takes all pictures. */
static int reach_of_few(uint32_t frames)
{
    alternate(4, 1);
    for (size_t i = 0; i < balls.n_pictures; i++)
        if (balls.pictures[i].frame >= frames)
            balls.pictures[i].is_test = balls.pictures[i].camera_id != 0;
    return reach_now();
}

/* Four cameras in turn all occur within five frames, or within nine if every second frame has no
 * picture; with fewer than four cameras, or in few frames, no reach suffices. */
static void test_reach(void **state)
{
    const ted4_train_options o = options();
    ted4_trainer t;

    (void)state;
    for (size_t i = 0; i < balls.n_pictures; i++)
        balls.pictures[i].is_test = 0;
    ball_begin(&t, &o, &balls, NULL);
    assert_int_equal(ted4_alternating_reach(&t), 0);
    ted4_trainer_finish(&t);
    assert_int_equal(reach_of(4, 1), 2);
    assert_int_equal(reach_of(3, 1), -1);
    assert_int_equal(reach_of(2, 1), -1);
    assert_int_equal(reach_of(1, 1), -1);
    assert_int_equal(reach_of_few(8), -1);
    assert_int_equal(reach_of_few(BALL_FRAMES), 2);
}

static void test_apart(void **state)
{
    static const float a[3] = { 0, 0, -2 }, b[3] = { 0.09f, 0, -2 }, c[3] = { 0.11f, 0, -2 };
    static const float middle[3] = { 0, 0, 0 }, beside[3] = { 0.02f, 0, 0 };

    (void)state;
    assert_false(ted4_cameras_apart(a, a));
    assert_false(ted4_cameras_apart(a, b));
    assert_true(ted4_cameras_apart(a, c));
    assert_false(ted4_cameras_apart(middle, middle));
    assert_true(ted4_cameras_apart(middle, beside));
}

/* New anchors are short-lived, and most of them lie where the ball is at the middle of their
 * lives. */
static void test_found(void **state)
{
    const ted4_train_options o = options();
    ted4_trainer t;
    ted4_places list = { 0 };
    size_t near;

    (void)state;
    alternate(4, 1);
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STEPS);
    for (uint32_t f = 0; f < FRAMES; f++)
        assert_int_equal(ted4_mv_seed_search(&t, f, 2, &list), 0);

    const size_t before = t.anchors.n;

    if (ted4_mv_seed(&t) != 0)
        fail_msg("%s", t.message.text);

    const size_t n = ball_count_short_lived(&t, SPEED, 1.0f, &near);

    print_message("%zu new anchors, %zu with short lives, %zu on the ball\n", t.anchors.n - before,
                  n, near);
    assert_true(t.anchors.n >= before + 20);
    assert_true(n >= t.anchors.n - before);
    assert_true(2 * near > n);
    ball_check_apart(&t, &list);
    free(list.item);
    ted4_trainer_finish(&t);
}

/* With alternating cameras, new anchors come before the probe asks whether time is needed; with
 * several cameras per frame, after it. */
static void test_schedule(void **state)
{
    const ted4_train_options o = options();

    (void)state;
    for (int turns = 0; turns < 2; turns++) {
        const uint64_t at = (uint64_t)((turns ? 0.2 : 0.3) * (double)o.stage1);
        ted4_trainer t;

        for (size_t i = 0; i < balls.n_pictures; i++)
            balls.pictures[i].is_test = 0;
        if (turns)
            alternate(4, 1);
        ball_begin(&t, &o, &balls, NULL);
        ball_train(&t, at - 1);
        assert_int_equal(t.anchors.n + ted4_growth_allowance(&t), 200);
        ball_train(&t, at + 1);
        assert_int_equal(t.anchors.n + ted4_growth_allowance(&t), 400);
        ted4_trainer_finish(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reach),
        cmocka_unit_test(test_apart),
        cmocka_unit_test(test_found),
        cmocka_unit_test(test_schedule),
    };

    return cmocka_run_group_tests_name("alternating_cameras", tests, set_up_without_blue,
                                       tear_down);
}
