/* test_export_scene.c - train/step/export_scene.c: what of the trained values stands in the file.
 * All values are set by hand: symbols plus a fraction of a step, masks in a pattern.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "base/bytes.h"
#include "cloud_case.h"
#include "norm/scene.h"
#include "norm/tables.h"
#include "test.h"
#include "train/step/export_scene.h"
#include "train/step/stages.h"

enum { FRAMES = 5, LOGIT_ON = 3, LOGIT_OFF = -10 };

static cloud_case cloud;

static float *value(const ted4_trainer *t, size_t i, int channel)
{
    return ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, channel);
}

/* Begins a trainer in its integer stage. The spans end within the sequence, so that activation is
 * not dropped from the model. */
static void begin(ted4_trainer *t)
{
    static const float span[4] = { 0.3f, -3, 0.7f, -3 };

    cloud_make(&cloud, FRAMES);
    cloud.options.profile = 0; /* Main: anchors are found again by their positions */
    cloud_begin(&cloud, t);
    for (size_t i = 0; i < t->anchors.n; i++)
        for (int c = 0; c < 4; c++)
            *value(t, i, t->layout.first[TED4_TAU] + c) = span[c];
    assert_int_equal(ted4_stage2_begin(t), 0);
    assert_int_equal(ted4_integer_begin(t), 0);
    assert_true(t->anchors.n > 40);
    assert_int_equal(t->layout.head.activation, 1);
    assert_int_equal(t->layout.head.motion, TED4_MOTION_BANK);
}

static ted4_scene *export(ted4_trainer *t)
{
    ted4_scene *s;

    if (ted4_export_scene(t, &s) != 0)
        fail_msg("%s", t->message.text);
    return s;
}

static float step_of(const ted4_scene *s, int type, size_t i)
{
    return s->head.step[type] * ted4_bits_float(ted4_step[s->step_index[type][i]]);
}

/* The symbol of a component. That of the second time of a span is lower than that of the first for
 * every fourth anchor, which no file may contain. */
static int wanted(int type, unsigned c, size_t i)
{
    if (type == TED4_TAU && c % 2 == 0)
        return c == 0 ? 20 : i % 4 == 0 ? 10 : 40;
    return (int)((7 * i + 3 * c + (size_t)type) % 23) - 11;
}

/* Sets all values to symbols plus or minus 0.4 steps. s: the scene of the same anchors, whose steps
 * depend on positions alone. */
static void set_values(const ted4_trainer *t, const ted4_scene *s)
{
    for (int y = 0; y < TED4_TYPES; y++)
        for (unsigned c = 0; c < s->shape.dim[y]; c++)
            for (size_t i = 0; i < t->anchors.n; i++)
                *value(t, i, t->layout.first[y] + (int)c) =
                    ((float)wanted(y, c, i) + (i % 2 ? 0.4f : -0.4f)) * step_of(s, y, i);
}

static int is_kept(size_t i, unsigned k)
{
    return i % 7 != 3 && (i + k) % 3 != 0;
}

static int moves(size_t i)
{
    return i % 5 != 0;
}

/* pattern: masks as is_kept and moves say; otherwise all are on. */
static void set_masks(const ted4_trainer *t, int pattern)
{
    for (size_t i = 0; i < t->anchors.n; i++) {
        for (unsigned k = 0; k < t->layout.head.n_offsets; k++)
            *value(t, i, t->layout.offset_logit + (int)k) = !pattern || is_kept(i, k) ? LOGIT_ON
                                                                                      : LOGIT_OFF;
        *value(t, i, t->layout.temporal_logit) = !pattern || moves(i) ? LOGIT_ON : LOGIT_OFF;
    }
}

/* Checks the symbols of anchor at of the scene, which is anchor i of the trainer. */
static void check_symbols(const ted4_scene *s, size_t at, size_t i, int pattern)
{
    for (int y = 0; y < TED4_TYPES; y++)
        for (unsigned c = 0; c < s->shape.dim[y]; c++) {
            const int coded = !pattern || ((y != TED4_OFFSET || is_kept(i, c / 3)) &&
                                           (y != TED4_PHI || moves(i)));
            const int late = y == TED4_TAU && c == 2 && i % 4 == 0 ? 20 : wanted(y, c, i);

            assert_int_equal(s->symbol[y][c * s->head.n_anchors + at], coded ? late : 0);
        }
}

static void test_symbols(void **state)
{
    (void)state;
    for (int pattern = 0; pattern < 2; pattern++) {
        ted4_trainer t;
        ted4_scene *s;
        size_t n = 0;

        begin(&t);
        t.opt.capacity = 0; /* spans as they are */
        set_masks(&t, 0);
        s = export(&t);
        assert_int_equal(s->head.n_anchors, t.anchors.n);
        set_values(&t, s);
        ted4_scene_free(s);
        set_masks(&t, pattern);
        s = export(&t);
        for (size_t i = 0; i < t.anchors.n; i++)
            if (!pattern || i % 7 != 3) /* an anchor without Gaussians is not coded */
                check_symbols(s, n++, i, pattern);
        assert_int_equal(s->head.n_anchors, n);
        assert_int_equal(s->head.offset_mask, pattern);
        assert_int_equal(s->head.temporal_mask, pattern);
        ted4_scene_free(s);
        ted4_trainer_finish(&t);
    }
}

/* Weights that no file may contain become 0; others stay as they are. */
static void test_weights(void **state)
{
    ted4_trainer t;
    ted4_scene *s;

    (void)state;
    begin(&t);
    t.net.value[t.layout.netr] = 1e-40f;
    t.net.value[t.layout.netr + 1] = 0x1p-126f;
    t.net.value[t.layout.bank] = -1e-39f;
    s = export(&t);
    assert_true(s->netr.values[0] == 0);
    assert_true(s->netr.values[1] == 0x1p-126f);
    assert_true(s->netr.values[2] == t.net.value[t.layout.netr + 2]);
    assert_true(s->bank.values[0] == 0);
    ted4_scene_free(s);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_symbols),
        cmocka_unit_test(test_weights),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
