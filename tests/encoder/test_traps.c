/* test_traps.c - the points where the published recipe fails, each with our remedy: the traps of
 * annex D.1 in its order (1 to 6, and positions in FP16), and two more (7 and 8). Those that belong
 * to one module are tested there:
 * - 3, sigma clamped from below gets no gradient: test_rate.c, clamped outputs recover;
 * test_rate_grad.c, clamped;
 * - 4, a floor under likelihoods leaves outliers without gradient: test_rate_row.c, outliers have
 * gradient; test_rate_grad.c, outliers;
 * - 5, steps that reach 0: test_rate.c, clamped outputs recover; the symbols that would overflow:
 * test_rate.c, quantise, and below;
 * - 7, the cap of opacity and the early stop are discontinuous: test_raster_grad.c, cap and early
 * stop. Therefore pictures are compared with a tolerance (test_raster.c), and bit-exactness ends at
 * the Gaussians (test_recon.c).
 * Tested here: 1 spans that begin with the sequence, 2 the saddle point of the bank's query, 5
 * symbols of a file, 6 units of the world and small scalings, 8 anchors that are never present; and
 * positions in FP16: none beyond 1, no two equal.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_group.h"
#include "base/bytes.h"
#include "cloud_case.h"
#include "norm/half.h"
#include "norm/scene.h"
#include "norm/tables.h"
#include "train/state/visible_blocks.h"
#include "train/step/export_scene.h"
#include "train/step/stages.h"
#include "train/step/trainer_init.h"

static cloud_case cloud;

/* ---- 1: a span that begins at the first frame or ends at the last ---- */

/* Computes the gradients of the sum of all opacities at a frame, in t->visible_blocks.gradient. */
static void opacity_gradients(ted4_trainer *t, uint32_t frame)
{
    ted4_generate_input in = {
        .layout = &t->layout, .net = t->net.value, .num = frame, .den = FRAMES - 1, .activation = 1
    };
    ted4_splats s;
    ted4_splat_grads g;

    in.camera[2] = 4.0f;
    assert_int_equal(ted4_visible_blocks_fill(t, NULL), 0);
    in.n_visible = t->visible_blocks.n;
    in.attr = t->visible_blocks.raw;
    in.position = t->visible_blocks.position;
    in.lanes = t->visible_blocks.lanes;
    ted4_generator_pack(t->work.generator, t->net.value);
    assert_int_equal(ted4_generate(t->work.generator, &in, NULL, &s), 0);

    float *zero = calloc(s.n, sizeof *zero), *one = malloc(s.n * sizeof *one);
    uint8_t *seen = malloc(s.n);

    assert_non_null(zero);
    assert_non_null(one);
    assert_non_null(seen);
    for (size_t i = 0; i < s.n; i++) {
        one[i] = 1.0f;
        seen[i] = 1;
    }
    for (int j = 0; j < 3; j++)
        g.mean[j] = g.scale[j] = g.colour[j] = zero;
    for (int j = 0; j < 4; j++)
        g.rot[j] = zero;
    g.opacity = one;
    g.mean2d = zero;
    g.visible = seen;
    assert_int_equal(ted4_generate_backward(t->work.generator, &in, &g, NULL,
                                            t->visible_blocks.gradient, t->net.gradient),
                     0);
    free(zero);
    free(one);
    free(seen);
}

/* Number of anchors with a gradient on component c of tau. */
static size_t pulled(const ted4_trainer *t, int c)
{
    size_t n = 0;

    for (size_t i = 0; i < t->visible_blocks.n; i++)
        for (size_t j = 0; j < TED4_LANES; j++) {
            const size_t channel = (size_t)(t->layout.first[TED4_TAU] + c);

            n += (t->visible_blocks.lanes[i] >> j & 1) &&
                 t->visible_blocks.gradient[i][channel * TED4_LANES + j] != 0.0f;
        }
    return n;
}

/* Everything is visible at all times, so all spans reach from the first frame to the last. If a_s
 * were at the first frame itself, no frame would lie before it, and it could never move. */
