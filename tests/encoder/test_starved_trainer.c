/* test_starved_trainer.c - the trainer when memory runs out, with each allocation failing in turn:
 * it reports exactly that, and releases what it holds.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "cloud_case.h"
#include "data/image_cache.h"
#include "starving.h"
#include "train/state/picture.h"
#include "train/step/stages.h"
#include "train/step/trainer_init.h"

static cloud_case cloud;
static ted4_trainer trainer;

static void begin(void)
{
    cloud_make(&cloud, 5);
    assert_int_equal(ted4_trainer_init(&trainer, &cloud.options, &cloud.data, NULL), 0);
}

static int begin_stage2(size_t n, int fail_on)
{
    begin();
    starve(n, fail_on);
    const int bad = ted4_stage2_begin(&trainer);
    const int failed = feed();

    assert_int_equal(bad, failed ? -1 : 0);
    if (failed && strstr(trainer.message.text, "no memory") == NULL)
        fail_msg("allocation %zu: \"%s\"", n, trainer.message.text);
    ted4_trainer_finish(&trainer);
    return failed;
}

static uint8_t *decode(void *user, size_t i, size_t *size, ted4_message *m)
{
    const ted4_camera *c = &cloud.picture.camera;

    (void)user, (void)i, (void)m;
    *size = (size_t)c->width * (size_t)c->height * 3;
    return __real_calloc(*size, 1);
}

/* A cache without room holds only pictures that are in use. */
static int preview(size_t n, int fail_on)
{
    begin();
    cloud.data.cache = ted4_image_cache_new(1, 0, decode, NULL);
    assert_non_null(cloud.data.cache);
    starve(n, fail_on);
    const double psnr = ted4_trainer_preview(&trainer, 4);
    const int failed = feed();

    assert_int_equal((psnr < 0), failed);
    assert_int_equal(ted4_image_cache_held(cloud.data.cache), 0);
    if (failed && strstr(trainer.message.text, "no memory") == NULL)
        fail_msg("allocation %zu: \"%s\"", n, trainer.message.text);
    ted4_trainer_finish(&trainer);
    ted4_image_cache_free(cloud.data.cache);
    return failed;
}

static void test_stage2(void **state)
{
    (void)state;
    starve_each(begin_stage2);
}

static void test_nothing_left(void **state)
{
    (void)state;
    begin();
    trainer.opt.prune_opacity = 1e9;
    assert_int_equal(ted4_stage2_begin(&trainer), -1);
    assert_string_equal(trainer.message.text, "nothing is left to encode");
    ted4_trainer_finish(&trainer);
}

static void test_preview(void **state)
{
    (void)state;
    starve_each(preview);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stage2),
        cmocka_unit_test(test_nothing_left),
        cmocka_unit_test(test_preview),
    };

    return cmocka_run_group_tests_name("starved trainer", tests, NULL, NULL);
}
