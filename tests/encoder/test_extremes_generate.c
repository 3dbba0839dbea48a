/* test_extremes_generate.c - generation of Gaussians, motion, activation and heads at extreme
 * values, forward and backward: compared with spec 11 in double precision (generate_ref.h) where
 * that gives a number, and finite everywhere.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "generate_case.h"

#define TOLERANCE 2e-5

static test_case scene;
static float gradient[REF_OUT][CASE_SPLATS], d_net[CASE_NET];
static _Alignas(64) float d_attr[CASE_BLOCKS][CASE_CHANNELS * TED4_LANES];
static float member[REF_OUT][CASE_SPLATS];

/* Makes a scene of random anchors, in which the test sets visible block 0. The gradients of splats
 * are random, of the given size. */
static void begin(const ted4_header *h, float size)
{
    case_make(&scene, h, 5, 16, 77u + h->motion);
    for (int c = 0; c < REF_OUT; c++)
        for (int i = 0; i < CASE_SPLATS; i++)
            gradient[c][i] = size * case_random(&scene);
}

static void everywhere(int channel, float value)
{
    for (int j = 0; j < TED4_LANES; j++)
        case_set(&scene, j, channel, value);
}

static ted4_splat_grads splat_gradients(void)
{
    ted4_splat_grads gr = { .opacity = gradient[10] };

    for (int c = 0; c < 3; c++) {
        gr.mean[c] = gradient[c];
        gr.scale[c] = gradient[3 + c];
        gr.colour[c] = gradient[11 + c];
    }
    for (int c = 0; c < 4; c++)
        gr.rot[c] = gradient[6 + c];
    return gr;
}

static void all_finite(const float *x, size_t n, const char *what)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            fail_msg("%s %zu is %g", what, i, (double)x[i]);
}

/* Runs forward and backward, and asserts that all results are finite. */
static void run(void)
{
    const ted4_splat_grads gr = splat_gradients();
    ted4_generator *g = ted4_generator_new(&scene.layout);
    float *list[CASE_BLOCKS];
    ted4_splats s;

    assert_non_null(g);
    for (int i = 0; i < CASE_BLOCKS; i++)
        list[i] = d_attr[i];
    memset(d_net, 0, sizeof d_net);
    ted4_generator_pack(g, scene.net);
    assert_int_equal(ted4_generate(g, &scene.in, NULL, &s), 0);
    assert_int_equal(ted4_generate_backward(g, &scene.in, &gr, NULL, list, d_net), 0);
    for (int c = 0; c < REF_OUT; c++) {
        memcpy(member[c], case_member(&s, c), sizeof member[c]);
        all_finite(member[c], CASE_SPLATS, "value");
    }
    for (int i = 0; i < CASE_BLOCKS; i++)
        all_finite(d_attr[i], (size_t)scene.layout.n_channels * TED4_LANES,
                   "gradient of an anchor");
    all_finite(d_net, CASE_NET, "gradient of a network");
    ted4_generator_free(g);
}

static void reference(int lane, const double *channel, const double *base, double (*out)[REF_OUT])
{
    double unused[CASE_CHANNELS], position[3];

    case_channels(&scene, 0, lane, unused, position);
    ref_generate(&scene.query, channel, base, position, out);
}

/* Compares the splats of visible block 0 with double arithmetic. terms: the size of the terms of
 * sums, whose rounding remains even if the sum is small. */
static void check_sums(double terms)
{
    for (int i = 0; i < CASE_NET; i++)
        scene.exact_net[i] = (double)scene.net[i];
    for (int lane = 0; lane < TED4_LANES; lane++) {
        double channel[CASE_CHANNELS], position[3], want[CASE_OFFSETS][REF_OUT];

        case_channels(&scene, 0, lane, channel, position);
        reference(lane, channel, channel, want);
        for (int k = 0; k < CASE_OFFSETS; k++)
            for (int c = 0; c < REF_OUT; c++) {
                const double got = (double)member[c][k * TED4_LANES + lane];
                const double off = fabs(got - want[k][c]), size = 1 + fabs(want[k][c]);

                if (!(off <= TOLERANCE * size + 2 * FLT_EPSILON * terms))
                    fail_msg("lane %d offset %d member %d: %g, not %g", lane, k, c, got,
                             want[k][c]);
            }
    }
}

