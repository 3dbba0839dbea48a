/* test_preview.c - train/state/picture.c: the PSNR that a training reports is that of held-out
 * pictures, spread over all of them; without any, that of training pictures.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "ball_trainer.h"
#include "test.h"
#include "train/state/picture.h"

enum { FRAMES = 3, PICTURES = FRAMES * BALL_CAMERAS };

/* Holds out the pictures whose bits are set. */
static void hold_out(ted4_dataset *d, unsigned which)
{
    for (size_t i = 0; i < d->n_pictures; i++)
        d->pictures[i].is_test = which >> i & 1;
}

static void expect_mean(ted4_trainer *t, int n, double want)
{
    const double got = ted4_trainer_preview(t, n);

    if (!(fabs(got - want) < 1e-9))
        fail_msg("%.12g, expected %.12g", got, want);
}

static void test_pictures(void **state)
{
    const ted4_train_options o = ball_options();
    double psnr[PICTURES], sum = 0;
    tiny_folder folder;
    ted4_dataset scene;
    ted4_trainer t;

    (void)state;
    ball_load(&folder, &scene, FRAMES, 1);
    assert_int_equal(scene.n_pictures, PICTURES);
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, 30);
    for (int i = 0; i < PICTURES; i++) {
        hold_out(&scene, 1u << i);
        psnr[i] = ted4_trainer_preview(&t, 4); /* there is only one */
        assert_true(psnr[i] > 1);
        sum += psnr[i];
        for (int k = 0; k < i; k++)
            assert_true(psnr[k] != psnr[i]);
    }
    hold_out(&scene, 1u << 2 | 1u << 5 | 1u << 6 | 1u << 11);
    expect_mean(&t, 1, psnr[2]);
    expect_mean(&t, 2, (psnr[2] + psnr[6]) / 2);
    expect_mean(&t, 9, (psnr[2] + psnr[5] + psnr[6] + psnr[11]) / 4);
    hold_out(&scene, 0);
    expect_mean(&t, 3, (psnr[0] + psnr[4] + psnr[8]) / 3);
    expect_mean(&t, PICTURES, sum / PICTURES);
    ted4_trainer_finish(&t);
    ted4_dataset_free(&scene);
    tiny_free(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
