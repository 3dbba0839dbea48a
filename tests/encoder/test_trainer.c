/* test_trainer.c - training of a tiny scene from pictures to bytes: it learns; any number of
 * threads and any checkpoint give the same file; parts that a scene does not need are removed; the
 * optimised rate is the rate of the file; and damaged checkpoints are refused with a message.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <xxhash.h>

#include "test.h"
#include "ball_decoded.h"
#include "tool/threads.h"
#include "train/state/picture.h"
#include "train/state/visible_blocks.h"
#include "train/monitor/checkpoint.h"
#include "train/step/export_scene.h"
#include "train/train.h"

enum { STAGE1 = 400, STAGE2 = 250, INTEGER_FROM = STAGE1 + 200, FRAMES = 5 };

static tiny_folder moving_folder, still_folder, single_folder;
static ted4_dataset moving_scene, still_scene, single_scene;

static int set_up(void **state)
{
    (void)state;
    ball_load(&moving_folder, &moving_scene, FRAMES, 1);
    ball_load(&still_folder, &still_scene, FRAMES, 0);
    ball_load(&single_folder, &single_scene, 1, 0);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_dataset_free(&moving_scene);
    ted4_dataset_free(&still_scene);
    ted4_dataset_free(&single_scene);
    tiny_free(&moving_folder);
    tiny_free(&still_folder);
    tiny_free(&single_folder);
    return 0;
}

/* ---- what is learnt ---- */

static void test_learns(void **state)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;
    ted4_info info;
    double first;

    (void)state;
    ball_begin(&t, &o, &moving_scene, NULL);
    ball_train(&t, 1);
    first = t.progress.loss;
    ball_file f = ball_finish(&t);
    const double psnr = ball_decoded_psnr(&f, &moving_scene, &info);

    assert_true(first > 0.15);
    assert_true(t.progress.loss < 0.25 * first);
    assert_true(ted4_trainer_preview(&t, 4) > 18);
    assert_true(psnr > 27);
    assert_true(info.n_anchors > 100);
    assert_true(info.n_anchors <= 260);
    assert_int_equal(info.motion, TED4_MOTION_BANK);
    assert_true(info.activation);
    assert_int_equal(info.frames, FRAMES);
    ted4_trainer_finish(&t);
    free(f.bytes);
}

/* ---- identical bytes ---- */

static ball_file run(const ted4_parallel *p)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;
    ball_file f;

    ball_begin(&t, &o, &moving_scene, p);
    f = ball_finish(&t);
    ted4_trainer_finish(&t);
    return f;
}

static void test_threads(void **state)
{
    const ball_file alone = run(NULL);

    (void)state;
    for (int n = 1; n <= 2; n++) {
        ted4_parallel p;
        ball_file f;

        ted4_threads_init(&p, n);
        f = run(&p);
        ted4_threads_finish(&p);
        ball_check_same(&alone, &f);
        free(f.bytes);
    }
    free(alone.bytes);
}

/* ---- checkpoints ---- */

/* In stage 1, without and with activation; before and after the first step of stage 2; before and
 * in the integer stage; at the end. */
static const uint64_t stops[] = {
    0, 90, 230, STAGE1, STAGE1 + 1, INTEGER_FROM, INTEGER_FROM + 7, STAGE1 + STAGE2
};

enum { N_STOPS = (int)(sizeof stops / sizeof stops[0]) };

static const char *stop_path(int i)
{
    char name[32];

    snprintf(name, sizeof name, "checkpoint%d", i);
    return tiny_path(&moving_folder, name);
}

/* Trains once, saving at every stop. */
static ball_file run_and_save(void)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;
    ball_file f;

    ball_begin(&t, &o, &moving_scene, NULL);
    for (int i = 0; i < N_STOPS; i++) {
        ball_train(&t, stops[i]);
        assert_int_equal(ted4_checkpoint_save(&t, stop_path(i)), 0);
    }
    f = ball_finish(&t);
    ted4_trainer_finish(&t);
    return f;
}