static void test_spans(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, 40);
    /* No anchor is transparent at any time. */
    ball_set_biases(&t, TED4_NET_OPACITY, t.layout.head.n_offsets, 10.0f);
    assert_int_equal(ted4_activation_begin(&t), 0);
    for (int end = 0; end < 2; end++) {
        opacity_gradients(&t, end ? FRAMES - 1 : 0);
        assert_true(pulled(&t, end ? 2 : 0) > t.anchors.n / 2);
        assert_true(pulled(&t, end ? 3 : 1) > t.anchors.n / 2);
        assert_int_equal(pulled(&t, end ? 0 : 2), 0);
    }
    ted4_trainer_finish(&t);
}

/* ---- 2: the query is a product, and a product of zeros has no gradient ---- */

static double magnitude(const float *x, size_t n)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += fabs((double)x[i]);
    return sum;
}

static size_t first_layer(const ted4_net_shape *s)
{
    return (size_t)s->dim[0] * s->dim[1];
}

/* The last layer of F_deform is initialised to zero, so the first step changes only this layer; in
 * the second step, everything that moves anchors must have a gradient. */
static void test_saddle(void **state)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;
    const size_t phi = TED4_LANES * 4; /* values of phi in a block */
    double on_phi = 0;

    (void)state;
    o.tv_weight = 0; /* else the bank has a gradient of its own */
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, 2);
    assert_int_equal(t.layout.head.phi_dim, 4);

    const ted4_shape *s = &t.layout.shape;
    const float *d = t.net.gradient + t.layout.netr;
    const ted4_net_shape *project = &s->netr[TED4_NET_PROJECT], *deform = &s->netr[TED4_NET_DEFORM];

    for (size_t i = 0; i < t.visible_blocks.n; i++)
        on_phi +=
            magnitude(t.visible_blocks.gradient[i] + t.layout.first[TED4_PHI] * TED4_LANES, phi);
    assert_true(on_phi > 0);
    assert_true(magnitude(d + project->first, first_layer(project)) > 0);
    assert_true(magnitude(d + deform->first, first_layer(deform)) > 0);
    assert_true(magnitude(t.net.gradient + t.layout.bank, s->n_bank) > 0);
    ted4_trainer_finish(&t);
}

/* ---- 5: symbols beyond 16 bits ---- */

/* Makes opacity ignore the first feature: otherwise huge values of it would hide all anchors of one
 * sign, or of both. */
static void blind_opacity(ted4_trainer *t)
{
    const ted4_net_shape *s = &t->layout.shape.netr[TED4_NET_OPACITY];

    for (size_t o = 0; o < s->dim[1]; o++)
        t->net.value[t->layout.netr + s->first + o * s->dim[0]] = 0.0f;
}

/* Values that are far too large become the largest symbols, with their sign, in a file that
 * decodes. */
static void test_symbols(void **state)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;
    ted4_scene *s, *back;
    uint8_t *bytes;
    size_t size, n, low = 0, high = 0;
    ted4_error e = { TED4_OK, 0 };

    (void)state;
    ball_set(&o, "stage1=30");
    ball_set(&o, "stage2=0");
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, 30);
    for (size_t i = 0; i < t.anchors.n; i++)
        *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.first[TED4_FEATURE]) =
            i % 2 ? 3e6f : -3e6f;
    blind_opacity(&t);
    if (ted4_export_scene(&t, &s) != 0)
        fail_msg("%s", t.message.text);
    assert_int_equal(ted4_encode(s, 0, NULL, &bytes, &size, &e), TED4_OK);
    assert_int_equal(ted4_decode(bytes, size, NULL, &back, &e), TED4_OK);
    n = back->head.n_anchors;
    for (size_t i = 0; i < n; i++) {
        low += back->symbol[TED4_FEATURE][i] == -32767;
        high += back->symbol[TED4_FEATURE][i] == 32767;
    }
    assert_int_equal(low + high, n);
    assert_true(low > n / 4);
    assert_true(high > n / 4);
    ted4_scene_free(s);
    ted4_scene_free(back);
    free(bytes);
    ted4_trainer_finish(&t);
}

/* ---- 6: scalings in the units of the world ---- */

