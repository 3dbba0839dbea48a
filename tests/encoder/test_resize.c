/* test_resize.c - train/resize/resize.c and the candidates made with it: a model that loses only
 * what it does not use renders the same pictures, and one that loses nothing is unchanged.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "ball_trainer.h"
#include "larger.h"
#include "train/search/candidates.h"
#include "train/search/file_cost.h"
#include "train/state/picture.h"
#include "train/monitor/checkpoint.h"
#include "train/resize/feature_pca.h"
#include "train/resize/resize.h"

enum {
    STAGE1 = 400,
    STEPS = 440,
    FRAMES = 5,
    PIXELS = 3 * BALL_W * BALL_H,
    SHOTS = 6,
    F = 8,
    K = 4
};

static tiny_folder folder;
static ted4_dataset scene;
static ted4_snapshot begun; /* a few steps into stage 2 */
static float shot[SHOTS][PIXELS];

static int set_up(void **state)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;

    (void)state;
    ball_load(&folder, &scene, FRAMES, 1);
    ball_set(&o, "capacity=1");
    ball_set(&o, "capacity_share=0");
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, STEPS);
    assert_int_equal(ted4_snapshot_take(&t, &begun), 0);
    ted4_trainer_finish(&t);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_snapshot_free(&begun);
    ted4_dataset_free(&scene);
    tiny_free(&folder);
    return 0;
}

static void go_there(ted4_trainer *t)
{
    ted4_train_options o = ball_options();

    ball_set(&o, "capacity=1");
    ball_set(&o, "capacity_share=0");
    ball_begin(t, &o, &scene, NULL);
    if (ted4_snapshot_restore(t, &begun) != 0)
        fail_msg("%s", t->message.text);
}

/* Renders pictures at all times. Returns the largest difference from those of the last call with
 * keep = 1. */
static double look(ted4_trainer *t, int keep)
{
    double most = 0;

    for (size_t i = 0; i < SHOTS; i++) {
        ted4_view v;
        float centre[3];

        if (ted4_trainer_draw(t, &scene.pictures[i * scene.n_pictures / SHOTS], &v, centre) != 0)
            fail_msg("%s", t->message.text);
        for (size_t k = 0; k < PIXELS; k++)
            if (keep)
                shot[i][k] = t->work.image[k];
            else
                most = larger(most, fabs((double)(t->work.image[k] - shot[i][k])));
    }
    return most;
}

static float *weight(ted4_trainer *t, int net, int layer, size_t *in, size_t *out)
{
    const ted4_net_shape *s = &t->layout.shape.netr[net];
    float *w = t->net.value + t->layout.netr + s->first;

    for (int i = 0; i < layer; i++)
        w += ((size_t)s->dim[i] + 1) * s->dim[i + 1];
    *in = s->dim[layer];
    *out = s->dim[layer + 1];
    return w;
}

static ted4_cost cost(ted4_trainer *t)
{
    ted4_cost c;

    if (ted4_file_cost(t, &c) != 0)
        fail_msg("%s", t->message.text);
    return c;
}

static void make(ted4_trainer *t, ted4_candidate m, int to)
{
    if (ted4_candidate_make(t, m, to) != 0)
        fail_msg("%s", t->message.text);
    assert_int_equal(ted4_candidate_now(t, m), to);
}

/* Asserts that pictures are the same up to tolerance, and that the file is smaller: nearly the same
 * contents in as many bits or fewer. */
static void expect_same(ted4_trainer *t, const ted4_cost *before, double tolerance)
{
    const double away = look(t, 0);
    const ted4_cost after = cost(t);

    if (!(away <= tolerance))
        fail_msg("a picture changed by %g", away);
    if (!(after.bytes < before->bytes))
        fail_msg("%.0f bytes after %.0f", after.bytes, before->bytes);
    ball_train(t, STEPS + 5); /* the trainer must still work */
}

/* Asserts the same for one candidate, applied to the trainer's present state. */
static void expect_free(ted4_trainer *t, ted4_candidate m, int to, double tolerance)
{
    look(t, 1);

    const ted4_cost before = cost(t);

    make(t, m, to);
    expect_same(t, &before, tolerance);
}

