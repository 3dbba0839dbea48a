/* test_file_cost.c - train/search/file_cost.c: the weight of a bit, and the cost of a model in the
 * integer stage against the bytes of its file.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>

#include "ball_trainer.h"
#include "test.h"
#include "train/search/file_cost.h"

enum { FRAMES = 3 };

/* lambda weighs the mean bits per value of all anchors: 8 features, 6 scalings, 4 offsets in three
 * dimensions, 4 values of phi and 4 of activation make 34 values per anchor. */
static double weight_of_bit(const ted4_trainer *t)
{
    return t->opt.lambda / (34.0 * (double)t->anchors.n);
}

/* profile: an option. Returns the bytes of the file. */
static double check_cost(const char *profile)
{
    ted4_train_options o = ball_options();
    tiny_folder folder;
    ted4_dataset scene;
    ted4_trainer t;
    ted4_cost c;
    ball_file f;

    ball_set(&o, profile);
    ball_set(&o, "stage1=40");
    ball_set(&o, "stage2=40");
    ball_load(&folder, &scene, FRAMES, 1);
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, 80);
    assert_true(fabs(ted4_lambda_per_bit(&t) / weight_of_bit(&t) - 1) < 1e-9);
    assert_int_equal(ted4_file_cost(&t, &c), 0);
    f = ball_finish(&t);
    assert_true(c.bytes == (double)f.size);
    assert_true(c.distortion > 0);
    assert_true(fabs(c.cost - c.distortion - 8 * (double)f.size * weight_of_bit(&t)) <
                1e-9 * c.cost);
    free(f.bytes);
    ted4_trainer_finish(&t);
    ted4_dataset_free(&scene);
    tiny_free(&folder);
    return c.bytes;
}

static void test_cost(void **state)
{
    (void)state;

    const double main_bytes = check_cost("profile=0"), bytes = check_cost("profile=1");

    assert_true(bytes < 0.95 * main_bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cost),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
