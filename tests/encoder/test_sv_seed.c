/* test_sv_seed.c - train/densify/sv_seed.h: before one camera a time, a moving ball without initial
 * points gets anchors on the rays of the pixels that miss it, at its depth and its times, within
 * the budget; scenes with more cameras get none.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>

#include "test.h"

#define BALL_FRAMES 24
#include "ball_group.h"
#include "ball_missing.h"
#include "odd_threads.h"
#include "train/densify/cell_view.h"
#include "train/densify/sv_seed.h"
#include "train/state/anchor_masks.h"
#include "train/state/picture.h"
#include "train/step/events.h"

/* The blue ball moves by 0.3 of its radius per frame. */
enum { SPEED = 2, STEPS = 80, MANY = 1000 };

static int set_up_without_blue(void **state)
{
    (void)state;
    ball_load_without_blue(&folder, &balls, FRAMES, SPEED);
    return 0;
}

/* At frame f the cameras f % turns to f % turns + cameras - 1 take pictures. */
static void take_turns(uint32_t turns, uint32_t cameras)
{
    for (size_t i = 0; i < balls.n_pictures; i++) {
        ted4_picture *p = &balls.pictures[i];
        const uint32_t first = p->frame % turns;

        p->is_test = p->camera_id < first || p->camera_id >= first + cameras;
    }
}

static ted4_train_options options(void)
{
    ted4_train_options o = ball_options();

    o.stage1 = 10 * STEPS;
    o.sprouts = 0.5;
    o.max_anchors = 400;
    return o;
}

static void begin(ted4_trainer *t, const ted4_parallel *p)
{
    const ted4_train_options o = options();

    ball_begin(t, &o, &balls, p);
    ball_train(t, STEPS);
}

static void seed(ted4_trainer *t, size_t most)
{
    if (ted4_sv_seed(t, most) != 0)
        fail_msg("%s", t->message.text);
}

/* ---- where ---- */

/* Returns whether a training picture of some frame at which anchor i is active sees it within a
 * thousandth of a pixel of the middle of a pixel; cells are pixels here. shift: by how much anchors
 * that move are moved, on each axis, at all times. */
static int is_on_ray(const ted4_trainer *t, size_t i, float shift)
{
    float p[3], centre[3];

    for (int k = 0; k < 3; k++)
        p[k] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, k) +
               (ted4_is_dynamic(t, i) ? shift : 0.0f);
    for (size_t k = 0; k < balls.n_pictures; k++) {
        const ted4_picture *pic = &balls.pictures[k];
        ted4_view v;

        if (pic->is_test || !ball_lives_at(t, i, pic->frame))
            continue;
        ted4_trainer_view(t, pic, &v, centre);

        const float z = v.R[6] * p[0] + v.R[7] * p[1] + v.R[8] * p[2] + v.t[2];
        const float x = v.fx * (v.R[0] * p[0] + v.R[1] * p[1] + v.R[2] * p[2] + v.t[0]) / z + v.cx -
                        0.5f;
        const float y = v.fy * (v.R[3] * p[0] + v.R[4] * p[1] + v.R[5] * p[2] + v.t[1]) / z + v.cy -
                        0.5f;

        if (fabsf(x - roundf(x)) < 1e-3f && fabsf(y - roundf(y)) < 1e-3f)
            return 1;
    }
    return 0;
}

/* With cameras in turn, most new anchors lie where the ball is at the middle of their lives, though
 * it moves from picture to picture; each is on the ray of a pixel of its time. */
static void test_found(void **state)
{
    ted4_trainer t;
    size_t near, before;

    (void)state;
    take_turns(4, 1);
    begin(&t, NULL);
    assert_true(ted4_sv_seed_applies(&t));
    ball_stop_motion(&t);
    before = t.anchors.n;
    seed(&t, MANY);

    /* A life spans three pictures, and ends a quarter of a frame after them. */
    const size_t n = ball_count_short_lived(&t, SPEED, 2.51f / (FRAMES - 1), &near);

    print_message("%zu new anchors, %zu on the ball\n", n, near);
    assert_true(n > 100);
    assert_int_equal(n, t.anchors.n - before);
    assert_true(10 * near > 6 * n);
    for (size_t i = 0; i < t.anchors.n; i++)
        assert_true(!ted4_is_short_lived(&t, i) || is_on_ray(&t, i, 0));
    ted4_trainer_finish(&t);
}