static void test_checkpoints(void **state)
{
    const ted4_train_options o = ball_options();
    const ball_file whole = run_and_save(), plain = run(NULL);

    (void)state;
    ball_check_same(&plain, &whole);
    for (int i = 0; i < N_STOPS; i++) {
        ted4_trainer t;
        ball_file f;

        ball_begin(&t, &o, &moving_scene, NULL);
        if (ted4_checkpoint_load(&t, stop_path(i)) != 0)
            fail_msg("%s", t.message.text);
        assert_int_equal(t.iteration, stops[i]);
        f = ball_finish(&t);
        ted4_trainer_finish(&t);
        ball_check_same(&whole, &f);
        free(f.bytes);
    }
    free(whole.bytes);
    free(plain.bytes);
}

/* Asserts that a fresh trainer refuses the checkpoint; the message names the file and says why. */
static void check_refused(const ted4_train_options *o, ted4_dataset *d, const char *path,
                          const char *why)
{
    ted4_trainer t;

    ball_begin(&t, o, d, NULL);
    assert_int_equal(ted4_checkpoint_load(&t, path), -1);
    assert_non_null(strstr(t.message.text, path));
    if (strstr(t.message.text, why) == NULL)
        fail_msg("%s, expected: %s", t.message.text, why);
    ted4_trainer_finish(&t);
}

static ball_file read_file(const char *path)
{
    FILE *in = fopen(path, "rb");
    ball_file f = { malloc(1 << 24), 0 };

    assert_non_null(in);
    assert_non_null(f.bytes);
    f.size = fread(f.bytes, 1, 1 << 24, in);
    fclose(in);
    return f;
}

/* Damages every byte of the front, which contains the header, and some of the rest; then truncates,
 * and appends a byte. */
static void check_damaged(const char *from)
{
    static const char why[] = "it is cut short or damaged";
    const ted4_train_options o = ball_options();
    ball_file f = read_file(from);

    for (size_t i = 0; i < f.size; i += i < 200 ? 1 : 1 + f.size / 40) {
        f.bytes[i] ^= (uint8_t)(i % 2 ? 0xff : 0x11);
        tiny_bytes(&moving_folder, "damaged", f.bytes, f.size);
        check_refused(&o, &moving_scene, tiny_path(&moving_folder, "damaged"), why);
        f.bytes[i] ^= (uint8_t)(i % 2 ? 0xff : 0x11);
    }
    for (size_t i = 0; i < f.size; i += i < 60 ? 5 : f.size / 9) {
        tiny_bytes(&moving_folder, "damaged", f.bytes, i);
        check_refused(&o, &moving_scene, tiny_path(&moving_folder, "damaged"), why);
    }
    tiny_bytes(&moving_folder, "damaged", f.bytes, f.size - 1);
    check_refused(&o, &moving_scene, tiny_path(&moving_folder, "damaged"), why);
    tiny_bytes(&moving_folder, "damaged", f.bytes, f.size + 1);
    check_refused(&o, &moving_scene, tiny_path(&moving_folder, "damaged"), why);
    free(f.bytes);
}

/* Changes the number of the format, which follows that of the kind, and the hash at the end. */
static void check_other_version(const char *from)
{
    const ted4_train_options o = ball_options();
    ball_file f = read_file(from);
    XXH64_hash_t hash;

    f.bytes[8]--;
    hash = XXH3_64bits(f.bytes, f.size - sizeof hash);
    memcpy(f.bytes + f.size - sizeof hash, &hash, sizeof hash);
    tiny_bytes(&moving_folder, "damaged", f.bytes, f.size);
    check_refused(&o, &moving_scene, tiny_path(&moving_folder, "damaged"), "another version");
    free(f.bytes);
}

