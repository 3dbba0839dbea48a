/* test_still_anchors.c - train/densify/still_anchors.h: of the anchors of a scene in which one ball
 * of three moves, those of the other two are closed in the middle of their paths, and nothing else
 * changes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "ball_group.h"
#include "train/densify/still_anchors.h"
#include "train/monitor/checkpoint.h"
#include "train/state/anchor_masks.h"
#include "train/state/dropout.h"
#include "train/state/picture.h"

/* With 800 steps of stage 1, anchors are closed before step 520. */
enum { EARLY = 512, CLOSING = 520, MOST_ANCHORS = 320 };

static float value(const ted4_trainer *t, size_t i, int channel)
{
    return *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, channel);
}

static float *position(const ted4_trainer *t, size_t i, int c)
{
    return ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, c);
}

static float *logit(const ted4_trainer *t, size_t i)
{
    return ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.temporal_logit);
}

/* Whether a point of normalised space lies on the moving ball at one time of the sequence. */
static int on_blue(const ted4_trainer *t, const float *point)
{
    const ted4_header *h = &t->layout.head;

    for (int f = 0; f < FRAMES; f++) {
        const ball b = ball_at(2, (double)f / (FRAMES - 1));
        double square = 0;

        for (int c = 0; c < 3; c++) {
            const double p = (double)h->origin[c] + ldexp((double)point[c], h->exponent);

            square += (p - b.centre[c]) * (p - b.centre[c]);
        }
        if (square < 1.44 * b.radius * b.radius)
            return 1;
    }
    return 0;
}

/* What anchors were before closing. */
typedef struct {
    float position[MOST_ANCHORS][3], logit[MOST_ANCHORS], middle[MOST_ANCHORS][3];
    int dynamic[MOST_ANCHORS];
} memory;

/* Adds, for each anchor, its position at a frame, weighted by its opacity, to sum[n][4]. The
 * position is that of its first Gaussian, less the offset of that (spec 11.5). */
static void add_frame(ted4_trainer *t, uint32_t frame, double *sum)
{
    const ted4_layout *l = &t->layout;
    const size_t K = l->head.n_offsets;
    ted4_splats s;

    ball_generate(t, frame, &s);
    for (size_t i = 0; i < t->anchors.n; i++) {
        const size_t at = i / TED4_LANES * K * TED4_LANES + i % TED4_LANES;
        double w = 1e-6;

        for (size_t k = 0; k < K; k++)
            w += (double)s.opacity[at + k * TED4_LANES];
        for (int c = 0; c < 3; c++)
            sum[4 * i + (size_t)c] +=
                w *
                ((double)s.mean[c][at] - (double)value(t, i, l->first[TED4_OFFSET] + c) *
                                             exp2((double)value(t, i, l->first[TED4_SCALING] + c)));
        sum[4 * i + 3] += w;
    }
}

static void remember(ted4_trainer *t, memory *m)
{
    static double sum[4 * MOST_ANCHORS];

    assert_in_range(t->anchors.n, 1, MOST_ANCHORS);
    memset(sum, 0, sizeof sum);
    for (uint32_t f = 0; f < FRAMES; f++)
        add_frame(t, f, sum);
    for (size_t i = 0; i < t->anchors.n; i++) {
        for (int c = 0; c < 3; c++) {
            m->position[i][c] = *position(t, i, c);
            m->middle[i][c] = (float)(sum[4 * i + (size_t)c] / sum[4 * i + 3]);
        }
        m->logit[i] = *logit(t, i);
        m->dynamic[i] = ted4_is_dynamic(t, i);
    }
}

/* Checks that closed anchors sit in the middle of their paths. Then puts everything back that
 * closing may change. Returns the number of closed anchors. */
static size_t undo(ted4_trainer *t, const memory *m)
{
    size_t closed = 0;

    for (size_t i = 0; i < t->anchors.n; i++) {
        if (!m->dynamic[i] || ted4_is_dynamic(t, i))
            continue;
        closed++;
        for (int c = 0; c < 3; c++) {
            assert_true(fabsf(*position(t, i, c) - m->middle[i][c]) < 1e-5f);
            *position(t, i, c) = m->position[i][c];
        }
        *logit(t, i) = m->logit[i];
    }
    return closed;
}

