/* test_encoder_trained.c - spec 3.4 for files of short trainings, one for each variant of the
 * method.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_trainer.h"
#include "encoder_contract.h"
#include "tool/threads.h"
#include "train/step/export_scene.h"

static void trained(void **state)
{
    static const char *const variant[] = {
        "",
        "motion=0",
        "motion=2",
        "motion=3",
        "activation=0",
        "temporal_mask=0",
        "offset_mask=0",
        "factorised=1",
        "slices=1",
        "view=0",
        "view=2",
        "linear_scale=1",
    };
    ted4_parallel p;
    ted4_dataset d;
    tiny_folder f;

    (void)state;
    ted4_threads_init(&p, 2);
    ball_load(&f, &d, 4, 1);
    for (size_t i = 0; i < sizeof variant / sizeof *variant; i++) {
        ted4_train_options o = ball_options();
        ted4_trainer t;
        ted4_scene *s;

        ball_set(&o, "stage1=60");
        ball_set(&o, "stage2=40");
        ball_set(&o, "probe=0");
        ball_set(&o, "lr_heads=0.004"); /* keeps Gaussians visible in so few steps */
        if (variant[i][0] != '\0')
            ball_set(&o, variant[i]);
        ball_begin(&t, &o, &d, &p);
        ball_train(&t, 100);
        assert_int_equal(ted4_export_scene(&t, &s), 0);
        contract_kept(s, 1);
        ted4_scene_free(s);
        ted4_trainer_finish(&t);
    }
    ted4_dataset_free(&d);
    tiny_remove_path(f.path);
    ted4_threads_finish(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(trained) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
