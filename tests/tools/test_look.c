/* test_look.c - tool/look.c: the estimate of the remaining time knows at every step what the
 * schedule has ahead, of which it asks only now and then.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ball_trainer.h"
#include "tool/training.h"

enum { FRAMES = 5, STEPS = 5 };

/* Cameras that take turns, so that a time has one picture: seeding comes earlier than with several
 * views. */
static void test_single_view(void **state)
{
    const ted4_train_options o = ball_options();
    const ted4_request request = { .quiet = 1 };
    tiny_folder folder;
    ted4_dataset d;
    ted4_trainer t;
    ted4_teller teller;
    ted4_training training;
    double early = -1;

    (void)state;
    ball_load(&folder, &d, FRAMES, 1);
    for (size_t i = 0; i < d.n_pictures; i++)
        d.pictures[i].is_test = d.pictures[i].camera_id != d.pictures[i].frame % BALL_CAMERAS;
    ball_begin(&t, &o, &d, NULL);
    ted4_teller_begin(&teller, "test", 1);
    assert_int_equal(ted4_training_begin(&training, &request, &t, &teller), 0);
    for (uint64_t i = 1; i <= STEPS; i++) {
        const ted4_work *w = &training.estimate.last;

        ball_train(&t, i);
        if (i == 1)
            early = w->mv_seed_at;
        assert_true(w->mv_seed_at == early);
        assert_true(w->mv_seed_share > 0);
        assert_true(w->first_growth > 0);
    }
    assert_true(early < 0.2);
    assert_int_equal(ted4_training_end(&training, 0), 0);
    ted4_teller_end(&teller);
    ted4_trainer_finish(&t);
    ted4_dataset_free(&d);
    tiny_free(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_single_view) };

    return cmocka_run_group_tests_name("look", tests, NULL, NULL);
}
