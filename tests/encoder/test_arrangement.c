/* test_arrangement.c - train/state/arrangement.c and the sleep of train/state/visible_blocks.c:
 * what is left out of a step would have changed nothing in the picture, and is still updated.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "ball_group.h"
#include "anchor_checks.h"
#include "recon/strict.h"
#include "train/model/formulas.h"
#include "train/state/arrangement.h"
#include "train/state/picture.h"
#include "train/state/visible_blocks.h"

enum { STEPS = 100 };

static float *value(const ted4_trainer *t, size_t i, int channel)
{
    return ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, channel);
}

/* Sets the life of anchor i to one frame. edge: log2 of how long it comes and goes, in sequences.
 */
static void live_at(ted4_trainer *t, size_t i, uint32_t frame, float edge)
{
    const int tau = t->layout.first[TED4_TAU];
    const float now = (float)frame / (FRAMES - 1);

    *value(t, i, tau) = now - 0.01f;
    *value(t, i, tau + 2) = now + 0.01f;
    *value(t, i, tau + 1) = *value(t, i, tau + 3) = edge;
}

/* Of six anchors, each lives at one frame, in turn, but the last one lives always. */
static void live(ted4_trainer *t, float edge)
{
    for (size_t i = 0; i < t->anchors.n; i++)
        if (i % 6 != 5)
            live_at(t, i, (uint32_t)(i % 6 % FRAMES), edge);
}

static void begin(ted4_trainer *t, uint64_t steps)
{
    const ted4_train_options o = ball_options();

    ball_begin(t, &o, &balls, NULL);
    ball_train(t, steps);
    live(t, -6.0f);
}

/* Whether anchor i can be drawn at a frame (spec 11.4). */
static int lives(const ted4_trainer *t, size_t i, uint32_t frame)
{
    const float now = (float)frame / (FRAMES - 1);
    const float *tau = value(t, i, t->layout.first[TED4_TAU]);

    return ted4_activation(ted4_find_edge(now, tau, ted4_pow2).u, ted4_pow2) >= 1.0f / 255.0f;
}

/* The mean over the pictures of the share of visible blocks that are awake. */
static double share_awake(ted4_trainer *t)
{
    double sum = 0;

    for (uint32_t k = 0; k < t->order.n; k++) {
        ted4_generate_input in;
        ted4_splats s;
        ted4_view v;

        assert_int_equal(ted4_trainer_render(t, &t->data->pictures[t->order.item[k]],
                                             TED4_PASS_IMAGE, &v, &in, &s),
                         0);
        sum += (double)t->visible_blocks.awake / (double)t->visible_blocks.n / t->order.n;
    }
    return sum;
}

/* Anchors that live at one time are together, so that most blocks sleep; Morton order mixes them.
 * Every anchor keeps its values, and so the order can be undone. */
static void test_order(void **state)
{
    ted4_trainer t;
    size_t bytes;

    (void)state;
    begin(&t, STEPS);
    assert_int_equal(ted4_anchors_sort(&t.anchors, NULL), 0);
    bytes = t.anchors.n_blocks * (size_t)t.layout.n_channels * TED4_LANES * sizeof(float);

    float *before = malloc(bytes);

    assert_non_null(before);
    memcpy(before, t.anchors.data[TED4_ROW_M], bytes);
    assert_true(share_awake(&t) > 0.999);
    assert_int_equal(ted4_arrange_anchors(&t), 0);
    anchors_check(&t.anchors);
    assert_true(share_awake(&t) < 0.8);
    assert_memory_not_equal(before, t.anchors.data[TED4_ROW_M], bytes);
    assert_int_equal(ted4_anchors_sort(&t.anchors, NULL), 0);
    assert_memory_equal(before, t.anchors.data[TED4_ROW_M], bytes);
    free(before);
    ted4_trainer_finish(&t);
}

/* Anchors whose motion is over come last. */
static void test_shut_last(void **state)
{
    ted4_trainer t;

    (void)state;
    begin(&t, 1);
    for (size_t i = 0; i < t.anchors.n; i++)
        *value(&t, i, t.layout.temporal_logit) = i % 3 == 0 ? TED4_MASK_SHUT - 1.0f : 0.0f;
    assert_int_equal(ted4_arrange_anchors(&t), 0);
    for (size_t i = 1; i < t.anchors.n; i++)
        assert_true(*value(&t, i - 1, t.layout.temporal_logit) >=
                    *value(&t, i, t.layout.temporal_logit));
    ted4_trainer_finish(&t);
}

/* The blocks that are awake are those with a visible anchor that lives, in order; the others
 * follow, and nothing visible is missing. Returns the number of the others. */
