/* test_extremes_update.c - Adam, the regularisers of volumes and of the bank, mask losses and
 * learning rates at extreme values: gradients from zero to the largest of binary32, no Gaussian on
 * screen and one, banks at FP16's limits. Compared with double precision; everything stays finite.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>
#include <stdlib.h>

#include "test.h"
#include "cloud_case.h"
#include "train/math/adam.h"
#include "train/state/visible_blocks.h"
#include "train/step/apply_gradients.h"
#include "train/step/loss_terms.h"
#include "train/monitor/saturation.h"
#include "train/step/trainer_init.h"

/* ---- Adam ---- */

typedef struct {
    float x[TED4_LANES], m[TED4_LANES], v[TED4_LANES], g[TED4_LANES];
} row;

static void step(row *r, uint64_t count, float rate)
{
    ted4_adam(r->x, r->m, r->v, r->g, TED4_LANES, rate, ted4_adam_bias_make(count));
    for (int j = 0; j < TED4_LANES; j++)
        if (!(isfinite(r->x[j]) && isfinite(r->m[j]) && isfinite(r->v[j]) && r->v[j] >= 0))
            fail_msg("step %llu of gradient %g: %g, moments %g, %g", (unsigned long long)count,
                     (double)r->g[j], (double)r->x[j], (double)r->m[j], (double)r->v[j]);
}

/* A constant gradient moves a value by the rate times g / (|g| + 1e-15) per step, in double
 * precision. Squares below 1e-38 underflow and those above 1e38 overflow: there the step is
 * smaller, and never has the wrong sign. */
static void test_adam_sizes(void **state)
{
    static const float size[] = { 0,      1e-45f, FLT_MIN, 1e-30f, 1e-22f, 1e-19f,
                                  1e-17f, 1e-15f, 1e-10f,  1,      65504,  1e10f,
                                  1e17f,  1e19f,  1e21f,   1e30f,  FLT_MAX };

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        const double g = (double)size[i];
        row r = { .x = { 0 } };

        for (int j = 0; j < TED4_LANES; j++)
            r.g[j] = j % 2 ? -size[i] : size[i];
        for (uint64_t k = 1; k <= 100; k++) {
            const float before = r.x[0];

            step(&r, k, 0.01f);
            assert_true(r.x[0] <= before);
            assert_true(r.x[1] == -r.x[0]);
        }
        const double want = -1.0 * g / (g + 1e-15);

        if (g < 1e-22 || (g > 1e-18 && g < 1e17)) {
            if (!(fabs((double)r.x[0] - want) <= 1e-3 * fabs(want) + 2e-30))
                fail_msg("gradient %g: %g, not %g", g, (double)r.x[0], want);
        } else {
            assert_true((double)r.x[0] >= want * 1.001 - 1e-30);
        }
    }
}

/* One gradient that is far too large stops the updates of a value for a while, but not for good. */
static void test_adam_recovers(void **state)
{
    static const float outlier[] = { 1e20f, 1e25f, FLT_MAX };

    (void)state;
    for (size_t i = 0; i < sizeof outlier / sizeof *outlier; i++) {
        row r = { .x = { 0 } };

        for (uint64_t k = 1; k <= 120000; k++) {
            for (int j = 0; j < TED4_LANES; j++)
                r.g[j] = k == 10 ? outlier[i] : 1;
            if (k % 1000 == 0 || k < 20)
                step(&r, k, 1e-3f);
            else
                ted4_adam(r.x, r.m, r.v, r.g, TED4_LANES, 1e-3f, ted4_adam_bias_make(k));
        }
        const float at = r.x[0];

        step(&r, 120001, 1e-3f);
        if (!(r.x[0] - at < -0.9e-3f))
            fail_msg("after %g: steps of %g", (double)outlier[i], (double)(r.x[0] - at));
    }
}

/* Bias corrections from the first step to more steps than a training has. */
static void test_bias(void **state)
{
    (void)state;
    for (uint64_t k = 1; k < (uint64_t)1 << 62; k *= 2) {
        const ted4_adam_bias b = ted4_adam_bias_make(k);

        assert_true(b.m >= 1);
        assert_true(b.m <= 10.0001f);
        assert_true(b.v >= 1);
        assert_true(b.v <= 1000.1f);
    }
    assert_true(ted4_decay(1e-3, 0.01, -1e9) == 1e-3);
    assert_true(ted4_decay(0, 0.01, 0.5) == 0);
    assert_true(fabs(ted4_decay(1e-3, 0.01, 1e9) - 1e-5) < 1e-12);
}