/* The same scene in units 4096 times as large gives bit-identical anchors. */
static void test_units(void **state)
{
    ted4_trainer metre, league;
    cloud_case far;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_make(&far, 5);
    for (size_t i = 0; i < CLOUD_POINTS; i++)
        for (int j = 0; j < 3; j++)
            far.point[i][j] *= 0x1p-12f;
    for (int j = 0; j < 3; j++)
        far.picture.camera.t[j] *= 0x1p-12;
    assert_int_equal(ted4_trainer_init(&metre, &cloud.options, &cloud.data, NULL), 0);
    assert_int_equal(ted4_trainer_init(&league, &far.options, &far.data, NULL), 0);
    assert_int_equal(metre.layout.head.exponent, league.layout.head.exponent + 12);
    assert_true(metre.voxel == league.voxel);
    assert_int_equal(metre.anchors.n, league.anchors.n);
    for (int row = 0; row < TED4_ROWS; row++)
        assert_memory_equal(metre.anchors.data[row], league.anchors.data[row],
                            metre.anchors.n_blocks * (size_t)metre.anchors.rows[row] * TED4_LANES *
                                sizeof(float));
    ted4_trainer_finish(&metre);
    ted4_trainer_finish(&league);
}

/* log2 of component c of all scalings: far below the linear step, as in scenes with small units. */
static float small_scaling(unsigned c)
{
    return -17.0f - 0.37f * (float)c;
}

/* Number of scalings in the file whose error is at most half a step, with a step of less than 0.2
 * in log2 (a seventh of the scaling); in linear units: number of those above 0. */
static size_t count_right(const ted4_scene *s, int linear)
{
    const size_t n = s->head.n_anchors;
    size_t right = 0;

    for (size_t i = 0; i < n; i++) {
        const float q = s->head.step[TED4_SCALING] *
                        ted4_bits_float(ted4_step[s->step_index[TED4_SCALING][i]]);

        for (unsigned c = 0; c < 6; c++) {
            const float got = q * (float)s->symbol[TED4_SCALING][c * n + i];

            right += linear ? got > 0
                            : q < 0.2f && fabsf(got - small_scaling(c)) <= 0.5f * q + 1e-4f;
        }
    }
    return right;
}

/* In log2 the error of a scaling is relative to the scaling, however small it is. In linear units,
 * kept for comparison, such scalings are lost. */
static void test_scalings(void **state)
{
    (void)state;
    for (int linear = 0; linear < 2; linear++) {
        ted4_train_options o = ball_options();
        ted4_trainer t;
        ted4_scene *s;

        ball_set(&o, "stage1=30");
        ball_set(&o, "stage2=0");
        if (linear) {
            ball_set(&o, "linear_scale=1");
            ball_set(&o, "step_scaling=0.001");
        }
        ball_begin(&t, &o, &balls, NULL);
        ball_train(&t, 30);
        for (size_t i = 0; i < t.anchors.n; i++)
            for (unsigned c = 0; c < 6; c++)
                *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i,
                                   t.layout.first[TED4_SCALING] + (int)c) = small_scaling(c);
        if (ted4_export_scene(&t, &s) != 0)
            fail_msg("%s", t.message.text);
        assert_true(s->head.n_anchors > 10);
        assert_int_equal(s->head.scale_domain, (linear ? TED4_SCALE_LINEAR : TED4_SCALE_LOG2));
        assert_int_equal(count_right(s, linear), linear ? 0 : 6 * s->head.n_anchors);
        ted4_scene_free(s);
        ted4_trainer_finish(&t);
    }
}

/* ---- 8: anchors whose activation stays near 0 ---- */

/* Marks every third anchor by an offset that no other has. absent: its span also lies between two
 * frames and is too short to reach either. */
static void mark(ted4_trainer *t, int absent)
{
    const int tau = t->layout.first[TED4_TAU];

    for (size_t i = 0; i < t->anchors.n; i += 3) {
        *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_OFFSET]) = 1000.0f;
        for (int c = 0; c < 4 && absent; c++)
            *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, tau + c) =
                c % 2 ? -10.0f : 0.5f / (FRAMES - 1);
    }
}

/* Those of profile Main, whose positions stay where they are but for their rounding. */
static ted4_train_options main_options(void)
{
    ted4_train_options o = ball_options();

    ball_set(&o, "profile=0");
    return o;
}