/* Whatever motion a new anchor takes from its parent, its ray is right. */
static void test_moved(void **state)
{
    const float shift = 0.05f;
    ted4_trainer t;
    size_t moving = 0;

    (void)state;
    take_turns(4, 1);
    begin(&t, NULL);
    ball_stop_motion(&t);
    ball_set_biases(&t, TED4_NET_DEFORM, 3 + t.layout.head.feature_dim, shift);
    for (size_t i = 0; i < t.anchors.n; i++)
        *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.temporal_logit) = 1.0f;
    seed(&t, MANY);
    for (size_t i = 0; i < t.anchors.n; i++) {
        if (!ted4_is_short_lived(&t, i))
            continue;
        moving += ted4_is_dynamic(&t, i);
        assert_true(is_on_ray(&t, i, shift));
    }
    assert_true(moving > 100);
    ted4_trainer_finish(&t);
}

/* One camera that stands still knows no depth: the rays and the times are right all the same. Two
 * cameras a time know it, but chance matches are frequent; scenes of either kind get no seeding. */
static void test_other_rigs(void **state)
{
    (void)state;
    for (uint32_t cameras = 1; cameras <= 2; cameras++) {
        ted4_trainer t;
        size_t near;

        take_turns(1, cameras);
        begin(&t, NULL);
        assert_false(ted4_sv_seed_applies(&t));
        ball_stop_motion(&t);
        seed(&t, MANY);

        const size_t n = ball_count_short_lived(&t, SPEED, 2.51f / (FRAMES - 1), &near);

        print_message("%u cameras: %zu new anchors, %zu on the ball\n", cameras, n, near);
        assert_true(n > 100);
        if (cameras == 2)
            assert_true(2 * near > n);
        for (size_t i = 0; i < t.anchors.n; i++)
            assert_true(!ted4_is_short_lived(&t, i) || is_on_ray(&t, i, 0));
        ted4_trainer_finish(&t);
    }
}

/* ---- how many ---- */

/* A budget is kept, and spread over the sequence: its anchors are larger, or fewer for each
 * picture. */
static void test_budget(void **state)
{
    static const size_t budgets[] = { 0, 1, 12, 60 };

    (void)state;
    take_turns(4, 1);
    for (size_t b = 0; b < sizeof budgets / sizeof budgets[0]; b++) {
        ted4_trainer t;
        size_t before, halves[2] = { 0, 0 };

        begin(&t, NULL);
        before = t.anchors.n;
        seed(&t, budgets[b]);
        assert_true(t.anchors.n <= before + budgets[b]);
        assert_true(4 * (t.anchors.n - before) >= budgets[b]);
        for (size_t i = 0; i < t.anchors.n; i++)
            if (ted4_is_short_lived(&t, i))
                halves[*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i,
                                          t.layout.first[TED4_TAU]) >= 0.5f]++;
        assert_int_equal(halves[0] + halves[1], t.anchors.n - before);
        if (budgets[b] >= 12) {
            assert_true(halves[0] >= budgets[b] / 6);
            assert_true(halves[1] >= budgets[b] / 12);
        }
        ted4_trainer_finish(&t);
    }
}

/* Returns the mean of the log-scales of the short-lived anchors. */
static double mean_log_scale(const ted4_trainer *t)
{
    double sum = 0;
    size_t n = 0;

    for (size_t i = 0; i < t->anchors.n; i++) {
        if (!ted4_is_short_lived(t, i))
            continue;
        sum += (double)*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                          t->layout.first[TED4_SCALING]);
        n++;
    }
    return sum / (double)n;
}

/* Few anchors are large, so that they cover what is missing. */
static void test_sizes(void **state)
{
    double size[2];

    (void)state;
    take_turns(4, 1);
    for (int few = 0; few < 2; few++) {
        ted4_trainer t;

        begin(&t, NULL);
        seed(&t, few ? 40 : MANY);
        size[few] = mean_log_scale(&t);
        ted4_trainer_finish(&t);
    }
    assert_true(size[1] > size[0] + 1.5);
    assert_true(size[1] < size[0] + 3.5);
}

/* If whole pictures are wrong, and there are more pictures than anchors, the anchors are spread
 * over the sequence. */
static void test_spread(void **state)
{
    ted4_trainer t;
    size_t halves[2] = { 0, 0 };

    (void)state;
    take_turns(4, 1);
    begin(&t, NULL);
    memset(t.layout.head.background, 255, sizeof t.layout.head.background);

    const size_t before = t.anchors.n;

    seed(&t, 12);
    assert_true(t.anchors.n > before + 2);
    assert_true(t.anchors.n <= before + 12);
    for (size_t i = 0; i < t.anchors.n; i++)
        if (ted4_is_short_lived(&t, i))
            halves[*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.first[TED4_TAU]) >=
                   0.45f]++;
    assert_true(halves[0] > 0);
    assert_true(halves[1] > 0);
    ted4_trainer_finish(&t);
}