/* activation: learn it, too; in so short a scene it can stand for motion. */
static void train(ted4_trainer *t, const char *worth, int activation, uint64_t step)
{
    ted4_train_options o = ball_options();

    ball_set(&o, "stage1=800");
    ball_set(&o, "dropout=0");
    ball_set(&o, "poses=0");
    ball_set(&o, activation ? "activation=1" : "activation=0");
    ball_set(&o, worth);
    ball_begin(t, &o, &balls, NULL);
    ball_train(t, step);
}

/* Everything of the state but the record of the closing. */
static void check_same(ted4_trainer *t, const ted4_snapshot *before)
{
    ted4_snapshot after = { 0 };

    t->closing = (ted4_closing) { 0, 0, 0 };
    assert_int_equal(ted4_snapshot_take(t, &after), 0);
    assert_int_equal(after.size, before->size);
    assert_memory_equal(after.bytes, before->bytes, after.size);
    ted4_snapshot_free(&after);
}

static void test_scene(void **state)
{
    static memory m;
    ted4_snapshot before = { 0 };
    ted4_trainer t;
    size_t still[2] = { 0 }, all[2] = { 0 };

    (void)state;
    train(&t, "motion_worth=0.04", 0, EARLY);
    assert_int_equal(t.closing.moving, 0);
    remember(&t, &m);
    assert_int_equal(ted4_snapshot_take(&t, &before), 0);
    assert_int_equal(ted4_close_still_anchors(&t), 0);
    for (size_t i = 0; i < t.anchors.n; i++) {
        all[on_blue(&t, m.position[i])] += m.dynamic[i] != 0;
        still[on_blue(&t, m.position[i])] += m.dynamic[i] && !ted4_is_dynamic(&t, i);
    }
    if (all[0] < 100 || 10 * still[0] < 9 * all[0] || all[1] < 6 || 2 * still[1] > all[1])
        fail_msg("closed: %zu of %zu, on the moving ball %zu of %zu", still[0], all[0], still[1],
                 all[1]);
    assert_int_equal(t.closing.anchors, t.anchors.n);
    assert_int_equal(t.closing.moving, all[0] + all[1]);
    assert_int_equal(t.closing.closed, still[0] + still[1]);
    assert_int_equal(undo(&t, &m), still[0] + still[1]);
    check_same(&t, &before);
    ted4_snapshot_free(&before);
    ted4_trainer_finish(&t);
}

/* Times at which an anchor is not there count less. */
static void test_spans(void **state)
{
    static memory m;
    ted4_snapshot before = { 0 };
    ted4_trainer t;

    (void)state;
    train(&t, "motion_worth=0.04", 1, EARLY);
    for (size_t i = 0; i < t.anchors.n; i += 2) /* gone in the second half */
        *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.first[TED4_TAU] + 2) = 0.5f;
    remember(&t, &m);
    assert_int_equal(ted4_snapshot_take(&t, &before), 0);
    assert_int_equal(ted4_close_still_anchors(&t), 0);
    assert_true(t.closing.closed > 50);
    assert_int_equal(undo(&t, &m), t.closing.closed);
    check_same(&t, &before);
    ted4_snapshot_free(&before);
    ted4_trainer_finish(&t);
}

/* Returns the sum over all training pictures of how far each distortion is from before[]; before
 * NULL: only fills distortion[]. */
static double compare(ted4_trainer *t, const double *before, double *distortion)
{
    double sum = 0;

    for (uint32_t k = 0; k < t->order.n; k++) {
        distortion[k] = ted4_trainer_distortion(t, t->order.item[k]);
        assert_true(distortion[k] >= 0);
        sum += before != NULL ? fabs(distortion[k] - before[k]) : 0;
    }
    return sum;
}

