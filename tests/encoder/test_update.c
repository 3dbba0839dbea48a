/* test_update.c - the terms that train/step/apply_gradients.c adds to the picture's gradients,
 * against central differences of their losses in double precision; Adam against its formula.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "cloud_case.h"
#include "train/math/adam.h"
#include "train/state/visible_blocks.h"
#include "train/step/apply_gradients.h"
#include "train/step/loss_terms.h"
#include "train/step/trainer_init.h"

static cloud_case cloud;

static void begin(ted4_trainer *t, uint32_t frames)
{
    cloud_make(&cloud, frames);
    cloud_begin(&cloud, t);
}

static void expect_near(double got, double want, double scale)
{
    if (!(fabs(got - want) <= 1e-5 * scale))
        fail_msg("gradient %.9g, central difference %.9g", got, want);
}

/* ---- volume ---- */

enum { SPLATS = 40 };

static double volume_loss(double (*scale)[SPLATS], const uint8_t *seen, double weight)
{
    double sum = 0;
    size_t n = 0;

    for (int i = 0; i < SPLATS; i++)
        if (seen[i]) {
            sum += scale[0][i] * scale[1][i] * scale[2][i];
            n++;
        }
    return n > 0 ? weight * sum / (double)n : 0;
}

/* share: tenths of the Gaussians that are on screen; 0: none, and the gradient must not change. */
static void check_volume(ted4_trainer *t, unsigned share)
{
    static float scale[3][SPLATS], d[3][SPLATS], centre[3][SPLATS];
    static double x[3][SPLATS];
    static uint8_t seen[SPLATS];
    ted4_splats s = { .n = SPLATS, .scale = { scale[0], scale[1], scale[2] } };
    size_t n = 0;
    double squares = 0;

    for (int i = 0; i < SPLATS; i++) {
        seen[i] = ted4_below(7, (uint64_t)i, 10) < share;
        n += seen[i];
        for (int j = 0; j < 3; j++) {
            scale[j][i] = 0.01f + ted4_uniform(8 + (uint64_t)j, (uint64_t)i);
            x[j][i] = (double)scale[j][i];
            d[j][i] = 0.25f; /* gradients are added to */
            centre[j][i] = ted4_uniform(11 + (uint64_t)j, (uint64_t)i) - 0.5f;
            squares += (double)centre[j][i] * (double)centre[j][i];
        }
    }
    for (int j = 0; j < 3; j++) {
        t->work.splat_gradient.scale[j] = d[j];
        t->work.splat_gradient.mean[j] = centre[j];
    }
    t->work.splat_gradient.visible = seen;
    assert_int_equal(ted4_update_volume(t, &s), n);
    assert_true(t->monitor.drawn == (double)n);
    assert_true(fabs(t->monitor.norm[TED4_TERM_CENTRE] - sqrt(squares)) < 1e-6 * sqrt(squares));
    for (int i = 0; i < SPLATS; i++)
        for (int j = 0; j < 3; j++) {
            const double h = 1e-4, at = x[j][i];

            x[j][i] = at + h;
            const double up = volume_loss(x, seen, t->opt.volume_weight);

            x[j][i] = at - h;
            const double down = volume_loss(x, seen, t->opt.volume_weight);

            x[j][i] = at;
            expect_near((double)d[j][i] - 0.25, (up - down) / (2 * h), 1);
        }
}

static void test_volume(void **state)
{
    ted4_trainer t;

    (void)state;
    begin(&t, 5);
    t.opt.volume_weight = 3;
    for (unsigned share = 0; share <= 10; share += 5)
        check_volume(&t, share);
    ted4_trainer_finish(&t);
}

/* ---- bank ---- */

static double bank_loss(const double *z, size_t rows, size_t width, double weight)
{
    double sum = 0;

    for (size_t i = 0; i + 2 < rows; i++)
        for (size_t c = 0; c < width; c++) {
            const double e = z[i * width + c] - 2 * z[(i + 1) * width + c] + z[(i + 2) * width + c];

            sum += e * e;
        }
    return rows > 2 ? weight * sum / (double)((rows - 2) * width) : 0;
}

/* 9 frames: five rows; 5: three rows, one difference; 3: two rows, no difference. */
static void test_bank(void **state)
{
    static const uint32_t frames[] = { 9, 5, 3 };

    (void)state;
    for (int k = 0; k < 3; k++) {
        ted4_trainer t;

        begin(&t, frames[k]);
        t.opt.tv_weight = 2;
        const size_t rows = t.layout.head.bank_rows, width = t.layout.head.bank_dim;
        const float *d = t.net.gradient + t.layout.bank;
        double *z = malloc(rows * width * sizeof *z);

        assert_non_null(z);
        assert_int_equal(rows, (frames[k] + 1) / 2);
        for (size_t i = 0; i < rows * width; i++)
            z[i] = (double)t.net.value[t.layout.bank + i];
        ted4_update_bank(&t);
        for (size_t i = 0; i < rows * width; i++) {
            const double h = 1e-4, at = z[i];

            z[i] = at + h;
            const double up = bank_loss(z, rows, width, 2);

            z[i] = at - h;
            const double down = bank_loss(z, rows, width, 2);

            z[i] = at;
            expect_near((double)d[i], (up - down) / (2 * h), 1);
        }
        free(z);
        ted4_trainer_finish(&t);
    }
}

