/* test_branch.c - train/search/branch.c: the loss of a trial is the mean over its second half, its
 * steps are those of training, and the monitor is as free afterwards as before.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#define BALL_FRAMES 3
#include "ball_group.h"
#include "test.h"
#include "train/search/branch.h"
#include "train/step/step.h"

enum { BEGIN = 5 };

/* Of seven steps, the last four count; of six, the last three. */
static void test_second_half(void **state)
{
    const ted4_train_options o = ball_options();

    (void)state;
    for (int n = 6; n <= 7; n++) {
        ted4_trainer t, twin;
        double loss, sum = 0;

        ball_begin(&t, &o, &balls, NULL);
        ball_begin(&twin, &o, &balls, NULL);
        ball_train(&t, BEGIN);
        ball_train(&twin, BEGIN);
        assert_int_equal(ted4_branch_run(&t, n, &loss), 0);
        for (int i = 0; i < n; i++) {
            assert_int_equal(ted4_gradient_step(&twin), 0);
            sum += i >= 3 ? twin.progress.last_loss : 0;
        }
        assert_true(fabs(loss - sum / (n - 3)) < 1e-12);
        assert_int_equal(t.iteration, BEGIN + n);
        assert_memory_equal(t.net.value, twin.net.value, t.layout.n_net * sizeof *t.net.value);
        assert_int_equal(t.monitor.pinned, 0);
        assert_null(t.monitor.good.bytes);
        ted4_trainer_finish(&t);
        ted4_trainer_finish(&twin);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_second_half),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