static void test_bad_checkpoints(void **state)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &moving_scene, NULL);
    ball_train(&t, 30);
    assert_int_equal(ted4_checkpoint_save(&t, stop_path(0)), 0);
    assert_int_equal(ted4_checkpoint_save(&t, "/nowhere/at/all"), -1);
    assert_true(strlen(t.message.text) > 0);
    ball_train(&t, STAGE1 + STAGE2);
    assert_int_equal(ted4_checkpoint_save(&t, stop_path(1)), 0);
    ted4_trainer_finish(&t);

    check_refused(&o, &moving_scene, tiny_path(&moving_folder, "missing"), "No such file");
    check_refused(&o, &single_scene, stop_path(0), " pictures, and there are ");
    check_other_version(stop_path(0));
    check_damaged(stop_path(0));
    check_damaged(stop_path(1));
    ball_set(&o, "lambda=0.003");
    check_refused(&o, &moving_scene, stop_path(1), "its lambda is ");
    o = ball_options();
    ball_set(&o, "offsets=3");
    check_refused(&o, &moving_scene, stop_path(0), "its offsets is ");
    o = ball_options();
    o.seed = 1;
    check_refused(&o, &moving_scene, stop_path(1), "its seed is ");
}

/* A state that no checkpoint may contain is an error, although no system call failed. */
static void test_impossible_state(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &moving_scene, NULL);
    t.net.bits[0] = 0;
    errno = 0;
    assert_int_equal(ted4_checkpoint_save(&t, stop_path(0)), -1);
    assert_non_null(strstr(t.message.text, stop_path(0)));
    ted4_trainer_finish(&t);
}

/* ---- parts that are not needed ---- */

static ted4_info train_and_look(const ted4_train_options *o, ted4_dataset *d, double *psnr)
{
    ted4_trainer t;
    ted4_info info;
    ball_file f;

    ball_begin(&t, o, d, NULL);
    f = ball_finish(&t);
    ted4_trainer_finish(&t);
    *psnr = ball_decoded_psnr(&f, d, &info);
    free(f.bytes);
    return info;
}

static void test_single_frame(void **state)
{
    const ted4_train_options o = ball_options();
    double psnr;
    const ted4_info info = train_and_look(&o, &single_scene, &psnr);

    (void)state;
    assert_int_equal(info.frames, 1);
    assert_int_equal(info.motion, TED4_MOTION_NONE);
    assert_int_equal(info.activation, 0);
    assert_int_equal(info.n_dynamic, 0);
    assert_true(psnr > 33);
}

/* In a short run the temporal regulariser is too weak to remove motion: the file is larger than
 * necessary, but valid. */
static void test_still(void **state)
{
    const ted4_train_options o = ball_options();
    double psnr;
    const ted4_info info = train_and_look(&o, &still_scene, &psnr);

    (void)state;
    assert_int_equal(info.frames, FRAMES);
    assert_true(psnr > 33);
}

/* With a longer stage 1 and a strong regulariser, all masks are off when stage 2 begins, and bank
 * and motion are removed from the model; checkpoints of the smaller model work too. */
static void test_simplified(void **state)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;
    ted4_info info;

    (void)state;
    ball_set(&o, "temporal_weight=1");
    ball_set(&o, "lr_mask=0.02");
    ball_set(&o, "stage1=1500");
    ball_begin(&t, &o, &still_scene, NULL);
    ball_train(&t, 1500);
    assert_int_equal(t.layout.head.motion, TED4_MOTION_BANK);
    ball_train(&t, 1510);
    assert_int_equal(t.layout.head.motion, TED4_MOTION_NONE);
    assert_int_equal(ted4_checkpoint_save(&t, stop_path(0)), 0);

    ball_file f = ball_finish(&t), again;

    ted4_trainer_finish(&t);
    assert_true(ball_decoded_psnr(&f, &still_scene, &info) > 36);
    assert_int_equal(info.motion, TED4_MOTION_NONE);
    ball_begin(&t, &o, &still_scene, NULL);
    assert_int_equal(ted4_checkpoint_load(&t, stop_path(0)), 0);
    again = ball_finish(&t);
    ted4_trainer_finish(&t);
    ball_check_same(&f, &again);
    free(f.bytes);
    free(again.bytes);
}

/* ---- rate ---- */

/* Compares the bits of all anchors, as the trainer counts them at the end, with the substreams of
 * the file. */