/* Counts the anchors that enter stage 2. */
static void count(const ted4_trainer *t, size_t *marked, size_t *others)
{
    *marked = 0;
    for (size_t i = 0; i < t->anchors.n; i++)
        *marked += *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                      t->layout.first[TED4_OFFSET]) == 1000.0f;
    *others = t->anchors.n - *marked;
}

static void test_absent(void **state)
{
    const ted4_train_options o = main_options();
    size_t marked[2], others[2];

    (void)state;
    for (int absent = 0; absent < 2; absent++) {
        ted4_trainer t;

        ball_begin(&t, &o, &balls, NULL);
        ball_train(&t, 60);
        assert_int_equal(ted4_activation_begin(&t), 0);
        mark(&t, absent);
        assert_int_equal(ted4_stage2_begin(&t), 0);
        count(&t, &marked[absent], &others[absent]);
        ted4_trainer_finish(&t);
    }
    assert_true(marked[0] > 10);
    assert_true(others[0] > 20);
    assert_int_equal(marked[1], 0);
    assert_int_equal(others[1], others[0]);
}

/* ---- positions in FP16 ---- */

/* Far from the origin of the world, FP16 world coordinates would be coarser than the scene's
 * details; and an outlier must neither widen the range nor lie outside it. */
static void test_far_away(void **state)
{
    static const float shift[3] = { 1000, -500, 2000 };
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, 5);
    for (size_t i = 0; i < CLOUD_POINTS; i++)
        for (int j = 0; j < 3; j++)
            cloud.point[i][j] += shift[j];
    for (int j = 0; j < 3; j++)
        cloud.picture.camera.t[j] -= (double)shift[j];
    cloud.point[7][1] = 1e6f;
    assert_int_equal(ted4_trainer_init(&t, &cloud.options, &cloud.data, NULL), 0);
    assert_int_equal(t.anchors.n, CLOUD_POINTS - 1);
    for (size_t i = 0; i < t.anchors.n; i++)
        for (int j = 0; j < 3; j++) {
            const float p = *ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, i, j);
            const float half = ted4_half_to_float(ted4_float_to_half(p));

            assert_true(fabsf(p) <= 1.0f);
            assert_true(fabsf(half) <= 1.0f);
            assert_true(ldexpf(fabsf(half - p), t.layout.head.exponent) <
                        0.002f * (float)CLOUD_STEP);
        }
    ted4_trainer_finish(&t);
}

/* Positions that FP16 cannot distinguish become one anchor, before stage 2 trains on the values of
 * the file. */
static void test_twins(void **state)
{
    const ted4_train_options o = main_options();
    size_t n[2];

    (void)state;
    for (int twins = 0; twins < 2; twins++) {
        ted4_trainer t;

        ball_begin(&t, &o, &balls, NULL);
        ball_train(&t, 60);
        for (size_t i = 0; i + 1 < t.anchors.n && twins; i += 20)
            for (int j = 0; j < 3; j++)
                *ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, i + 1, j) =
                    *ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, i, j) * (1.0f + 0x1p-20f);
        assert_int_equal(ted4_stage2_begin(&t), 0);
        n[twins] = t.anchors.n;
        assert_int_equal(ted4_anchors_sort(&t.anchors, NULL), 0);
        for (size_t i = 0; i < t.anchors.n; i++) {
            for (int j = 0; j < 3; j++) {
                const float x = *ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, i, j);

                assert_true(ted4_half_to_float(ted4_float_to_half(x)) == x);
            }
            assert_true(i == 0 ||
                        ted4_anchor_morton(&t.anchors, i - 1) < ted4_anchor_morton(&t.anchors, i));
        }
        ted4_trainer_finish(&t);
    }
    assert_true(n[1] < n[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spans),    cmocka_unit_test(test_saddle),
        cmocka_unit_test(test_symbols),  cmocka_unit_test(test_units),
        cmocka_unit_test(test_scalings), cmocka_unit_test(test_absent),
        cmocka_unit_test(test_far_away), cmocka_unit_test(test_twins),
    };

    return cmocka_run_group_tests_name("traps", tests, set_up, tear_down);
}
