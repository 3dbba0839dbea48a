/* test_held_out.c - held-out pictures decide nothing: a training gives the same file, bit for bit,
 * whatever they show. Here they show the scene, or flicker between black and noise. With one of
 * four cameras held out, multi-view seeding takes place; with two, the flicker would be that of
 * most cameras.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "ball_trainer.h"
#include "train/math/random.h"
#include "test.h"

enum { FRAMES = 5, MOST_HELD_OUT = 2 };

/* Overwrites the pictures of a camera with nonsense. */
static void spoil_camera(const tiny_folder *f, int camera)
{
    for (int frame = 0; frame < FRAMES; frame++) {
        uint8_t px[BALL_W * BALL_H * 3] = { 0 };
        char name[64];

        for (size_t i = 0; frame % 2 == 1 && i < sizeof px; i++)
            px[i] = (uint8_t)ted4_below(17, i + 10000 * (uint64_t)camera, 256);
        snprintf(name, sizeof name, "images/c%d_f%d.png", camera, frame);
        tiny_png(f, name, BALL_W, BALL_H, PNG_FORMAT_RGB, px);
    }
}

/* Trains on the scene of balls with the last n cameras held out. */
static ball_file train(int n, int spoilt)
{
    char name[MOST_HELD_OUT][32];
    const char *names[MOST_HELD_OUT];
    ted4_train_options options = ball_options();
    ted4_dataset_options o = { .downscale = 1,
                               .seed = 3,
                               .cache_bytes = 1 << 20,
                               .hold_out = names,
                               .n_hold_out = (size_t)n };
    tiny_folder f = tiny_new();
    ted4_dataset d;
    ted4_message m;
    ted4_trainer t;
    ball_file file;

    ball_scene(&f, FRAMES, 1);
    for (int i = 0; i < n; i++) {
        const int camera = BALL_CAMERAS - 1 - i;

        snprintf(name[i], sizeof name[i], "c%d_f0.png", camera);
        names[i] = name[i];
        if (spoilt)
            spoil_camera(&f, camera);
    }
    if (ted4_dataset_load(&d, f.path, &o, &m) != 0)
        fail_msg("%s", m.text);
    ball_set(&options, "stage1=1000");
    ball_set(&options, "probe=0.2");
    ball_begin(&t, &options, &d, NULL);
    assert_int_equal(t.order.n, (BALL_CAMERAS - n) * FRAMES);
    file = ball_finish(&t);
    assert_true(t.search.probe_loss[0] > 0);
    ted4_trainer_finish(&t);
    ted4_dataset_free(&d);
    tiny_free(&f);
    return file;
}

static void test_unseen(void **state)
{
    (void)state;
    for (int n = 1; n <= MOST_HELD_OUT; n++) {
        ball_file plain = train(n, 0), spoilt = train(n, 1);

        ball_check_same(&plain, &spoilt);
        free(plain.bytes);
        free(spoilt.bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_unseen),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