/* Dropout, as it would act on training steps, leaves no anchor out when anchors are judged. */
static void test_dropout(void **state)
{
    ted4_snapshot before = { 0 };
    ted4_trainer t;
    uint64_t closed;

    (void)state;
    train(&t, "motion_worth=0.04", 0, EARLY);
    assert_int_equal(ted4_snapshot_take(&t, &before), 0);
    assert_int_equal(ted4_close_still_anchors(&t), 0);
    closed = t.closing.closed;
    assert_int_equal(ted4_snapshot_restore(&t, &before), 0);
    t.opt.dropout = 0.9;
    assert_true(ted4_dropout_share(&t) > 0.1);
    assert_int_equal(ted4_close_still_anchors(&t), 0);
    assert_int_equal(t.closing.closed, closed);
    ted4_snapshot_free(&before);
    ted4_trainer_finish(&t);
}

/* Sets the outputs from to to - 1 of F_deform's last layer to 0: the first three move positions,
 * the others features (spec 7, 11.3). */
static void stop_outputs(ted4_trainer *t, size_t from, size_t to)
{
    const ted4_net_shape *s = &t->layout.shape.netr[TED4_NET_DEFORM];
    const size_t last = (size_t)s->n_layers - 1, in = s->dim[last], out = s->dim[last + 1];
    float *w = t->net.value + t->layout.netr + s->first;

    for (size_t i = 0; i < last; i++)
        w += ted4_layer_size(s, (unsigned)i);
    memset(w + from * in, 0, (to - from) * in * sizeof *w);
    memset(w + out * in + from, 0, (to - from) * sizeof *w);
}

/* If only features move, sizes and rotations do, and closing anchors that depend on that is as
 * dear. */
static void test_features(void **state)
{
    ted4_trainer t;

    (void)state;
    train(&t, "motion_worth=1e-6", 0, EARLY);
    stop_outputs(&t, 0, 3);
    assert_int_equal(ted4_close_still_anchors(&t), 0);
    assert_true(t.closing.moving > 100);
    assert_true(2 * t.closing.closed < t.closing.moving);
    ted4_trainer_finish(&t);
}

/* If only positions move, a closed anchor shows its Gaussians' means over time. Then the decision
 * agrees with what the closing of one anchor alone does to the pictures, for most anchors that are
 * not near the limit: it is a first-order estimate. */
static void test_harm(void **state)
{
    static memory m;
    static double harm[MOST_ANCHORS], first[FRAMES * BALL_CAMERAS], now[FRAMES * BALL_CAMERAS];
    ted4_trainer t;
    size_t right = 0, wrong = 0, closed = 0;

    (void)state;
    train(&t, "motion_worth=0.006", 0, EARLY);
    stop_outputs(&t, 3, 3 + t.layout.head.feature_dim);
    remember(&t, &m);
    assert_in_range(t.order.n, 1, FRAMES * BALL_CAMERAS);
    compare(&t, NULL, first);
    for (size_t i = 0; i < t.anchors.n; i++) {
        if (!m.dynamic[i])
            continue;
        for (int c = 0; c < 3; c++)
            *position(&t, i, c) = m.middle[i][c];
        *logit(&t, i) = -10.0f;
        harm[i] = compare(&t, first, now) / t.order.n;
        for (int c = 0; c < 3; c++)
            *position(&t, i, c) = m.position[i][c];
        *logit(&t, i) = m.logit[i];
    }

    const double price = 0.006 * t.progress.loss / (double)t.anchors.n;

    assert_int_equal(ted4_close_still_anchors(&t), 0);
    for (size_t i = 0; i < t.anchors.n; i++) {
        const int shut = !ted4_is_dynamic(&t, i);

        if (!m.dynamic[i] || (harm[i] > 0.5 * price && harm[i] < 2 * price))
            continue;
        closed += shut != 0;
        right += shut == (harm[i] < price);
        wrong += shut != (harm[i] < price);
    }
    if (right < 80 || 20 * wrong > right || closed < 30 || closed + 30 > right + wrong)
        fail_msg("%zu right, %zu wrong, %zu closed", right, wrong, closed);
    ted4_trainer_finish(&t);
}