static void check_values(void)
{
    check_sums(0);
}

/* Compares the gradient of a channel of visible block 0 with central differences of step h, or of h
 * / 100 if the two differ (a kink). */
static void check_channel(int c, double h)
{
    for (int lane = 0; lane < TED4_LANES; lane++) {
        double base[CASE_CHANNELS], channel[CASE_CHANNELS], position[3], want[2];
        const double got = (double)d_attr[0][c * TED4_LANES + lane];

        case_channels(&scene, 0, lane, base, position);
        memcpy(channel, base, sizeof channel);
        for (int fine = 0; fine < 2; fine++) {
            const double step = fine ? 0.01 * h : h;
            double side[2] = { 0, 0 };

            for (int up = 0; up < 2; up++) {
                double out[CASE_OFFSETS][REF_OUT];

                channel[c] = base[c] + (up ? step : -step);
                reference(lane, channel, base, out);
                for (int k = 0; k < CASE_OFFSETS; k++)
                    for (int m = 0; m < REF_OUT; m++)
                        side[up] += out[k][m] * (double)gradient[m][k * TED4_LANES + lane];
            }
            want[fine] = (side[1] - side[0]) / (2 * step);
        }
        if (fabs(want[0] - want[1]) > 1e-3 * fabs(want[1]) + 1e-6)
            continue;
        if (!(fabs(got - want[0]) <= 2e-4 * fabs(want[0]) + 1e-5))
            fail_msg("lane %d channel %d: gradient %g, not %g", lane, c, got, want[0]);
    }
}

/* ---- activation ---- */

/* Widths from far below their floor to huge, at times before, on, at and after the edges: values
 * and gradients are those of exp(-u u), which at the floor is 0 a few thousandths beyond the
 * edge. */
static void test_activation(void **state)
{
    static const float width[] = { -FLT_MAX, -126, -30, -12.0001f, -12,   -11.9999f,
                                   -1,       0,    30,  126,       65504, FLT_MAX };
    static const float beyond[] = { 0,     1e-45f, 0x1p-24f, 0x1p-13f, 0x1p-12f, 0x1p-10f,
                                    0.01f, 0.3f,   1,        100,      65504 };
    const ted4_header h = case_header(TED4_MOTION_NONE, TED4_VIEW_NONE);
    const ref_channels at = ref_channels_of(&h);

    (void)state;
    for (size_t w = 0; w < sizeof width / sizeof *width; w++)
        for (size_t b = 0; b < sizeof beyond / sizeof *beyond; b++)
            for (int late = 0; late < 2; late++) {
                begin(&h, 1);
                everywhere(at.tau, late ? -1 : 5.0f / 16 + beyond[b]);
                everywhere(at.tau + 1, width[w]);
                everywhere(at.tau + 2, late ? 5.0f / 16 - beyond[b] : 1e5f);
                everywhere(at.tau + 3, width[w]);
                run();
                check_values();
                /* Steps that stay on one side of the edge and of the floor. */
                check_channel(at.tau + 2 * late,
                              1e-3 * fmax(exp2(fmin((double)width[w], 6)), 0x1p-12));
                if (fabs((double)width[w]) < 1e3 && width[w] != -12) /* the kink at the floor */
                    check_channel(at.tau + 2 * late + 1, 1e-5);
            }
}

/* ---- sizes, offsets ---- */

/* log2 sizes up to the limit at which they are clamped and beyond; linear ones from below their
 * floor to FP16's largest. */