static void test_nothing(void **state)
{
    ted4_trainer t, twin;
    ted4_resize s;
    ball_file a, b;

    (void)state;
    go_there(&t);
    go_there(&twin);
    ted4_resize_begin(&s, &t);
    assert_int_equal(ted4_resize_apply(&t, &s), 0);
    for (size_t i = 0; i < t.layout.n_net; i++) { /* a zero may lose its sign */
        assert_true(t.net.value[i] == twin.net.value[i]);
        assert_true(t.net.m[i] == twin.net.m[i]);
        assert_true(t.net.v[i] == twin.net.v[i]);
    }
    a = ball_finish(&t);
    b = ball_finish(&twin);
    ball_check_same(&a, &b);
    free(a.bytes);
    free(b.bytes);
    ted4_trainer_finish(&t);
    ted4_trainer_finish(&twin);
}

static void test_offset(void **state)
{
    ted4_trainer t;

    (void)state;
    go_there(&t);
    ball_set_biases(&t, TED4_NET_OPACITY, K, 1.0f); /* so that all other offsets show something */
    for (size_t i = 0; i < t.anchors.n; i++)
        *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.offset_logit + 1) = -10;
    expect_free(&t, TED4_CANDIDATE_OFFSETS, K - 1, 0.0);
    ted4_trainer_finish(&t);
}

/* Two features are zero and no network writes to them; the second slice of features loses both, the
 * first none. */
static void test_feature(void **state)
{
    ted4_trainer t;
    size_t in, out;

    (void)state;
    go_there(&t);

    float *last =
        weight(&t, TED4_NET_DEFORM, t.layout.shape.netr[TED4_NET_DEFORM].n_layers - 1, &in, &out);

    for (size_t c = F - 2; c < F; c++) {
        for (size_t i = 0; i < t.anchors.n; i++)
            *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i,
                               t.layout.first[TED4_FEATURE] + (int)c) = 0;
        for (size_t i = 0; i < in; i++)
            last[(3 + c) * in + i] = 0;
        last[in * out + 3 + c] = 0;
    }
    look(&t, 1);

    const ted4_cost before = cost(&t);

    assert_int_equal(t.layout.head.n_slices, 2);
    assert_true(t.layout.head.slice[1] > 2);
    make(&t, TED4_CANDIDATE_FEATURE, F - 2);
    assert_int_equal(t.layout.head.n_slices, 2);
    assert_int_equal(t.layout.head.slice[0] + t.layout.head.slice[1], F - 2);
    expect_same(&t, &before, 1e-5);
    ted4_trainer_finish(&t);
}

/* Hidden units whose output is always zero. */
static void test_heads(void **state)
{
    ted4_trainer t;
    size_t in, out;

    (void)state;
    go_there(&t);
    for (int net = TED4_NET_OPACITY; net <= TED4_NET_COLOUR; net++) {
        float *w = weight(&t, net, 0, &in, &out);

        for (size_t o = 0; o < out; o += 3) {
            for (size_t i = 0; i < in; i++)
                w[o * in + i] = 0;
            w[in * out + o] = -1;
        }
    }
    look(&t, 1);

    const ted4_cost before = cost(&t);

    make(&t, TED4_CANDIDATE_HEADS, 8);
    expect_same(&t, &before, 1e-4); /* what remains is estimated anew, by moments with a ridge */
    ted4_trainer_finish(&t);
}

/* If one of two features is always twice the other, one unit for both suffices: least squares
 * detect this, although both are read. */
static void test_double(void **state)
{
    ted4_trainer t;
    size_t in, out;

    (void)state;
    go_there(&t);
    for (int net = TED4_NET_OPACITY; net <= TED4_NET_COLOUR; net++) {
        float *w = weight(&t, net, 0, &in, &out);

        for (size_t i = 0; i < in; i++)
            for (size_t o = 8; o < 12; o++)
                w[o * in + i] = 2 * w[(o - 8) * in + i];
        for (size_t o = 8; o < 12; o++)
            w[in * out + o] = 2 * w[in * out + o - 8];
    }
    expect_free(&t, TED4_CANDIDATE_HEADS, 8, 1e-3);
    ted4_trainer_finish(&t);
}

static void test_view(void **state)
{
    ted4_trainer t;
    size_t in, out;

    (void)state;
    go_there(&t);

    float *w = weight(&t, TED4_NET_COLOUR, 0, &in, &out);

    assert_int_equal(in, F + 3);
    for (size_t o = 0; o < out; o++)
        for (size_t i = F; i < F + 3; i++)
            w[o * in + i] = 0;
    expect_free(&t, TED4_CANDIDATE_VIEW, TED4_VIEW_NONE, 1e-6);
    ted4_trainer_finish(&t);
}

