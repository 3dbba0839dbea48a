/* test_shut.c - masks of motion that are shut (train/model/model.h): the generator leaves out
 * F_deform for blocks that have no others, with the same Gaussians and gradients.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "ball_group.h"
#include "larger.h"
#include "train/splat/generator.h"
#include "train/state/visible_blocks.h"

enum { STEPS = 60, BLOCKS = 128 };
#define SHUT   (TED4_MASK_SHUT - 1.0f)
#define CLOSED (TED4_MASK_SHUT + 1.0f) /* but not shut */

/* Copies of what the generator returns, all owned: opacities and first coordinates of means; the
 * gradients of values, and of F_deform. */
typedef struct {
    size_t n_deform;
    float *opacity, *mean, *value, *deform;
} result;

static float *copy(const float *from, size_t n)
{
    float *to = malloc(n * sizeof *to);

    assert_non_null(to);
    return memcpy(to, from, n * sizeof *to);
}

static void set_logit(ted4_trainer *t, size_t i, float logit)
{
    *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.temporal_logit) = logit;
}

/* Lists all blocks over and over, so that each part of the generator's work has several. */
static void list_blocks(ted4_trainer *t, ted4_generate_input *in, float **gradient)
{
    static const float *attr[BLOCKS], *position[BLOCKS];
    static uint32_t lanes[BLOCKS];
    const ted4_visible_blocks *s = &t->visible_blocks;

    assert_int_equal(ted4_visible_blocks_fill(t, NULL), 0);
    for (size_t i = 0; i < BLOCKS; i++) {
        attr[i] = s->raw[i % s->n];
        position[i] = s->position[i % s->n];
        lanes[i] = s->lanes[i % s->n];
        gradient[i] = s->gradient[i % s->n];
    }
    in->n_visible = BLOCKS;
    in->attr = attr;
    in->position = position;
    in->lanes = lanes;
}

/* All Gaussians at a time between two frames, and the gradients of the sum of all their numbers
 * but colours. */
static result run(ted4_trainer *t)
{
    ted4_generate_input in = { .layout = &t->layout,
                               .net = t->net.value,
                               .num = 3,
                               .den = 2 * (FRAMES - 1),
                               .camera = { 0, 0, 4 },
                               .activation = 1 };
    const ted4_net_shape *deform = &t->layout.shape.netr[TED4_NET_DEFORM];
    float *gradient[BLOCKS];
    ted4_splats s;
    ted4_splat_grads g;
    result r;

    list_blocks(t, &in, gradient);
    ted4_generator_pack(t->work.generator, t->net.value);
    assert_int_equal(ted4_generate(t->work.generator, &in, NULL, &s), 0);

    float *zero = calloc(s.n, sizeof *zero), *one = malloc(s.n * sizeof *one);

    assert_non_null(zero);
    assert_non_null(one);
    for (size_t i = 0; i < s.n; i++)
        one[i] = 1.0f;
    for (int j = 0; j < 3; j++) {
        g.mean[j] = g.scale[j] = one;
        g.colour[j] = zero;
    }
    for (int j = 0; j < 4; j++)
        g.rot[j] = one;
    g.opacity = one;
    g.mean2d = zero;
    g.visible = NULL;
    memset(t->net.gradient, 0, t->layout.n_net * sizeof *t->net.gradient);
    assert_int_equal(
        ted4_generate_backward(t->work.generator, &in, &g, NULL, gradient, t->net.gradient), 0);
    r.n_deform = ted4_layer_size(deform, 0);
    r.opacity = copy(s.opacity, s.n);
    r.mean = copy(s.mean[0], s.n);
    r.value = copy(t->visible_blocks.gradients,
                   t->visible_blocks.n * (size_t)t->layout.n_channels * TED4_LANES);
    r.deform = copy(t->net.gradient + t->layout.netr + deform->first, r.n_deform);
    free(zero);
    free(one);
    return r;
}

