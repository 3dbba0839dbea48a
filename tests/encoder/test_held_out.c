/* test_held_out.c - held-out pictures decide nothing: a training gives the same file, bit for bit,
 * whatever they show. Here they show the scene, or flicker between black and noise. With one of
 * four cameras held out, multi-view seeding takes place; with two, the flicker would be that of
 * most cameras; with one frame of every camera held out, all colours are corrected.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "ball_trainer.h"
#include "test.h"
#include "train/math/random.h"

enum { FRAMES = 5, MOST_HELD_OUT = 2, HELD_OUT_FRAME = 2 };

/* Overwrites a picture with nonsense: black in even frames, unless all is noise. */
static void spoil(const tiny_folder *f, int camera, int frame, int all)
{
    uint8_t px[BALL_W * BALL_H * 3] = { 0 };
    char name[64];

    for (size_t i = 0; (all || frame % 2 == 1) && i < sizeof px; i++)
        px[i] = (uint8_t)ted4_below(17, i + 10000 * (uint64_t)camera, 256);
    snprintf(name, sizeof name, "images/c%d_f%d.png", camera, frame);
    tiny_png(f, name, BALL_W, BALL_H, PNG_FORMAT_RGB, px);
}

/* Trains, and asserts that the model was tried without time. */
static ball_file train(ted4_dataset *d)
{
    ted4_train_options options = ball_options();
    ted4_trainer t;
    ball_file file;
    uint32_t held_out = 0;

    ball_set(&options, "stage1=1000");
    ball_set(&options, "probe=0.2");
    ball_begin(&t, &options, d, NULL);
    for (size_t i = 0; i < d->n_pictures; i++)
        held_out += d->pictures[i].is_test;
    assert_true(held_out > 0);
    assert_int_equal(t.order.n, d->n_pictures - held_out);
    file = ball_finish(&t);
    assert_true(t.search.probe_loss[0] > 0);
    ted4_trainer_finish(&t);
    return file;
}

static void load(ted4_dataset *d, const tiny_folder *f, const ted4_dataset_options *o)
{
    ted4_message m;

    if (ted4_dataset_load(d, f->path, o, &m) != 0)
        fail_msg("%s", m.text);
}

/* Trains on the scene of balls with the last n cameras held out. */
static ball_file train_without_cameras(int n, int spoilt)
{
    char name[MOST_HELD_OUT][32];
    const char *names[MOST_HELD_OUT];
    const ted4_dataset_options o = { .downscale = 1,
                                     .seed = 3,
                                     .cache_bytes = 1 << 20,
                                     .hold_out = names,
                                     .n_hold_out = (size_t)n };
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ball_file file;

    ball_scene(&f, FRAMES, 1);
    for (int i = 0; i < n; i++) {
        const int camera = BALL_CAMERAS - 1 - i;

        snprintf(name[i], sizeof name[i], "c%d_f0.png", camera);
        names[i] = name[i];
        for (int frame = 0; spoilt && frame < FRAMES; frame++)
            spoil(&f, camera, frame, 0);
    }
    load(&d, &f, &o);
    file = train(&d);
    ted4_dataset_free(&d);
    tiny_free(&f);
    return file;
}

/* Trains with one frame of every camera held out. */
static ball_file train_without_frame(int spoilt)
{
    const ted4_dataset_options o = { .downscale = 1, .seed = 3, .cache_bytes = 1 << 20 };
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ball_file file;

    ball_scene(&f, FRAMES, 1);
    for (int camera = 0; spoilt && camera < BALL_CAMERAS; camera++)
        spoil(&f, camera, HELD_OUT_FRAME, 1);
    load(&d, &f, &o);
    for (size_t i = 0; i < d.n_pictures; i++)
        d.pictures[i].is_test = d.pictures[i].frame == HELD_OUT_FRAME;
    file = train(&d);
    ted4_dataset_free(&d);
    tiny_free(&f);
    return file;
}

static void check_same(ball_file plain, ball_file spoilt)
{
    ball_check_same(&plain, &spoilt);
    free(plain.bytes);
    free(spoilt.bytes);
}

static void test_cameras(void **state)
{
    (void)state;
    for (int n = 1; n <= MOST_HELD_OUT; n++)
        check_same(train_without_cameras(n, 0), train_without_cameras(n, 1));
}

static void test_frame(void **state)
{
    (void)state;
    check_same(train_without_frame(0), train_without_frame(1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_frame),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