static void test_sizes(void **state)
{
    static const float log_size[] = { -FLT_MAX, -200, -126, -100, -24, 0, 10, 60 };
    static const float linear[] = { -65504,   -0.0f,           0, 1e-45f, FLT_MIN, 0x1p-24f,
                                    0x1p-20f, 0x1.000002p-20f, 1, 65504,  1e18f };

    (void)state;
    for (int domain = 0; domain < 2; domain++) {
        ted4_header h = case_header(TED4_MOTION_BANK, TED4_VIEW_COLOUR);
        const size_t n = domain == TED4_SCALE_LOG2 ? sizeof log_size / sizeof *log_size
                                                   : sizeof linear / sizeof *linear;

        h.scale_domain = (uint8_t)domain;
        const ref_channels at = ref_channels_of(&h);

        for (size_t i = 0; i < n; i++) {
            const float l = domain == TED4_SCALE_LOG2 ? log_size[i] : linear[i];

            begin(&h, 1);
            for (int c = 0; c < 6; c++)
                everywhere(at.scaling + c, l);
            run();
            check_values();
            if (domain == TED4_SCALE_LOG2 ? fabs((double)l) < 100 : l > 0x1p-20f && l < 100)
                for (int c = 0; c < 6; c++)
                    check_channel(at.scaling + c,
                                  1e-6 * (fabs((double)l) + 1e-3 * (domain == TED4_SCALE_LOG2)) +
                                      1e-12);
        }
    }
}

/* Linear sizes at or below their floor have the gradient of a size just above it if a step would
 * increase them, and none if it would decrease them: otherwise they would never leave the floor. */
static void test_size_floor(void **state)
{
    static const float low[] = { 0x1p-20f, 0, -0.001f, -65504 };
    static float above[6 * TED4_LANES];
    ted4_header h = case_header(TED4_MOTION_BANK, TED4_VIEW_COLOUR);
    int up = 0, down = 0;

    (void)state;
    h.scale_domain = TED4_SCALE_LINEAR;
    const int first = ref_channels_of(&h).scaling;

    for (int i = -1; i < (int)(sizeof low / sizeof *low); i++) {
        begin(&h, 1);
        for (int c = 0; c < 6; c++)
            everywhere(first + c, i < 0 ? 0x1.000002p-20f : low[i]);
        run();
        const float *d = d_attr[0] + first * TED4_LANES;

        if (i < 0)
            memcpy(above, d, sizeof above);
        for (int j = 0; i >= 0 && j < 6 * TED4_LANES; j++) {
            const float want = above[j] > 0 ? 0 : above[j];

            if (!(fabsf(d[j] - want) <= 1e-3f * fabsf(want)))
                fail_msg("size %g, gradient %d: %g, not %g", (double)low[i], j, (double)d[j],
                         (double)want);
            up += want < 0;
            down += above[j] > 0;
        }
    }
    assert_true(up > 100);
    assert_true(down > 100);
}

/* Offsets, features and phi at FP16's limits; products of sizes and offsets stay within
 * binary32. */
static void test_half_extremes(void **state)
{
    static const float half[] = { 0,        -0.0f, 0x1p-24f, -0x1p-24f, 0x1.ff8p-15f,
                                  0x1p-14f, 65504, -65504 };

    (void)state;
    for (int motion = 0; motion < 4; motion++)
        for (size_t i = 0; i < sizeof half / sizeof *half; i++) {
            const ted4_header h = case_header(motion, TED4_VIEW_FULL);
            const ref_channels at = ref_channels_of(&h);

            begin(&h, 1);
            for (int c = 0; c < at.tau; c++)
                if (c < at.scaling || c >= at.offset)
                    everywhere(c, c % 2 ? half[i] : -half[i]);
            run();
            check_sums(fabs((double)half[i]));
        }
}

/* ---- heads ---- */

/* Returns the bias of output o of the last layer of a head, and sets the layer's weights to
 * weight. */
static float *last_bias(int net, float weight)
{
    const ted4_net_shape *s = &scene.layout.shape.netr[net];
    float *w = scene.net + s->first;

    for (int i = 0; i + 1 < s->n_layers; i++)
        w += (size_t)s->dim[i + 1] * (s->dim[i] + 1u);
    const size_t n = (size_t)s->dim[s->n_layers] * s->dim[s->n_layers - 1];

    for (size_t i = 0; i < n; i++)
        w[i] *= weight;
    return w + n;
}