/* Three collinear rows of the bank become two. */
static void test_rows(void **state)
{
    ted4_trainer t;

    (void)state;
    go_there(&t);

    const size_t D = t.layout.head.bank_dim;
    float *z = t.net.value + t.layout.bank;

    assert_int_equal(t.layout.head.bank_rows, 3);
    for (size_t c = 0; c < D; c++)
        z[D + c] = 0.5f * (z[c] + z[2 * D + c]);
    look(&t, 1);

    const ted4_cost before = cost(&t);
    ted4_resize s;

    ted4_resize_begin(&s, &t);
    s.head.bank_rows = 2;
    assert_int_equal(ted4_resize_apply(&t, &s), 0);
    expect_same(&t, &before, 1e-5);
    ted4_trainer_finish(&t);
}

static void test_activation(void **state)
{
    static const float always[4] = { 0, 0, 1, 0 };
    ted4_trainer t;

    (void)state;
    go_there(&t);
    for (size_t i = 0; i < t.anchors.n; i++)
        for (int c = 0; c < 4; c++)
            *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.first[TED4_TAU] + c) =
                always[c];
    expect_free(&t, TED4_CANDIDATE_ACTIVATION, 0, 0.0);
    ted4_trainer_finish(&t);
}

/* An F_deform whose output is always zero. */
static void test_motion(void **state)
{
    ted4_trainer t;
    size_t in, out;

    (void)state;
    go_there(&t);

    float *last =
        weight(&t, TED4_NET_DEFORM, t.layout.shape.netr[TED4_NET_DEFORM].n_layers - 1, &in, &out);

    for (size_t i = 0; i < (in + 1) * out; i++)
        last[i] = 0;
    look(&t, 1);

    const ted4_cost before = cost(&t);

    make(&t, TED4_CANDIDATE_MOTION, 0);
    assert_int_equal(t.layout.shape.n_bank, 0);
    expect_same(&t, &before, 0.0);
    ted4_trainer_finish(&t);
}

/* The feature's axes are rotated, the pictures are the same; the first components vary most. */
static void test_rotation(void **state)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;
    double spread[F] = { 0 };

    (void)state;
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, STAGE1);
    look(&t, 1);

    const float was =
        *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 7, t.layout.first[TED4_FEATURE]);

    assert_int_equal(ted4_feature_pca(&t), 0);
    assert_true(
        fabsf(*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 7, t.layout.first[TED4_FEATURE]) -
              was) > 1e-3f);
    if (!(look(&t, 0) <= 1e-3))
        fail_msg("a picture changed by %g", look(&t, 0));
    for (int c = 0; c < F; c++) {
        double sum = 0, square = 0;

        for (size_t i = 0; i < t.anchors.n; i++) {
            const double x = (double)*ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i,
                                                        t.layout.first[TED4_FEATURE] + c);

            sum += x;
            square += x * x;
        }
        spread[c] = square / (double)t.anchors.n - sum * sum / (double)(t.anchors.n * t.anchors.n);
    }
    assert_true(spread[0] > 2 * spread[F / 2]);
    assert_true(spread[F / 2] > 2 * spread[F - 1]);
    ted4_trainer_finish(&t);
}

/* Small candidates that cannot be exact cost little: without training, the cost stays within a
 * given factor of the previous cost. */
static void test_little(void **state)
{
    static const struct {
        ted4_candidate m;
        int to;
    } all[] = {
        { TED4_CANDIDATE_HYPER, 6 },   { TED4_CANDIDATE_AR, 6 },    { TED4_CANDIDATE_DEFORM, 6 },
        { TED4_CANDIDATE_BANK, 6 },    { TED4_CANDIDATE_PHI, 3 },   { TED4_CANDIDATE_SLICES, 1 },
        { TED4_CANDIDATE_OCTAVES, 3 }, { TED4_CANDIDATE_SCALE, 0 },
    };

    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        ted4_trainer t;

        go_there(&t);

        const ted4_cost before = cost(&t);

        make(&t, all[i].m, all[i].to);

        const ted4_cost after = cost(&t);

        if (!(after.distortion < 1.25 * before.distortion && after.bytes < 1.05 * before.bytes))
            fail_msg("%s: distortion %g to %g, bytes %g to %g", ted4_candidate_name(all[i].m),
                     before.distortion, after.distortion, before.bytes, after.bytes);
        ball_train(&t, STEPS + 3);
        ted4_trainer_finish(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing), cmocka_unit_test(test_offset),
        cmocka_unit_test(test_feature), cmocka_unit_test(test_heads),
        cmocka_unit_test(test_double),  cmocka_unit_test(test_view),
        cmocka_unit_test(test_rows),    cmocka_unit_test(test_activation),
        cmocka_unit_test(test_motion),  cmocka_unit_test(test_rotation),
        cmocka_unit_test(test_little),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