static void put_at(const ted4_trainer *t, size_t i, float x, float y, float z)
{
    *position(t, i, 0) = x;
    *position(t, i, 1) = y;
    *position(t, i, 2) = z;
}

/* Returns an anchor that moves away from the cameras by more than 0.001 in the mean. */
static size_t going_away(const ted4_trainer *t, const memory *m)
{
    size_t i = 0;

    while (i < t->anchors.n && !(m->dynamic[i] && m->middle[i][2] < m->position[i][2] - 1e-3f))
        i++;
    assert_true(i < t->anchors.n);
    return i;
}

/* Any motion is too dear, but an anchor stays open if no picture shows it, or if the middle of its
 * path lies outside the cube. */
static void test_limits(void **state)
{
    static memory m;
    ted4_snapshot before = { 0 };
    ted4_trainer t;
    size_t away, unseen;

    (void)state;
    train(&t, "motion_worth=100", 0, EARLY);
    t.progress.loss = 1e6;
    remember(&t, &m);
    away = going_away(&t, &m);
    unseen = away == 0 ? 1 : 0;
    *logit(&t, unseen) = 1.0f;
    assert_int_equal(ted4_snapshot_take(&t, &before), 0);
    for (int outside = 0; outside < 2; outside++) {
        assert_int_equal(ted4_snapshot_restore(&t, &before), 0);
        put_at(&t, unseen, 0, -0.9f, 0.9f); /* below all views */
        put_at(&t, away, 0, 0, outside ? -0.9999f : -0.9f);
        assert_int_equal(ted4_close_still_anchors(&t), 0);
        assert_true(t.closing.closed + 5 > t.closing.moving);
        assert_true(ted4_is_dynamic(&t, unseen));
        assert_int_equal(ted4_is_dynamic(&t, away), outside);
    }
    ted4_snapshot_free(&before);
    ted4_trainer_finish(&t);
}

/* It happens once, before its step, and a training that goes on from a checkpoint just before or
 * after it ends in the same state. motion_worth=0 switches it off. */
static void test_event(void **state)
{
    ted4_snapshot end = { 0 }, again = { 0 }, start[2] = { { 0 } };
    ted4_trainer t;
    uint64_t closed;

    (void)state;
    train(&t, "motion_worth=0.04", 0, CLOSING);
    assert_int_equal(t.closing.anchors, 0);
    assert_int_equal(ted4_snapshot_take(&t, &start[0]), 0);
    ball_train(&t, CLOSING + 1);
    assert_int_equal(t.closing.anchors, t.anchors.n);
    closed = t.closing.closed;
    assert_true(closed > 0);
    assert_int_equal(ted4_snapshot_take(&t, &start[1]), 0);
    ball_train(&t, CLOSING + 30);
    assert_int_equal(t.closing.closed, closed);
    assert_int_equal(ted4_snapshot_take(&t, &end), 0);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ted4_snapshot_restore(&t, &start[i]), 0);
        assert_int_equal(t.closing.closed, i == 0 ? 0 : closed);
        ball_train(&t, CLOSING + 30);
        assert_int_equal(ted4_snapshot_take(&t, &again), 0);
        assert_int_equal(again.size, end.size);
        assert_memory_equal(again.bytes, end.bytes, end.size);
        ted4_snapshot_free(&again);
        ted4_snapshot_free(&start[i]);
    }
    ted4_snapshot_free(&end);
    ted4_trainer_finish(&t);
    train(&t, "motion_worth=0", 0, CLOSING + 1);
    assert_int_equal(t.closing.anchors, 0);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scene),   cmocka_unit_test(test_spans),
        cmocka_unit_test(test_dropout), cmocka_unit_test(test_features),
        cmocka_unit_test(test_harm),    cmocka_unit_test(test_limits),
        cmocka_unit_test(test_event),
    };

    return cmocka_run_group_tests_name("still anchors", tests, set_up, tear_down);
}