/* Quaternions of the covariance head: of length zero, just too short for a direction, just long
 * enough, and as long as squares allow. If a direction exists, dq = (dr - (dr r) r) / |q|;
 * otherwise the rotation is (1, 0, 0, 0) and there is no gradient. */
static void test_quaternions(void **state)
{
    static const float length[] = { 0,     1e-45f, 1e-30f, 0x1.fffp-21f, 0x1p-20f, 0x1.002p-20f,
                                    1e-3f, 65504,  1e10f,  1e18f };
    const ted4_header h = case_header(TED4_MOTION_NONE, TED4_VIEW_NONE);
    const int K = CASE_OFFSETS;

    (void)state;
    for (size_t i = 0; i < sizeof length / sizeof *length; i++)
        for (int axis = 0; axis < 5; axis++) {
            begin(&h, 1);
            float *b = last_bias(TED4_NET_COVARIANCE, 0);

            for (int k = 0; k < K; k++)
                for (int c = 0; c < 4; c++)
                    b[7 * k + 3 + c] = axis == 4 ? 0.5f * length[i] : c == axis ? length[i] : 0;
            run();
            check_values();
            /* With weights of 0, the gradient of a bias is the sum over all anchors in use. */
            const float *d = d_net + (b - scene.net);

            for (int k = 0; k < K; k++)
                for (int c = 0; c < 4; c++) {
                    double want = 0, size = 0;
                    const double n = (double)length[i];

                    for (int s = 0; s < CASE_BLOCKS * TED4_LANES; s++) {
                        const int at = (s / TED4_LANES * K + k) * TED4_LANES + s % TED4_LANES;
                        double along = 0;

                        if ((scene.lanes[s / TED4_LANES] >> s % TED4_LANES & 1) == 0 || n < 0x1p-20)
                            continue;
                        for (int m = 0; m < 4; m++)
                            along += (double)gradient[6 + m][at] * (double)b[7 * k + 3 + m] / n;
                        want +=
                            ((double)gradient[6 + c][at] - along * (double)b[7 * k + 3 + c] / n) /
                            n;
                        size += 1 / n;
                    }
                    if (!(fabs((double)d[7 * k + 3 + c] - want) <= 1e-5 * size))
                        fail_msg("length %g: gradient %g, not %g", n, (double)d[7 * k + 3 + c],
                                 want);
                }
        }
}

/* Longer than squares allow: binary32 cannot hold the length, so there is no rotation (spec 11.5 in
 * strict arithmetic says the same); everything else stays finite. */
static void test_longest_quaternions(void **state)
{
    static const float length[] = { 3e19f, 1e30f, FLT_MAX };
    const ted4_header h = case_header(TED4_MOTION_NONE, TED4_VIEW_NONE);

    (void)state;
    for (size_t i = 0; i < sizeof length / sizeof *length; i++) {
        begin(&h, 1);
        float *b = last_bias(TED4_NET_COVARIANCE, 0);

        for (int k = 0; k < CASE_OFFSETS; k++)
            for (int c = 0; c < 4; c++)
                b[7 * k + 3 + c] = c % 2 ? length[i] : -length[i];
        run();
        for (int j = 0; j < CASE_OFFSETS * TED4_LANES; j++) {
            assert_true(member[6][j] == 0);
            assert_true(member[7][j] == 0);
        }
    }
}

/* Heads driven to saturation and to 0: opacity 0, 1 and just either side of 0; colour and size
 * shares of 0 and 1. Saturated heads have no gradient. */
