/* test_sensitivity.c - train/search/sensitivity.c: the sensitivity of a Gaussian is the mean over
 * training pictures of |dL / d(log opacity)|, picture by picture, so that pictures that want more
 * of it and pictures that want less do not cancel.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>

#include "ball_trainer.h"
#include "test.h"
#include "train/search/sensitivity.h"
#include "train/state/picture.h"

enum { FRAMES = 3, STEPS = 60 };

/* Adds the absolute and the signed derivatives of one picture, [n][K]. */
static void add_picture(ted4_trainer *t, uint32_t item, double *absolute, double *with_sign)
{
    const size_t K = t->layout.head.n_offsets;
    ted4_splats s;

    assert_int_equal(ted4_distortion_gradient(t, item, &s), 0);
    for (size_t b = 0; b < t->visible_blocks.n; b++)
        for (size_t j = 0; j < TED4_LANES; j++)
            for (size_t k = 0; k < K; k++) {
                const size_t at = (b * K + k) * TED4_LANES + j,
                             anchor = t->visible_blocks.block[b] * (size_t)TED4_LANES + j;
                const double d = (double)s.opacity[at] * (double)t->work.splat_gradient.opacity[at];

                if (!(t->visible_blocks.lanes[b] >> j & 1))
                    continue;
                absolute[anchor * K + k] += fabs(d);
                with_sign[anchor * K + k] += d;
            }
}

static void test_mean(void **state)
{
    const ted4_train_options o = ball_options();
    tiny_folder folder;
    ted4_dataset scene;
    ted4_trainer t;
    size_t n, cancel = 0;

    (void)state;
    ball_load(&folder, &scene, FRAMES, 1);
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, STEPS);
    n = t.anchors.n * t.layout.head.n_offsets;

    double *absolute = calloc(n, sizeof *absolute), *with_sign = calloc(n, sizeof *with_sign);
    float *use = malloc(n * sizeof *use);

    assert_non_null(absolute);
    assert_non_null(with_sign);
    assert_non_null(use);
    for (uint32_t i = 0; i < t.order.n; i++)
        add_picture(&t, t.order.item[i], absolute, with_sign);
    assert_int_equal(ted4_opacity_sensitivity(&t, use), 0);
    for (size_t i = 0; i < n; i++) {
        const double want = absolute[i] / t.order.n;

        assert_true(fabs((double)use[i] - want) <= 1e-5 * want + 1e-12);
        cancel += fabs(with_sign[i]) < 0.9 * absolute[i];
    }
    assert_true(cancel > n / 10);
    free(absolute);
    free(with_sign);
    free(use);
    ted4_trainer_finish(&t);
    ted4_dataset_free(&scene);
    tiny_free(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mean),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