/* ---- volume ---- */

enum { SPLATS = 40 };

static cloud_case cloud;

static void begin(ted4_trainer *t, uint32_t frames)
{
    cloud_make(&cloud, frames);
    cloud_begin(&cloud, t);
}

/* Sizes from zero to the largest that the rasteriser still draws, with all, one or no Gaussian on
 * screen: the gradient of a size is weight / n times the product of the others. Gaussians off
 * screen, which may have any size at all, have none. */
static void test_volume(void **state)
{
    static const float size[] = { 0, 1e-45f, FLT_MIN, 0x1p-24f, 1, 65504, 1e9f, 1e12f, FLT_MAX };
    static float scale[3][SPLATS], d[3][SPLATS], centre[3][SPLATS];
    static uint8_t seen[SPLATS];
    ted4_splats s = { .n = SPLATS, .scale = { scale[0], scale[1], scale[2] } };
    ted4_trainer t;

    (void)state;
    begin(&t, 1);
    t.opt.volume_weight = 0.5;
    for (int j = 0; j < 3; j++) {
        t.work.splat_gradient.scale[j] = d[j];
        t.work.splat_gradient.mean[j] = centre[j];
    }
    t.work.splat_gradient.visible = seen;
    for (size_t k = 0; k < sizeof size / sizeof *size; k++)
        for (int who = 0; who < 3; who++) {
            const int n = who == 0 ? 0 : who == 1 ? 1 : SPLATS;
            const double a = (double)size[k], want = n > 0 ? 0.5 / n * a * 0.25 : 0;

            if (who == 2 && size[k] > 1e30f)
                continue;
            for (int i = 0; i < SPLATS; i++) {
                seen[i] = i < n;
                scale[0][i] = i < n && size[k] > 1e30f ? 1e12f : size[k];
                scale[1][i] = scale[2][i] = i < n ? 0.25f : size[k];
                for (int j = 0; j < 3; j++)
                    d[j][i] = 0;
            }
            assert_int_equal(ted4_update_volume(&t, &s), n);
            for (int i = 0; i < SPLATS; i++) {
                for (int j = 0; j < 3; j++) {
                    assert_true(isfinite(d[j][i]));
                    assert_true((seen[i] || d[j][i] == 0));
                }
                if (seen[i] && size[k] < 1e30f) {
                    assert_true(fabs((double)d[1][i] - want) <= 1e-6 * want + 1e-45);
                    assert_true(d[1][i] == d[2][i]);
                    assert_true(fabs((double)d[0][i] - 0.5 / n * 0.0625) <= 1e-8);
                }
            }
        }
    ted4_trainer_finish(&t);
}

/* ---- bank ---- */

/* Rows from all 0 to alternating FP16 limits and beyond: the gradient is 2 weight / count times the
 * second difference of the second differences. */
static void test_bank(void **state)
{
    static const float size[] = { 0, 1e-45f, 0x1p-24f, 1, 65504, 1e18f, 1e30f };
    ted4_trainer t;

    (void)state;
    begin(&t, 9);
    const size_t rows = t.layout.head.bank_rows, width = t.layout.head.bank_dim;
    float *const z = t.net.value + t.layout.bank, *const d = t.net.gradient + t.layout.bank;

    t.opt.tv_weight = 2;
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        const double w = 2.0 * 2.0 / ((double)(rows - 2) * (double)width);

        for (size_t i = 0; i < rows * width; i++) {
            z[i] = i / width % 2 ? -size[k] : size[k];
            d[i] = 0;
        }
        ted4_update_bank(&t);
        for (size_t i = 0; i < rows; i++)
            for (size_t c = 0; c < width; c++) {
                double want = 0;

                for (size_t at = i >= 2 ? i - 2 : 0; at <= i && at + 2 < rows; at++) {
                    const double e = 4 * (at % 2 ? -(double)size[k] : (double)size[k]);

                    want += (i - at == 1 ? -2 : 1) * w * e;
                }
                assert_true(isfinite(d[i * width + c]));
                assert_true(fabs((double)d[i * width + c] - want) <= 1e-5 * fabs(want) + 1e-44);
            }
    }
    ted4_trainer_finish(&t);
}

