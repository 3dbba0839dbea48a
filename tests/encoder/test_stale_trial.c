/* test_stale_trial.c - train/search/model_search.c, which is compiled here: what a candidate had
 * left to try is dropped, not applied, when another candidate that was taken meanwhile has removed
 * the part, or made it as small.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_trainer.h"

#include "ref-encoder/train/search/model_search.c"

enum { STEPS = 420, FRAMES = 5 };

/* taken is applied to the current model; then comes the trial of stale that was next before. */
static void expect_dropped(ted4_trainer *t, ted4_candidate taken, ted4_candidate stale)
{
    search s = { .t = t, .budget = 1000, .steps = 5 };
    ted4_snapshot before = { 0 };
    const int to = ted4_candidate_next(t, stale, 0);

    assert_true(to >= 0);
    must(ted4_state_take(t, &before) == 0, t->message.text);
    if (ted4_candidate_make(t, taken, ted4_candidate_next(t, taken, 1)) != 0 ||
        ted4_state_take(t, &s.now) != 0 || measure(&s, &s.now_cost) != 0)
        fail_msg("%s", t->message.text);
    s.trained_cost = s.now_cost;
    s.untrained[stale].to = to;

    const double spent = s.spent;

    if (try_candidate(&s, stale) != 0)
        fail_msg("%s after %s: %s", ted4_candidate_name(stale), ted4_candidate_name(taken),
                 t->message.text);
    assert_int_equal(s.untrained[stale].to, -1);
    assert_int_equal(s.n_trials, 0);
    assert_true(s.spent == spent);
    must(ted4_state_restore(t, &before) == 0, t->message.text);
    ted4_snapshot_free(&before);
    ted4_snapshot_free(&s.now);
}

static void test_dropped(void **state)
{
    static const struct {
        ted4_candidate taken, stale;
    } cases[] = {
        { TED4_CANDIDATE_SLICES, TED4_CANDIDATE_AR },
        { TED4_CANDIDATE_SLICES, TED4_CANDIDATE_SLICES },
        { TED4_CANDIDATE_MOTION, TED4_CANDIDATE_DEFORM },
        { TED4_CANDIDATE_MOTION, TED4_CANDIDATE_BANK },
        { TED4_CANDIDATE_MOTION, TED4_CANDIDATE_PHI },
    };
    ted4_train_options o = ball_options();
    ted4_dataset scene;
    tiny_folder folder;
    ted4_trainer t;

    (void)state;
    ball_load(&folder, &scene, FRAMES, 1);
    ball_set(&o, "capacity=1");
    ball_set(&o, "capacity_share=0");
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, STEPS);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect_dropped(&t, cases[i].taken, cases[i].stale);
    ted4_trainer_finish(&t);
    ted4_dataset_free(&scene);
    tiny_free(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dropped),
    };

    return cmocka_run_group_tests_name("stale_trial", tests, NULL, NULL);
}