/* Seeding takes the anchors that growth leaves, at a tenth of stage 1. */
static void test_schedule(void **state)
{
    const ted4_train_options o = options();
    ted4_trainer t;

    (void)state;
    take_turns(3, 1);
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STEPS - 1);
    assert_int_equal(t.anchors.n + ted4_growth_allowance(&t), 200);
    ball_train(&t, STEPS);

    const size_t before = t.anchors.n;

    ball_train(&t, STEPS + 1);
    assert_int_equal(t.anchors.n + ted4_growth_allowance(&t), 400);
    assert_true(t.anchors.n > before + 20);
    assert_true(t.anchors.n <= 400);
    ted4_trainer_finish(&t);
}

/* Nothing happens with three cameras in one frame, with one frame, or without activation. */
static void test_not_applied(void **state)
{
    ted4_train_options o = options();
    ted4_trainer t;

    (void)state;
    take_turns(4, 1);
    for (size_t i = 0; i < balls.n_pictures; i++)
        if (balls.pictures[i].frame == 7)
            balls.pictures[i].is_test = balls.pictures[i].camera_id == 0;
    ball_begin(&t, &o, &balls, NULL);
    assert_false(ted4_sv_seed_applies(&t));
    ted4_trainer_finish(&t);
    take_turns(4, 1);
    o.activation = 0;
    ball_begin(&t, &o, &balls, NULL);
    assert_false(ted4_sv_seed_applies(&t));
    ted4_trainer_finish(&t);
}

/* ---- determinism ---- */

static void test_threads(void **state)
{
    static const ted4_parallel threads = { odd_threads, NULL };
    ted4_trainer a, b;

    (void)state;
    take_turns(4, 1);
    begin(&a, NULL);
    begin(&b, &threads);
    seed(&a, 90);
    seed(&b, 90);
    assert_int_equal(a.anchors.n, b.anchors.n);
    for (int r = 0; r < TED4_ROWS; r++)
        assert_memory_equal(a.anchors.data[r], b.anchors.data[r],
                            a.anchors.n_blocks * (size_t)a.anchors.rows[r] * TED4_LANES *
                                sizeof(float));
    ted4_trainer_finish(&a);
    ted4_trainer_finish(&b);
}

/* ---- cells ---- */

/* The rendered depth of a cell that shows the red ball in the middle lies in that ball, and a point
 * on a cell's ray comes back to the cell. */
static void test_cells(void **state)
{
    ted4_cell_view v = { 0 };
    ted4_trainer t;
    size_t item = 0;
    int column, row;
    float p[3];

    (void)state;
    take_turns(4, 1);
    begin(&t, NULL);
    while (balls.pictures[item].is_test)
        item++;
    assert_int_equal(ted4_cell_view_open(&t, item, 1, &v), 0);
    assert_int_equal(v.step, 1);
    assert_int_equal(v.columns, BALL_W);
    assert_int_equal(v.rows, BALL_H);

    const size_t middle = (size_t)(BALL_H / 2) * BALL_W + BALL_W / 2;
    const double unit = ldexp(1, t.layout.head.exponent);

    /* The camera is 3.2 away from the middle of a ball of radius 0.55. Early in training one sees
     * into it. Where nothing is rendered, the farthest tested depth stands. */
    assert_true(fabs((double)v.depth[middle] * unit - 3.2) < 0.55);
    assert_true((double)v.depth[0] * unit > 3.75);
    /* Where something half opaque is rendered, its depth is that of the balls all the same. */
    for (int i = 0; i < BALL_W * BALL_H; i++)
        assert_true(v.depth[i] == v.depth[0] || fabs((double)v.depth[i] * unit - 3.2) < 0.55);
    for (int r = 0; r < BALL_H; r += 5)
        for (int c = 0; c < BALL_W; c += 5) {
            ted4_cell_point(&v, c, r, v.depth[r * BALL_W + c], p);
            assert_true(ted4_cell_of(&v, p, &column, &row));
            assert_int_equal(column, c);
            assert_int_equal(row, r);
        }
    ted4_cell_view_close(&v);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_found),      cmocka_unit_test(test_moved),
        cmocka_unit_test(test_other_rigs), cmocka_unit_test(test_budget),
        cmocka_unit_test(test_schedule),   cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_spread),     cmocka_unit_test(test_not_applied),
        cmocka_unit_test(test_threads),    cmocka_unit_test(test_cells),
    };

    return cmocka_run_group_tests_name("sv_seed", tests, set_up_without_blue, tear_down);
}
