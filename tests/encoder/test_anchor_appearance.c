/* test_anchor_appearance.c - train/state/anchor_appearance.c: the opacity of an anchor is that of
 * the direction in which it is most opaque, if it depends on the direction, and that of the values
 * as the file will hold them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_group.h"
#include "train/state/anchor_appearance.h"

enum { STEPS = 60, DIRECTIONS = 8 };

typedef struct {
    size_t n;
    float *opacity, *rgb; /* [n], [n][3] */
} appearance;

static appearance look(ted4_trainer *t)
{
    appearance l = { t->anchors.n, malloc(t->anchors.n * sizeof(float)),
                     malloc(3 * t->anchors.n * sizeof(float)) };

    assert_non_null(l.opacity);
    assert_non_null(l.rgb);
    if (ted4_anchor_appearance(t, l.opacity, l.rgb) != 0)
        fail_msg("%s", t->message.text);
    return l;
}

/* The appearance as if item were the only training picture. */
static appearance look_from(ted4_trainer *t, uint32_t item)
{
    const ted4_order whole = t->order;
    appearance l;

    t->order.item = &item;
    t->order.n = 1;
    l = look(t);
    t->order = whole;
    return l;
}

static void forget(appearance *l)
{
    free(l->opacity);
    free(l->rgb);
}

/* Brings every opacity near a half: at 0 or 1, where training may have left most, all directions
 * are alike. */
static void soften_opacity(ted4_trainer *t)
{
    const ted4_net_shape *s = &t->layout.shape.netr[TED4_NET_OPACITY];
    float *w = t->net.value + t->layout.netr + s->first;

    for (int i = 0; i + 1 < s->n_layers; i++)
        w += ((size_t)s->dim[i] + 1) * s->dim[i + 1];
    for (size_t i = 0; i < (size_t)s->dim[s->n_layers - 1] * s->dim[s->n_layers]; i++)
        w[i] *= 0.01f;
    ball_set_biases(t, TED4_NET_OPACITY, t->layout.head.n_offsets, 0.5f);
}

static void begin(ted4_trainer *t, int view)
{
    ted4_train_options o = ball_options();

    o.view = view;
    ball_begin(t, &o, &balls, NULL);
    ball_train(t, STEPS);
    soften_opacity(t);
    assert_true(t->order.n > DIRECTIONS);
}

static double sum_of(const appearance *l)
{
    double sum = 0;

    for (size_t i = 0; i < l->n; i++)
        sum += (double)l->opacity[i];
    return sum;
}

/* Gets the appearance from each direction. Puts first the direction with the least opacity, so that
 * a single evaluation would not suffice. */
static void look_from_all(ted4_trainer *t, appearance one[DIRECTIONS])
{
    uint32_t *const item = t->order.item;
    uint32_t least = 0;

    for (uint32_t k = 0; k < DIRECTIONS; k++) {
        one[k] = look_from(t, item[k * t->order.n / DIRECTIONS]);
        if (sum_of(&one[k]) < sum_of(&one[least]))
            least = k;
    }

    const uint32_t at = least * t->order.n / DIRECTIONS, first = item[0];
    const appearance shows_least = one[least];

    one[least] = one[0];
    one[0] = shows_least;
    item[0] = item[at];
    item[at] = first;
}

static void test_all_directions(void **state)
{
    ted4_trainer t;
    appearance got, one[DIRECTIONS];
    size_t more = 0;

    (void)state;
    begin(&t, TED4_VIEW_FULL);
    look_from_all(&t, one);
    got = look(&t);
    for (size_t i = 0; i < got.n; i++) {
        size_t best = 0;

        for (size_t k = 1; k < DIRECTIONS; k++)
            if (one[k].opacity[i] > one[best].opacity[i])
                best = k;
        assert_true(got.opacity[i] == one[best].opacity[i]);
        assert_memory_equal(got.rgb + 3 * i, one[best].rgb + 3 * i, 3 * sizeof(float));
        more += best != 0;
    }
    assert_true(more > got.n / 4);
    for (size_t k = 0; k < DIRECTIONS; k++)
        forget(&one[k]);
    forget(&got);
    ted4_trainer_finish(&t);
}

/* One direction is enough if opacity does not depend on the direction. */
static void test_one_direction(void **state)
{
    ted4_trainer t;
    appearance got, first;

    (void)state;
    begin(&t, TED4_VIEW_COLOUR);
    got = look(&t);
    first = look_from(&t, t.order.item[0]);
    assert_memory_equal(got.opacity, first.opacity, got.n * sizeof(float));
    assert_memory_equal(got.rgb, first.rgb, 3 * got.n * sizeof(float));
    forget(&got);
    forget(&first);
    ted4_trainer_finish(&t);
}

/* In stage 2 the appearance of an anchor is that in the file: rounding its values first changes
 * nothing. */
static void test_rounded(void **state)
{
    const ted4_train_options o = ball_options();
    const ted4_layout *l;
    ted4_trainer t;
    appearance before, after;
    size_t moved = 0;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, (uint64_t)o.stage1 + 1);
    l = &t.layout;
    before = look(&t);
    for (size_t i = 0; i < t.anchors.n; i++)
        for (int c = 0; c < l->offset_logit; c++) {
            float *const x = ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, c);
            const float q =
                t.visible_blocks.used[i / TED4_LANES][(size_t)c * TED4_LANES + i % TED4_LANES];

            moved += *x != q;
            *x = q;
        }
    after = look(&t);
    assert_true(moved > before.n);
    assert_memory_equal(before.opacity, after.opacity, before.n * sizeof(float));
    assert_memory_equal(before.rgb, after.rgb, 3 * before.n * sizeof(float));
    forget(&before);
    forget(&after);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_directions),
        cmocka_unit_test(test_one_direction),
        cmocka_unit_test(test_rounded),
    };

    return cmocka_run_group_tests_name("anchor_appearance", tests, set_up, tear_down);
}
