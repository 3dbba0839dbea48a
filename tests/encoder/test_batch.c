/* test_batch.c - steps that learn from several views of one time: the order of pictures, sums over
 * views, gradients against those of single views, learning rates, threads and checkpoints.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>

#include "ball_group.h"
#include "larger.h"
#include "odd_threads.h"
#include "tool/threads.h"
#include "train/math/random.h"
#include "train/monitor/checkpoint.h"
#include "train/state/picture.h"
#include "train/state/view_batch.h"
#include "train/step/apply_gradients.h"
#include "train/step/picture_order.h"

static ted4_train_options options(int batch)
{
    ted4_train_options o = ball_options();

    o.batch = batch;
    return o;
}

/* ---- the order of pictures ---- */

/* Goes through a round, and counts how often each picture comes. Returns the number of batches, and
 * in *first the first picture. */
static size_t run_round(ted4_trainer *t, uint32_t *seen, uint32_t *first)
{
    size_t batches = 0;

    for (uint32_t taken = 0; taken == 0 || taken < t->order.end; batches++) {
        const uint32_t *item;
        size_t n;

        assert_int_equal(ted4_next_pictures(t, &item, &n), 0);
        assert_in_range(n, 1, (size_t)t->opt.batch);
        if (taken == 0)
            *first = item[0];
        for (size_t i = 0; i < n; i++) {
            assert_int_equal(balls.pictures[item[i]].frame, balls.pictures[item[0]].frame);
            seen[item[i]]++;
        }
        taken += (uint32_t)n;
        assert_int_equal(t->order.next, taken);
    }
    return batches;
}

/* A batch is of one time and as full as it can be: the balls have four cameras, of which some
 * pictures may be held out. In each round, a picture of which none of its time waits comes once. */
static void test_order(void **state)
{
    (void)state;
    for (int batch = 1; batch <= 5; batch++) {
        const ted4_train_options o = options(batch);
        uint32_t seen[64] = { 0 }, first[3] = { 0 };
        ted4_trainer t;

        ball_begin(&t, &o, &balls, NULL);
        assert_true(balls.n_pictures <= 64);
        for (uint32_t round = 1; round <= 3; round++) {
            run_round(&t, seen, &first[round - 1]);
            for (uint32_t i = 0; i < t.order.n; i++)
                assert_in_range(seen[t.order.item[i]], batch == 1 || batch > 3 ? round : round - 1,
                                round);
        }
        assert_true(first[0] != first[1] || first[1] != first[2]);
        ted4_trainer_finish(&t);
    }
}

/* Of the four pictures of a time, three make a batch, and each waits in every fourth round. A time
 * of two has batches of two. */
static void test_full_batches(void **state)
{
    const ted4_train_options o = options(3);
    uint32_t seen[64] = { 0 }, first;
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    t.order.n = 0;
    for (uint32_t i = 0, last = 0; i < balls.n_pictures; i++) {
        balls.pictures[i].is_test = 0;
        last += balls.pictures[i].frame == 0;
        if (balls.pictures[i].frame > 0 || last <= 2)
            t.order.item[t.order.n++] = i;
    }
    t.order.next = t.order.n;
    for (uint32_t round = 1; round <= 20; round++) {
        uint32_t least = UINT32_MAX, most = 0;

        assert_int_equal(run_round(&t, seen, &first), FRAMES);
        for (uint32_t i = 0; i < t.order.n; i++) {
            const uint32_t item = t.order.item[i], count = seen[item];

            if (balls.pictures[item].frame == 0)
                assert_int_equal(count, round);
            else
                assert_in_range(count, round * 3 / 4, (round * 3 + 3) / 4);
            least = balls.pictures[item].frame > 0 && count < least ? count : least;
            most = balls.pictures[item].frame > 0 && count > most ? count : most;
        }
        assert_int_equal(most - least, round % 4 != 0);
    }
    ted4_trainer_finish(&t);
}