/* ---- masks ---- */

/* Logits from one end of their range to the other: the gradient is the slope of the sigmoid, 0 at
 * both ends, and a step of Adam leaves everything finite. */
static void test_masks(void **state)
{
    static const float logit[] = {
        -FLT_MAX, -65504, -100, -88, -20, 0, 20, 88, 100, 65504, FLT_MAX
    };
    ted4_trainer t;

    (void)state;
    begin(&t, 5);
    const size_t floats = (size_t)t.layout.n_channels * TED4_LANES;
    const double n = (double)t.anchors.n;

    t.opt.temporal_weight = 0.7;
    for (size_t k = 0; k < sizeof logit / sizeof *logit; k++) {
        const double x = (double)logit[k],
                     want = 0.7 / n * (fabs(x) > 700 ? 0 : 1 / (2 + exp(x) + exp(-x)));

        for (size_t i = 0; i < t.anchors.n; i++)
            *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.temporal_logit) = logit[k];
        assert_int_equal(ted4_visible_blocks_fill(&t, NULL), 0);
        memset(t.visible_blocks.gradients, 0, t.visible_blocks.n * floats * sizeof(float));
        ted4_update_parameters(&t, 1);
        for (size_t b = 0; b < t.visible_blocks.n; b++)
            for (size_t j = 0; j < TED4_LANES; j++) {
                const double got =
                    (double)t.visible_blocks
                        .gradient[b][(size_t)t.layout.temporal_logit * TED4_LANES + j];

                if (t.visible_blocks.lanes[b] >> j & 1 && !(fabs(got - want) <= 1e-5 * want + 1e-9))
                    fail_msg("logit %g: gradient %g, not %g", x, got, want);
            }
        assert_int_equal(ted4_trainer_check(&t, 1), 0);
    }
    ted4_trainer_finish(&t);
}

/* ---- saturated values ---- */

/* First no saturated value; then one value at a time at, and just inside, each end. */
static void test_saturated(void **state)
{
    static const struct {
        int type, component;
        float held, free, step;
    } at[] = {
        { TED4_SCALING, 0, 126.5f, 126, 0 },     { TED4_SCALING, 5, -200, -126, 0 },
        { TED4_TAU, 1, -12, -11.99f, 0 },        { TED4_TAU, 3, -FLT_MAX, 5, 0 },
        { TED4_TAU, 2, 65504, 2, 0.01f },        { TED4_FEATURE, 3, -32768, -32767, 1 },
        { TED4_OFFSET, 8, FLT_MAX, 655, 0.02f }, { TED4_PHI, 0, -65504, 1.5f, 0x1p-14f },
    };
    ted4_trainer t;

    (void)state;
    begin(&t, 5);
    const size_t last = t.anchors.n - 1;

    assert_int_equal(ted4_saturated_values(&t), 0);
    for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
        float *x = ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, last,
                                     t.layout.first[at[k].type] + at[k].component);
        float *q = ted4_anchor_value(&t.anchors, TED4_ROW_STEP, last, at[k].type);
        const float before = *x;

        *q = at[k].step;
        *x = at[k].held;
        assert_int_equal(ted4_saturated_values(&t), 1);
        *x = at[k].free;
        assert_int_equal(ted4_saturated_values(&t), 0);
        *x = before;
        *q = 0;
    }
    t.layout.head.scale_domain = TED4_SCALE_LINEAR;
    for (size_t i = 0; i < t.anchors.n; i++)
        for (int c = 0; c < 6; c++)
            *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.first[TED4_SCALING] + c) =
                i < 3 && c == 1 ? 0x1p-20f : 0x1p-19f;
    assert_int_equal(ted4_saturated_values(&t), 3);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_adam_sizes), cmocka_unit_test(test_adam_recovers),
        cmocka_unit_test(test_bias),       cmocka_unit_test(test_volume),
        cmocka_unit_test(test_bank),       cmocka_unit_test(test_masks),
        cmocka_unit_test(test_saturated),
    };

    return cmocka_run_group_tests_name("updates at their extremes", tests, NULL, NULL);
}
