/* test_ranks.c - a training by several processes, here threads, that share views and blocks: the
 * file is that of one process, and so is the anchor that the monitor blames. They stay together
 * when the training of a still scene starts again.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "ball_trainer.h"
#include "rank_threads.h"
#include "train/monitor/grad_norm.h"

enum { FRAMES = 3 };

typedef struct {
    ted4_exchange x;
    tiny_folder folder;
    ted4_dataset data;
    ball_file file;
    int64_t blamed; /* after the first steps of several views */
    uint64_t alone; /* steps that were not shared, of those after a new start */
} process;

static void *train(void *arg)
{
    process *p = arg;
    ted4_train_options o = ball_options();
    ted4_trainer t;
    int finite;

    ball_set(&o, "batch=4");
    ball_set(&o, "stage1=60");
    ball_set(&o, "stage2=40");
    ball_begin(&t, &o, &p->data, NULL);
    t.exchange = p->x.n > 1 ? &p->x : NULL;
    ball_train(&t, 15);
    p->blamed = ted4_gradients_anchor(&t, TED4_TERM_CENTRE, &finite);
    p->file = ball_finish(&t);
    ted4_trainer_finish(&t);
    return NULL;
}

/* Trains on a still scene until the static test has made the trainer start again, and some steps
 * more. The parameters of motion do not learn, so that the test drops time. */
static void *train_still(void *arg)
{
    static const char *const set[] = { "batch=4",     "stage1=1000", "probe=0.2",
                                       "lr_motion=0", "lr_phi=0",    "lr_tau=0" };
    enum { BEGIN = 1000 / 4, MORE = 10 };
    process *p = arg;
    ted4_train_options o = ball_options();
    ted4_trainer t;

    for (size_t i = 0; i < sizeof set / sizeof set[0]; i++)
        ball_set(&o, set[i]);
    ball_begin(&t, &o, &p->data, NULL);
    t.exchange = p->x.n > 1 ? &p->x : NULL;
    ball_train(&t, BEGIN);
    assert_int_equal(ted4_trainer_step(&t), 0);
    assert_int_equal(t.iteration, 1);
    assert_int_equal(t.layout.head.motion, TED4_MOTION_NONE);

    const uint64_t shared = p->x.steps;

    ball_train(&t, 1 + MORE);
    p->alone = MORE - (p->x.steps - shared);
    p->file = ball_finish(&t);
    ted4_trainer_finish(&t);
    return NULL;
}

static void start(process *p, size_t n, int moving, void *(*work)(void *process))
{
    memset(p, 0, n * sizeof *p);
    for (size_t r = 0; r < n; r++)
        ball_load(&p[r].folder, &p[r].data, FRAMES, moving);
    rank_run(n, p, sizeof *p, work);
}

static void finish(process *p, size_t n)
{
    for (size_t r = 0; r < n; r++) {
        free(p[r].file.bytes);
        ted4_dataset_free(&p[r].data);
        tiny_free(&p[r].folder);
    }
}

static void test_same_file(void **state)
{
    static process one, p[MOST_RANKS];

    (void)state;
    start(&one, 1, 1, train);
    for (size_t n = 2; n <= 5; n++) {
        start(p, n, 1, train);
        for (size_t r = 0; r < n; r++) {
            assert_int_equal(p[r].file.size, one.file.size);
            assert_memory_equal(p[r].file.bytes, one.file.bytes, one.file.size);
            assert_int_equal(p[r].blamed, one.blamed);
            assert_true(p[r].x.steps > 0 && p[r].x.bytes > 0);
        }
        finish(p, n);
    }
    finish(&one, 1);
}

static void test_still_scene(void **state)
{
    static process one, p[2];

    (void)state;
    start(&one, 1, 0, train_still);
    start(p, 2, 0, train_still);
    for (size_t r = 0; r < 2; r++) {
        assert_int_equal(p[r].alone, 0);
        ball_check_same(&p[r].file, &one.file);
    }
    finish(p, 2);
    finish(&one, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_file),
        cmocka_unit_test(test_still_scene),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