/* A training that begins in the middle of a round, as from a checkpoint, ends it at the same
 * picture. */
static void test_round_goes_on(void **state)
{
    const ted4_train_options o = options(3);
    uint32_t seen[64] = { 0 }, first;
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    run_round(&t, seen, &first);

    const uint32_t end = t.order.end, *item;
    size_t n;

    t.order.end = 0;
    t.order.next = end - 1;
    assert_int_equal(ted4_next_pictures(&t, &item, &n), 0);
    assert_int_equal(t.order.end, end);
    assert_int_equal(n, 1);
    ted4_trainer_finish(&t);
}

/* With batches that hold all pictures of a time, each round goes through the times in another
 * order: of 20 rounds, about a fifth begin with any one of the five times. */
static void test_order_of_times(void **state)
{
    const ted4_train_options o = options(BALL_CAMERAS);
    unsigned begins[FRAMES] = { 0 };
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    for (int round = 0; round < 20; round++)
        for (uint32_t taken = 0; taken < t.order.n;) {
            const uint32_t *item;
            size_t n;

            assert_int_equal(ted4_next_pictures(&t, &item, &n), 0);
            begins[balls.pictures[item[0]].frame] += taken == 0;
            taken += (uint32_t)n;
        }
    for (int frame = 0; frame < FRAMES; frame++)
        assert_in_range(begins[frame], 0, 12);
    ted4_trainer_finish(&t);
}

/* ---- sums ---- */

enum { N_VALUES = 20000 };

static float view_value(size_t view, size_t i)
{
    return (ted4_uniform(view, i) - 0.5f) * ldexpf(1, (int)(i % 30));
}

/* The sum of value i over views [from, to): of a range that begins at a multiple of its length, a
 * power of two, by halves; what is left over to the right is added from the right. */
static float tree(size_t from, size_t to, size_t i)
{
    size_t half = 1;

    if (to - from == 1)
        return view_value(from, i);
    while (2 * half < to - from)
        half *= 2;
    return tree(from, from + half, i) + tree(from + half, to, i);
}

static void test_sums(void **state)
{
    const ted4_parallel odd = { .run = odd_threads };
    ted4_view_sums s = { .size = 0 };

    (void)state;
    for (size_t n = 1; n <= TED4_MAX_VIEWS; n++) {
        const ted4_parallel *p = n % 2 ? &odd : NULL;

        assert_int_equal(ted4_view_sums_begin(&s, N_VALUES, n), 0);
        for (size_t view = 0; view < n; view++) {
            float *x = ted4_view_sums_next(&s);

            for (size_t i = 0; i < N_VALUES; i++)
                x[i] = view_value(view, i);
            ted4_view_sums_add(&s, p);
        }

        float *mean = ted4_view_sums_total(&s, p);

        ted4_view_sums_scale(mean, N_VALUES, 1.0f / (float)n, p);

        for (size_t i = 0; i < N_VALUES; i++)
            assert_true(mean[i] == tree(0, n, i) * (1.0f / (float)n));
    }
    ted4_view_sums_finish(&s);
}

/* ---- gradients ---- */

enum { VIEWS = 3, MOST = 200000 };

/* The gradients of a step: networks, then anchors by their number. */
static double want[MOST], got[MOST];