/* ---- masks ---- */

static double sigmoid(double x)
{
    return 1 / (1 + exp(-x));
}

/* Checks the gradients of a logit channel after ted4_update_parameters on zero gradients: weight /
 * n times the slope of the sigmoid, in every used lane. */
static void check_logits(const ted4_trainer *t, const float *before, int channel, double weight)
{
    const double n = (double)t->anchors.n;

    for (size_t b = 0; b < t->visible_blocks.n; b++)
        for (size_t j = 0; j < TED4_LANES; j++) {
            const size_t at = (size_t)channel * TED4_LANES + j;
            const double x = (double)before[b * (size_t)t->layout.n_channels * TED4_LANES + at];
            const double want = t->visible_blocks.lanes[b] >> j & 1
                                    ? weight / n * (sigmoid(x + 1e-4) - sigmoid(x - 1e-4)) / 2e-4
                                    : 0;

            expect_near((double)t->visible_blocks.gradient[b][at], want, weight / n);
        }
}

/* The weight of all offset masks together, if all anchors had the logits of those that are seen:
 * 49 bits of each anchor besides its values, and the bits of these (3 + y^2 for type y). An
 * anchor counts as if it kept at least one on average. */
static double mask_weight(const ted4_trainer *t, const float *value)
{
    const size_t floats = (size_t)t->layout.n_channels * TED4_LANES;
    const size_t first = (size_t)t->layout.offset_logit * TED4_LANES;
    double kept = 0, seen = 0;

    for (size_t b = 0; b < t->visible_blocks.n; b++) {
        seen += __builtin_popcount(t->visible_blocks.lanes[b]);
        for (size_t j = 0; j < (size_t)t->layout.head.n_offsets * TED4_LANES; j++)
            kept += t->visible_blocks.lanes[b] >> j % TED4_LANES & 1 &&
                    sigmoid((double)value[b * floats + first + j]) > 0.01;
    }
    return t->opt.lambda * t->opt.mask_weight * (49 + 3 + 4 + 7 + 12 + 19) * (double)t->anchors.n /
           (ted4_rate_norm(t) * fmax(kept, seen));
}

static void test_masks(void **state)
{
    (void)state;
    for (int turn = 0; turn < 3; turn++) {
        const int stage2 = turn > 0, closed = turn == 2;
        ted4_trainer t;

        begin(&t, 5);
        const size_t floats = (size_t)t.layout.n_channels * TED4_LANES;
        const int K = t.layout.head.n_offsets;

        t.phase.stage2 = stage2;
        t.opt.lambda = 5;
        t.opt.temporal_weight = 0.7;
        for (int y = 0; y < TED4_TYPES; y++)
            t.progress.bits[y] = 3 + y * y;
        for (size_t i = 0; i < t.anchors.n; i++)
            for (int c = t.layout.offset_logit; c < t.layout.n_channels; c++)
                *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, c) =
                    closed ? -5.0f : 12.0f * ted4_uniform(3, i * 32 + (uint64_t)c) - 6.0f;
        assert_int_equal(ted4_visible_blocks_fill(&t, NULL), 0);
        t.visible_blocks.lanes[0] &= 0x5a5a5a5a;
        memset(t.visible_blocks.gradients, 0, t.visible_blocks.n * floats * sizeof(float));

        float *before = malloc(t.visible_blocks.n * floats * sizeof *before);

        assert_non_null(before);
        memcpy(before, t.anchors.data[TED4_ROW_VALUE],
               t.visible_blocks.n * floats * sizeof *before);

        const double weight = mask_weight(&t, before);

        ted4_update_parameters(&t, 1);
        check_logits(&t, before, t.layout.temporal_logit, 0.7);
        for (int k = 0; k < K; k++)
            check_logits(&t, before, t.layout.offset_logit + k, stage2 ? weight : 0);
        free(before);
        ted4_trainer_finish(&t);
    }
}

/* ---- Adam ---- */

static void test_adam(void **state)
{
    float x = 0.5f, m = 0, v = 0;
    double X = 0.5, M = 0, V = 0;

    (void)state;
    for (uint64_t step = 1; step <= 200; step++) {
        const float g = ted4_uniform(5, step) - 0.3f;

        ted4_adam(&x, &m, &v, &g, 1, 0.01f, ted4_adam_bias_make(step));
        M = 0.9 * M + 0.1 * (double)g;
        V = 0.999 * V + 0.001 * (double)g * (double)g;
        X -= 0.01 * (M / (1 - pow(0.9, (double)step))) /
             (sqrt(V / (1 - pow(0.999, (double)step))) + 1e-15);
        assert_true(fabs((double)x - X) < 2e-5);
    }
    assert_true(fabs(ted4_decay(0.1, 0.01, 0.5) - 0.01) < 1e-12);
    assert_true(ted4_decay(0.1, 0.01, 2) == ted4_decay(0.1, 0.01, 1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_volume),
        cmocka_unit_test(test_bank),
        cmocka_unit_test(test_masks),
        cmocka_unit_test(test_adam),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