static void test_heads(void **state)
{
    static const float y[] = { -FLT_MAX, -1e30f, -65504, -100, -20,   -1e-6f, -1e-45f, 0,
                               1e-45f,   1e-6f,  20,     100,  65504, 1e30f,  FLT_MAX };

    (void)state;
    for (int motion = 0; motion < 2; motion++)
        for (size_t i = 0; i < sizeof y / sizeof *y; i++) {
            const ted4_header h = case_header(motion, TED4_VIEW_COLOUR);

            begin(&h, 1);
            for (int net = TED4_NET_OPACITY; net <= TED4_NET_COLOUR; net++) {
                float *b = last_bias(net, 0);

                for (int k = 0;
                     k < scene.layout.shape.netr[net].dim[scene.layout.shape.netr[net].n_layers];
                     k++)
                    if (net != TED4_NET_COVARIANCE || k % 7 < 3)
                        b[k] = y[i];
            }
            run();
            check_values();
            const float *d = d_net + (last_bias(TED4_NET_COLOUR, 0) - scene.net);

            for (int k = 0; k < 3 * CASE_OFFSETS && fabs((double)y[i]) > 90; k++)
                assert_true(fabs((double)d[k]) < 1e-30);
            if (y[i] >= 100 || y[i] <= 0)
                for (int k = 0; k < CASE_OFFSETS; k++)
                    assert_true(d_net[last_bias(TED4_NET_OPACITY, 0) - scene.net + k] == 0);
        }
}

/* All weights, biases and bank values at FP16's largest and smallest: sums of products stay within
 * binary32 through every layer, and signs decide the heads' outputs. */
static void test_weights(void **state)
{
    static const float size[] = { 0, 0x1p-24f, 0x1p-14f, 65504 };

    (void)state;
    for (int motion = 0; motion < 4; motion++)
        for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
            const ted4_header h = case_header(motion, TED4_VIEW_FULL);

            begin(&h, 1e-6f);
            for (size_t k = 0; k < scene.layout.nete; k++)
                scene.net[k] = case_random(&scene) < 0 ? -size[i] : size[i];
            for (int s = 0; s < CASE_BLOCKS; s++)
                for (int j = 0; j < TED4_LANES; j++)
                    for (int c = 0; c < h.feature_dim; c++)
                        scene.attr[s][c * TED4_LANES + j] *= 100;
            run();
            if (motion == TED4_MOTION_NONE ||
                size[i] < 1) /* otherwise offsets vanish in rounding */
                check_values();
        }
}

/* Gradients of Gaussians from zero to huge: the adjoint is linear in them. */
static void test_gradient_sizes(void **state)
{
    static const float factor[] = { 0, 0x1p-100f, 0x1p60f, 0x1p90f };
    static float one[CASE_CHANNELS * TED4_LANES];
    const ted4_header h = case_header(TED4_MOTION_BANK, TED4_VIEW_FULL);

    (void)state;
    begin(&h, 1);
    run();
    memcpy(one, d_attr[0], sizeof one);
    for (size_t i = 0; i < sizeof factor / sizeof *factor; i++) {
        begin(&h, factor[i]);
        run();
        for (int k = 0; k < scene.layout.n_channels * TED4_LANES; k++) {
            const double want = (double)one[k] * (double)factor[i];

            assert_true(fabs((double)d_attr[0][k] - want) <=
                        1e-4 * fabs(want) + 1e-5 * (double)factor[i]);
        }
    }
}

/* A camera at an anchor, so near that squares underflow, and so far that they are at their largest:
 * the direction always has length 1. */
static void test_directions(void **state)
{
    static const float from[] = { 0, 1e-30f, 0x1p-21f, 0x1p-20f, 0x1p-19f, 65504, 1e18f };
    const ted4_header h = case_header(TED4_MOTION_CONCAT, TED4_VIEW_FULL);

    (void)state;
    for (size_t i = 0; i < sizeof from / sizeof *from; i++)
        for (int axis = 0; axis < 3; axis++) {
            begin(&h, 1);
            for (int c = 0; c < 3; c++) {
                scene.in.camera[c] = c == axis ? -from[i] : 0;
                scene.query.camera[c] = (double)scene.in.camera[c];
                for (int j = 0; j < 8; j++)
                    scene.position[0][c * TED4_LANES + j] = 0;
            }
            run();
            check_values();
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_activation),     cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_size_floor),     cmocka_unit_test(test_half_extremes),
        cmocka_unit_test(test_quaternions),    cmocka_unit_test(test_longest_quaternions),
        cmocka_unit_test(test_heads),          cmocka_unit_test(test_weights),
        cmocka_unit_test(test_gradient_sizes), cmocka_unit_test(test_directions),
    };

    return cmocka_run_group_tests_name("generation at extreme values", tests, NULL, NULL);
}