/* Adds the gradients of the pictures item[n] as one batch, times scale; loss: its mean. */
static double add_gradients(ted4_trainer *t, const uint32_t *item, size_t n, double scale,
                            double *sum)
{
    const size_t floats = (size_t)t->layout.n_channels * TED4_LANES;
    static ted4_view_batch b;
    double loss = 0, l1, ssim;

    assert_true(t->layout.n_net + t->anchors.n_blocks * floats <= MOST);
    assert_int_equal(ted4_batch_begin(t, &b, item, n, 0), 0);
    for (size_t i = 0; i < n; i++) {
        const uint8_t *truth = ted4_dataset_pixels(t->data, item[i], &t->message);

        assert_int_equal(ted4_batch_render(t, &b, i), 0);
        loss += ted4_trainer_loss(t, &balls.pictures[item[i]], truth, NULL, &l1, &ssim) / (double)n;
        ted4_dataset_release(t->data, item[i]);
        assert_int_equal(ted4_batch_render_backward(t, &b, i), 0);
        ted4_batch_add(t, &b);
    }
    memset(t->net.gradient, 0, t->layout.n_net * sizeof *t->net.gradient);
    assert_int_equal(ted4_batch_backward(t, &b), 0);
    for (size_t i = 0; i < t->layout.n_net; i++)
        sum[i] += scale * (double)t->net.gradient[i];
    for (size_t i = 0; i < t->visible_blocks.n; i++)
        for (size_t k = 0; k < floats; k++)
            sum[t->layout.n_net + t->visible_blocks.block[i] * floats + k] +=
                scale * (double)t->visible_blocks.gradient[i][k];
    return loss;
}

/* Fills item[VIEWS] with pictures of one time. */
static void pictures_of_one_time(uint32_t *item)
{
    size_t n = 0;

    for (uint32_t i = 0; i < balls.n_pictures && n < VIEWS; i++)
        if (balls.pictures[i].frame == 2)
            item[n++] = i;
    assert_int_equal(n, VIEWS);
}

/* Asserts that a batch has the mean gradients of its views, one by one. */
static void check_gradients(ted4_trainer *t)
{
    uint32_t item[VIEWS];
    double most = 0, loss = 0;

    pictures_of_one_time(item);
    memset(want, 0, sizeof want);
    memset(got, 0, sizeof got);
    for (size_t i = 0; i < VIEWS; i++)
        loss += add_gradients(t, item + i, 1, 1.0 / VIEWS, want) / VIEWS;

    const double together = add_gradients(t, item, VIEWS, 1, got);

    assert_true(fabs(together - loss) <= 1e-6 * loss);
    for (size_t i = 0; i < MOST; i++)
        most = larger(most, fabs(want[i]));
    assert_true(most > 0);
    for (size_t i = 0; i < MOST; i++)
        if (!(fabs(got[i] - want[i]) <= 1e-4 * fabs(want[i]) + 2e-6 * most))
            fail_msg("gradient %zu of %zu: %g, not %g", i, t->layout.n_net, got[i], want[i]);
}

static void test_gradients(void **state)
{
    (void)state;
    for (int view = 0; view <= 1; view++)
        for (int motion = 0; motion <= 3; motion += 3) {
            ted4_train_options o = options(VIEWS);
            ted4_trainer t;

            o.view = view;
            o.motion = motion;
            ball_begin(&t, &o, &balls, NULL);
            ball_train(&t, 250);
            check_gradients(&t);
            if (view == 1 && motion == 3) {
                ball_train(&t, 450); /* with the noise of stage 2 */
                check_gradients(&t);
            }
            ted4_trainer_finish(&t);
        }
}

/* Views that see different anchors: each view draws only what it sees, and all is learnt. */
static void test_other_anchors(void **state)
{
    const ted4_train_options o = options(VIEWS);
    uint32_t item[VIEWS];
    ted4_trainer t;

    (void)state;
    pictures_of_one_time(item);

    const ted4_camera whole = balls.pictures[item[1]].camera;

    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, 120);
    balls.pictures[item[1]].camera.t[0] += 2.5; /* looks past most of the scene */
    balls.pictures[item[1]].camera.fx *= 3;
    check_gradients(&t);
    balls.pictures[item[1]].camera = whole;
    ted4_trainer_finish(&t);
}

/* ---- the optimiser ---- */

/* Returns the largest change of n numbers. */
static double largest_change(const float *from, const float *to, size_t n)
{
    double most = 0;

    for (size_t i = 0; i < n; i++)
        most = larger(most, fabsf(to[i] - from[i]));
    return most;
}