static size_t check_awake(ted4_trainer *t, const ted4_picture *pic)
{
    const ted4_visible_blocks *s = &t->visible_blocks;
    uint32_t *lanes = calloc(t->anchors.n_blocks, sizeof *lanes);
    ted4_generate_input in;
    ted4_splats g;
    ted4_view v;

    assert_non_null(lanes);
    assert_int_equal(ted4_trainer_render(t, pic, TED4_PASS_IMAGE, &v, &in, &g), 0);
    assert_int_equal(in.n_visible, s->awake);
    for (size_t i = 0; i < s->n; i++) {
        int living = 0;

        for (size_t j = 0; j < TED4_LANES; j++)
            living |= (s->lanes[i] >> j & 1) &&
                      lives(t, s->block[i] * (size_t)TED4_LANES + j, pic->frame);
        assert_int_equal(living, i < s->awake);
        assert_true(i == 0 || i >= s->awake || s->block[i - 1] < s->block[i]);
        assert_ptr_equal(s->raw[i], ted4_block(&t->anchors, TED4_ROW_VALUE, s->block[i]));
        assert_ptr_equal(s->used[i], s->raw[i]);
        assert_ptr_equal(s->position[i], ted4_block(&t->anchors, TED4_ROW_POSITION, s->block[i]));
        assert_ptr_equal(s->steps[i], ted4_block(&t->anchors, TED4_ROW_STEP, s->block[i]));
        lanes[s->block[i]] |= s->lanes[i];
    }
    for (size_t b = 0; b < t->anchors.n_blocks; b++)
        assert_int_equal(lanes[b], ted4_block_visible(t, b, &v));
    free(lanes);
    return s->n - s->awake;
}

/* With the longest edge, the activation is 0.1 at the next frame, and 1e-4 at the one behind it;
 * the two before it give 0.0042 and 0.0037 at the next frame, above 1/255 and below. */
static void test_awake(void **state)
{
    static const float edge[] = { -6.0f, -3.3015f, -3.285f, -2.66f };
    ted4_trainer t;

    (void)state;
    begin(&t, STEPS);
    for (size_t i = 0; i < sizeof edge / sizeof *edge; i++) {
        size_t asleep = 0;

        live(&t, edge[i]);
        assert_int_equal(ted4_arrange_anchors(&t), 0);
        for (uint32_t k = 0; k < t.order.n; k++)
            asleep += check_awake(&t, &t.data->pictures[t.order.item[k]]);
        assert_true(asleep > 0);
    }
    ted4_trainer_finish(&t);
}

/* A life that is not a number keeps its block awake, where the monitor can see it. */
static void test_not_a_number(void **state)
{
    ted4_trainer t;

    (void)state;
    begin(&t, 1);
    for (size_t i = 0; i < t.anchors.n; i++)
        for (int c = 0; c < 4; c++)
            *value(&t, i, t.layout.first[TED4_TAU] + c) = NAN;
    assert_int_equal(ted4_arrange_anchors(&t), 0);
    assert_true(share_awake(&t) > 0.999);
    ted4_trainer_finish(&t);
}

/* A block that sleeps has no gradient from the picture, but its visits are counted, its masks have
 * their loss, and Adam goes on. */
static void test_asleep(void **state)
{
    ted4_trainer t;
    int looked = 0;

    (void)state;
    begin(&t, STEPS + 1);
    assert_int_equal(ted4_arrange_anchors(&t), 0);
    for (size_t i = 0; i < t.anchors.n; i++)
        for (int r = 0; r < 3; r++)
            *ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, r) = 0.0f;
    assert_int_equal(ted4_trainer_step(&t), 0);

    const ted4_visible_blocks *s = &t.visible_blocks;

    for (size_t b = s->awake; b < s->n; b++)
        for (size_t j = 0; j < TED4_LANES; j++) {
            const size_t i = s->block[b] * (size_t)TED4_LANES + j;

            for (int c = 0; c < t.layout.temporal_logit; c++)
                assert_true(s->gradient[b][(size_t)c * TED4_LANES + j] == 0.0f);
            if (!(s->lanes[b] >> j & 1))
                continue;
            looked++;
            assert_true(s->gradient[b][(size_t)t.layout.temporal_logit * TED4_LANES + j] > 0.0f);
            assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 0) == 0.0f);
            assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 1) == 1.0f);
            assert_true(*ted4_anchor_value(&t.anchors, TED4_ROW_OPACITY, i, 2) == 0.0f);
        }
    assert_true(looked > 0);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_order),  cmocka_unit_test(test_shut_last),
        cmocka_unit_test(test_awake),  cmocka_unit_test(test_not_a_number),
        cmocka_unit_test(test_asleep),
    };

    return cmocka_run_group_tests_name("arrangement", tests, set_up, tear_down);
}