/* The first anchor of each block has one logit, the others another one. */
static result run_lanes(ted4_trainer *t, float first, float others)
{
    for (size_t i = 0; i < t->anchors.n; i++)
        set_logit(t, i, i % TED4_LANES == 0 ? first : others);
    return run(t);
}

/* In every second block from this one on, all move; the others are shut. */
static result run_blocks(ted4_trainer *t, size_t block)
{
    for (size_t i = 0; i < t->anchors.n; i++)
        set_logit(t, i, i / TED4_LANES % 2 == block ? 1.0f : SHUT);
    return run(t);
}

static void forget(result *r)
{
    free(r->opacity);
    free(r->mean);
    free(r->value);
    free(r->deform);
}

static size_t count_other_than_zero(const float *x, size_t n)
{
    size_t count = 0;

    for (size_t i = 0; i < n; i++)
        count += x[i] != 0;
    return count;
}

/* Returns how many numbers differ of the first anchor of each block of rows rows; those of all
 * other anchors are the same. */
static size_t differences(const ted4_trainer *t, const float *a, const float *b, size_t rows)
{
    size_t count = 0;

    for (size_t i = 0; i < t->anchors.n; i++)
        for (size_t r = 0; r < rows; r++) {
            const size_t at = (i / TED4_LANES * rows + r) * TED4_LANES + i % TED4_LANES;

            if (i % TED4_LANES != 0)
                assert_true(a[at] == b[at]);
            count += a[at] != b[at];
        }
    return count;
}

static void test_left_out(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STEPS);

    result all = run_lanes(&t, SHUT, SHUT), but_one = run_lanes(&t, 1.0f, SHUT);

    assert_int_equal(count_other_than_zero(all.deform, all.n_deform), 0);
    assert_true(count_other_than_zero(but_one.deform, all.n_deform) > 0);
    assert_true(differences(&t, all.opacity, but_one.opacity, t.layout.head.n_offsets) == 0);
    assert_true(differences(&t, all.mean, but_one.mean, t.layout.head.n_offsets) > 0);
    assert_true(differences(&t, all.value, but_one.value, (size_t)t.layout.n_channels) > 0);
    forget(&all);
    forget(&but_one);
    ted4_trainer_finish(&t);
}

/* Blocks that are shut lie between others: the gradients of weights are those of the others. */
static void test_between(void **state)
{
    const ted4_train_options o = ball_options();
    double largest = 0;
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STEPS);
    assert_true(t.anchors.n_blocks % 2 == 0);

    result all = run_lanes(&t, 1.0f, 1.0f), even = run_blocks(&t, 0), odd = run_blocks(&t, 1);

    for (size_t i = 0; i < all.n_deform; i++)
        largest = larger(largest, fabsf(all.deform[i]));
    assert_true(largest > 0);
    for (size_t i = 0; i < all.n_deform; i++)
        assert_true(fabsf(even.deform[i] + odd.deform[i] - all.deform[i]) < 1e-5 * largest);
    forget(&all);
    forget(&even);
    forget(&odd);
    ted4_trainer_finish(&t);
}

/* The mask of motion has a gradient as long as it is not shut. */
static void test_gradient(void **state)
{
    static const float logits[] = { 1.0f, CLOSED, SHUT };
    const ted4_train_options o = ball_options();
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STEPS);
    for (int k = 0; k < 3; k++) {
        result r = run_lanes(&t, logits[k], logits[k]);
        const float *d = r.value + (size_t)t.layout.temporal_logit * TED4_LANES;

        assert_int_equal(count_other_than_zero(d, TED4_LANES), logits[k] == SHUT ? 0 : TED4_LANES);
        forget(&r);
    }
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_left_out),
        cmocka_unit_test(test_between),
        cmocka_unit_test(test_gradient),
    };

    return cmocka_run_group_tests_name("shut", tests, set_up, tear_down);
}