/* The first step of Adam moves everything by its learning rate, for four views by twice that. */
static void test_rates(void **state)
{
    const ted4_train_options o = options(1);
    double value[2], weight[2];

    (void)state;
    for (int k = 0; k < 2; k++) {
        uint32_t item[VIEWS];
        ted4_trainer t;

        pictures_of_one_time(item);
        ball_begin(&t, &o, &balls, NULL);
        add_gradients(&t, item, 1, 1, got);

        const size_t n = (size_t)t.layout.n_channels * TED4_LANES, n_net = t.layout.nete;
        float *before = malloc((n + n_net) * sizeof *before);

        assert_non_null(before);
        memcpy(before, t.visible_blocks.raw[0], n * sizeof *before);
        memcpy(before + n, t.net.value, n_net * sizeof *before);
        ted4_update_parameters(&t, k == 0 ? 1 : 4);
        value[k] = largest_change(before, t.visible_blocks.raw[0], n);
        weight[k] = largest_change(before + n, t.net.value, n_net);
        free(before);
        ted4_trainer_finish(&t);
    }
    assert_true(value[0] > 0 && weight[0] > 0);
    assert_true(fabs(value[1] / value[0] - 2) < 1e-3);
    assert_true(fabs(weight[1] / weight[0] - 2) < 1e-3);
}

/* ---- identical bytes ---- */

static ball_file run(const ted4_parallel *p)
{
    const ted4_train_options o = options(VIEWS);
    ted4_trainer t;
    ball_file f;

    ball_begin(&t, &o, &balls, p);
    f = ball_finish(&t);
    ted4_trainer_finish(&t);
    return f;
}

static void test_threads(void **state)
{
    const ball_file alone = run(NULL);
    ted4_parallel p;

    (void)state;
    ted4_threads_init(&p, 2);

    ball_file f = run(&p);

    ted4_threads_finish(&p);
    ball_check_same(&alone, &f);
    free(f.bytes);
    free(alone.bytes);
}

/* A checkpoint between two batches of one time, and in the middle of a round. */
static void test_resume(void **state)
{
    const ted4_train_options o = options(VIEWS);
    const ball_file whole = run(NULL);
    const char *path = tiny_path(&folder, "batch.checkpoint");
    ted4_trainer t;

    (void)state;
    for (uint64_t stop = 203; stop <= 427; stop += 224) {
        ball_begin(&t, &o, &balls, NULL);
        ball_train(&t, stop);
        assert_true(t.order.next > 0 && t.order.next < t.order.n);
        assert_int_equal(ted4_checkpoint_save(&t, path), 0);
        ted4_trainer_finish(&t);
        ball_begin(&t, &o, &balls, NULL);
        assert_int_equal(ted4_checkpoint_load(&t, path), 0);

        ball_file f = ball_finish(&t);

        ball_check_same(&whole, &f);
        free(f.bytes);
        ted4_trainer_finish(&t);
    }
    free(whole.bytes);
}

/* Opacity and covariance cannot be shared if they depend on the view. */
static void test_full_view(void **state)
{
    ted4_train_options o = options(2);
    ted4_trainer t;

    (void)state;
    o.view = 2;
    assert_int_equal(ted4_trainer_init(&t, &o, &balls, NULL), -1);
    assert_non_null(strstr(t.message.text, "batch"));
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_order),         cmocka_unit_test(test_full_batches),
        cmocka_unit_test(test_round_goes_on), cmocka_unit_test(test_order_of_times),
        cmocka_unit_test(test_sums),          cmocka_unit_test(test_gradients),
        cmocka_unit_test(test_other_anchors), cmocka_unit_test(test_rates),
        cmocka_unit_test(test_threads),       cmocka_unit_test(test_resume),
        cmocka_unit_test(test_full_view),
    };

    return cmocka_run_group_tests_name("batches of views", tests, set_up, tear_down);
}