static void test_rate(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;
    ted4_scene *s;
    ted4_bits coded;
    double bits[TED4_TYPES], sum = 0, want = 0;

    (void)state;
    ball_begin(&t, &o, &moving_scene, NULL);
    ball_train(&t, ted4_trainer_total(&t));
    assert_int_equal(ted4_export_scene(&t, &s), 0);
    assert_int_equal(ted4_count(s, NULL, &coded, NULL), TED4_OK);
    ted4_scene_free(s);
    assert_int_equal(ted4_visible_blocks_fill(&t, NULL), 0);

    const ted4_rate_input in = ted4_visible_blocks_rate(&t);

    ted4_rate_pack(t.work.rate, t.net.value);
    assert_int_equal(ted4_rate_evaluate(t.work.rate, &in, NULL, NULL, NULL, NULL,
                                        t.visible_blocks.steps, bits),
                     0);
    for (int y = 0; y < TED4_TYPES; y++) {
        assert_true(fabs(bits[y] - coded.type[y]) < 0.02 * coded.type[y]);
        sum += bits[y];
        want += coded.type[y];
    }
    ted4_trainer_finish(&t);
    assert_true(want > 1000);
    assert_true(fabs(sum - want) < 0.01 * want);
}

/* ---- values that are not finite ---- */

/* A NaN or an infinity in a network is never written; the next step detects it, says where, and
 * goes back (test_monitor.c). */
static void check_nan(uint64_t iteration, int which)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;
    ted4_scene *s;

    ball_begin(&t, &o, &moving_scene, NULL);
    ball_train(&t, iteration);

    const ted4_layout *l = &t.layout;
    const size_t at = which < TED4_NETS_R    ? l->netr + l->shape.netr[which].first
                      : which == TED4_NETS_R ? l->bank + 1
                                             : l->nete + 1;

    t.net.value[at] = which % 2 ? NAN : INFINITY;
    assert_int_equal(ted4_export_scene(&t, &s), -1);
    assert_null(s);
    assert_non_null(strstr(t.message.text, "network weight is not finite at step"));
    assert_int_equal(ted4_trainer_step(&t), 0);
    assert_non_null(
        strstr(t.message.text, which == TED4_NET_PROJECT || which == TED4_NET_DEFORM
                                   ? "weight of motion is not finite at step"
                               : which < TED4_NETS_R  ? "weight of heads is not finite at step"
                               : which == TED4_NETS_R ? "weight of bank is not finite at step"
                                                      : "weight of prior is not finite at step"));
    assert_true(t.iteration < iteration);
    assert_int_equal(t.monitor.anomaly.step, iteration);
    assert_int_equal(t.monitor.state.rollbacks, 1);
    ted4_trainer_finish(&t);
}

static void test_nan(void **state)
{
    (void)state;
    for (int i = 0; i < TED4_NETS_R + 2; i++) {
        check_nan(20, i);
        check_nan(STAGE1 + 5, i);
    }
    check_nan(INTEGER_FROM + 5, TED4_NETS_R + 1);
}

/* A bad value of an anchor is detected by the first step whose picture may show the anchor, or by
 * the next check of all anchors, at most 100 steps later. */
static void test_nan_anchor(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;
    ted4_scene *s;

    (void)state;
    ball_begin(&t, &o, &moving_scene, NULL);
    ball_train(&t, 30);
    *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 7, 2) = NAN;
    assert_int_equal(ted4_export_scene(&t, &s), -1);
    for (int i = 0; i < 100 && t.monitor.state.rollbacks == 0; i++)
        assert_int_equal(ted4_trainer_step(&t), 0);
    assert_int_equal(t.monitor.state.rollbacks, 1);
    assert_non_null(strstr(t.message.text, "value of feature of anchor 7 is not finite"));
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_learns),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_checkpoints),
        cmocka_unit_test(test_single_frame),
        cmocka_unit_test(test_still),
        cmocka_unit_test(test_simplified),
        cmocka_unit_test(test_rate),
        cmocka_unit_test(test_nan),
        cmocka_unit_test(test_nan_anchor),
        cmocka_unit_test(test_bad_checkpoints),
        cmocka_unit_test(test_impossible_state),
    };

    return cmocka_run_group_tests_name("trainer", tests, set_up, tear_down);
}
