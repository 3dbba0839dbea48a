/* test_generate_grad.c - train/splat/decode_bwd.c against central differences of the
 * double-precision reference: every channel of anchors, every value of the networks and the bank,
 * and the centre of the camera.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "generate_case.h"
#include "odd_threads.h"

/* Step of the differences. Small, because ReLU networks have kinks everywhere; in double precision
 * this costs about 1e-9 of accuracy. */
#define STEP       1e-7
/* Linear sizes are clamped to at least this (spec 11). */
#define SIZE_FLOOR 0x1p-20
/* Tolerance of gradients, relative to the sum of the magnitudes of their terms. */
#define TOLERANCE  2e-5

static test_case scene;
static float gradient[REF_OUT][CASE_SPLATS];
static _Alignas(64) float d_attr[CASE_BLOCKS][CASE_CHANNELS * TED4_LANES];
static float d_net[CASE_NET], first_net[CASE_NET];
static double channels[CASE_BLOCKS][TED4_LANES][CASE_CHANNELS],
    positions[CASE_BLOCKS][TED4_LANES][3];

/* from: REF_OUT arrays of n. */
static ted4_splat_grads splat_gradients(float *from, size_t n)
{
    ted4_splat_grads gr;

    memset(&gr, 0, sizeof gr);
    for (size_t c = 0; c < 3; c++) {
        gr.mean[c] = from + c * n;
        gr.scale[c] = from + (3 + c) * n;
        gr.colour[c] = from + (11 + c) * n;
    }
    for (size_t c = 0; c < 4; c++)
        gr.rot[c] = from + (6 + c) * n;
    gr.opacity = from + 10 * n;
    return gr;
}

/* Runs the generator forward and backward on the scene, from random gradients of the splats. d_net
 * starts at 1, to test that gradients are added. */
static void run(ted4_generator *g, const ted4_parallel *p)
{
    float *list[CASE_BLOCKS];
    const ted4_splat_grads gr = splat_gradients(gradient[0], CASE_SPLATS);
    ted4_splats s;

    for (int i = 0; i < CASE_BLOCKS; i++)
        list[i] = d_attr[i];
    memset(d_attr, 0xff, sizeof d_attr);
    for (size_t i = 0; i < CASE_NET; i++)
        d_net[i] = 1.0f;
    ted4_generator_pack(g, scene.net);
    assert_int_equal(ted4_generate(g, &scene.in, p, &s), 0);
    assert_int_equal(ted4_generate_backward(g, &scene.in, &gr, p, list, d_net), 0);
}

static ted4_generator *make(const ted4_header *h, uint32_t num, uint32_t den)
{
    ted4_generator *g;

    case_make(&scene, h, num, den, 11 * num + 3 * den + h->motion);
    for (int c = 0; c < REF_OUT; c++)
        for (int i = 0; i < CASE_SPLATS; i++)
            gradient[c][i] = case_random(&scene);
    for (int i = 0; i < CASE_BLOCKS; i++)
        for (int lane = 0; lane < TED4_LANES; lane++)
            case_channels(&scene, i, lane, channels[i][lane], positions[i][lane]);
    g = ted4_generator_new(&scene.layout);
    assert_non_null(g);
    return g;
}

/* The loss of one anchor: its splats times their gradients. */
static double loss(int visible, int lane, const double *channel)
{
    double out[CASE_OFFSETS][REF_OUT], sum = 0.0;

    ref_generate(&scene.query, channel, channels[visible][lane], positions[visible][lane], out);
    for (int k = 0; k < CASE_OFFSETS; k++)
        for (int c = 0; c < REF_OUT; c++)
            sum += out[k][c] * gradient[c][(visible * CASE_OFFSETS + k) * TED4_LANES + lane];
    return sum;
}

/* Whether a linear size is at its floor or below. There the gradient is that of a size just above
 * the floor if a step would increase the size, and 0 otherwise. */
static int is_floored(int c, double value)
{
    const int first = scene.layout.first[TED4_SCALING];

    return scene.layout.head.scale_domain == TED4_SCALE_LINEAR && c >= first && c < first + 6 &&
           value <= SIZE_FLOOR;
}

static void check_anchor(int visible, int lane)
{
    double channel[CASE_CHANNELS];

    memcpy(channel, channels[visible][lane], sizeof channel);
    for (int c = 0; c < scene.layout.n_channels; c++) {
        const double got = d_attr[visible][c * TED4_LANES + lane], old = channel[c];
        const int floored = is_floored(c, old);
        const double at = floored ? SIZE_FLOOR + 2 * STEP : old;
        double want;

        if ((scene.lanes[visible] >> lane & 1) == 0) {
            assert_true(got == 0.0);
            continue;
        }
        channel[c] = at + STEP;
        want = loss(visible, lane, channel);
        channel[c] = at - STEP;
        want = (want - loss(visible, lane, channel)) / (2.0 * STEP);
        want = floored && want > 0 ? 0 : want;
        channel[c] = old;
        if (!(fabs(got - want) <= TOLERANCE * (1.0 + fabs(want))))
            fail_msg("slot %d lane %d channel %d: %g, not %g", visible, lane, c, got, want);
    }
}

/* Returns the change of the loss, summed over anchors. *size: the sum of the changes'
 * magnitudes. */
static double net_difference(size_t i, double *size)
{
    const double old = scene.exact_net[i];
    double sum = 0.0;

    *size = 0.0;
    for (int visible = 0; visible < CASE_BLOCKS; visible++)
        for (int lane = 0; lane < TED4_LANES; lane++) {
            double rise;

            if ((scene.lanes[visible] >> lane & 1) == 0)
                continue;
            scene.exact_net[i] = old + STEP;
            rise = loss(visible, lane, channels[visible][lane]);
            scene.exact_net[i] = old - STEP;
            rise = (rise - loss(visible, lane, channels[visible][lane])) / (2.0 * STEP);
            sum += rise;
            *size += fabs(rise);
        }
    scene.exact_net[i] = old;
    return sum;
}

/* Checks every step-th value, and the whole bank. */
static void check_net(size_t step)
{
    for (size_t i = 0; i < scene.layout.nete; i += i < scene.layout.bank ? step : 1) {
        double size;
        const double want = net_difference(i, &size), got = d_net[i] - 1.0f;

        if (!(fabs(got - want) <= TOLERANCE * (1.0 + size)))
            fail_msg("network value %zu: %g, not %g (%g)", i, got, want, size);
    }
    for (size_t i = scene.layout.nete; i < CASE_NET; i++)
        assert_true(d_net[i] == 1.0f);
}

/* Checks the gradient of the camera's centre, by way of viewing directions. */
static void check_camera(const ted4_generator *g)
{
    for (int c = 0; c < 3; c++) {
        const double got = (double)ted4_generate_camera_gradient(g)[c];
        const double old = scene.query.camera[c];
        double want = 0, size = 0;

        for (int visible = 0; visible < CASE_BLOCKS; visible++)
            for (int lane = 0; lane < TED4_LANES; lane++) {
                double rise;

                if ((scene.lanes[visible] >> lane & 1) == 0)
                    continue;
                scene.query.camera[c] = old + STEP;
                rise = loss(visible, lane, channels[visible][lane]);
                scene.query.camera[c] = old - STEP;
                rise = (rise - loss(visible, lane, channels[visible][lane])) / (2.0 * STEP);
                want += rise;
                size += fabs(rise);
            }
        scene.query.camera[c] = old;
        if (!(fabs(got - want) <= TOLERANCE * size))
            fail_msg("centre, axis %d: %g, not %g (%g)", c, got, want, size);
    }
}

static void check_header(const ted4_header *h, uint32_t num, uint32_t den, size_t step)
{
    ted4_generator *g = make(h, num, den);

    run(g, NULL);
    for (int i = 0; i<CASE_BLOCKS; i += step> 1 ? 5 : 1)
        for (int lane = 0; lane < TED4_LANES; lane++)
            check_anchor(i, lane);
    check_net(step);
    check_camera(g);
    ted4_generator_free(g);
}

static void test_everything(void **state)
{
    (void)state;
    for (int motion = 0; motion < 4; motion++) {
        ted4_header h = case_header(motion, motion % 3);

        check_header(&h, 5, 16, motion == TED4_MOTION_BANK ? 1 : 3);
    }
}

static void test_variants(void **state)
{
    (void)state;
    for (int bits = 0; bits < 192; bits += 5) {
        ted4_header h = case_header(bits & 3, bits >> 6);

        h.offset_mask = bits >> 2 & 1;
        h.activation = bits >> 3 & 1;
        h.scale_domain = bits >> 4 & 1;
        h.temporal_mask = (bits >> 5 & 1) && h.motion != TED4_MOTION_NONE;
        check_header(&h, 5, 16, 37);
    }
}

static void test_depths(void **state)
{
    (void)state;
    for (int motion = 0; motion < 4; motion++)
        for (int layers = 0; layers < 4; layers += 2) {
            ted4_header h = case_header(motion, layers / 2);

            h.head_layers = (uint8_t)layers;
            h.head_width = layers ? 9 : 0;
            h.deform_layers = (uint8_t)(motion ? 2 * layers + 1 : 0);
            check_header(&h, 1, 3, 31);
        }
}

static void test_times(void **state)
{
    static const uint32_t time[][2] = {
        { 0, 8 }, { 8, 8 }, { 2, 8 }, { 3, 8 }, { 0, 1 }, { 1, 1 }
    };

    (void)state;
    for (int motion = TED4_MOTION_BANK; motion <= TED4_MOTION_CONCAT; motion++)
        for (size_t i = 0; i < sizeof time / sizeof time[0]; i++) {
            ted4_header h = case_header(motion, TED4_VIEW_COLOUR);

            check_header(&h, time[i][0], time[i][1], 41);
            h.bank_rows = 1;
            check_header(&h, time[i][0], time[i][1], 43);
        }
}

static void test_activation_off(void **state)
{
    const ted4_header h = case_header(TED4_MOTION_BANK, TED4_VIEW_NONE);
    const ref_channels at = ref_channels_of(&h);
    ted4_generator *g = make(&h, 3, 16);

    (void)state;
    scene.in.activation = scene.query.activation = 0;
    run(g, NULL);
    for (int lane = 0; lane < TED4_LANES; lane++) {
        check_anchor(0, lane);
        for (int c = 0; c < 4; c++)
            assert_true(d_attr[0][(at.tau + c) * TED4_LANES + lane] == 0.0f);
    }
    ted4_generator_free(g);
}

/* All opacity outputs are negative: opacity is 0, and no gradient passes through it. */
static void test_dead(void **state)
{
    const ted4_header h = case_header(TED4_MOTION_NONE, TED4_VIEW_NONE);
    const ref_channels at = ref_channels_of(&h);
    ted4_generator *g = make(&h, 3, 16);
    const ted4_net_shape *net = &scene.layout.shape.netr[TED4_NET_OPACITY];
    const size_t end = scene.layout.shape.netr[TED4_NET_COVARIANCE].first;

    (void)state;
    for (int k = 0; k < CASE_OFFSETS; k++)
        scene.net[end - 1 - (size_t)k] = -50.0f;
    run(g, NULL);
    for (size_t i = net->first; i < end; i++)
        assert_true(d_net[i] == 1.0f);
    for (int visible = 0; visible < CASE_BLOCKS; visible++)
        for (int j = 0; j < TED4_LANES; j++)
            for (int k = 0; k < CASE_OFFSETS; k++)
                assert_true(d_attr[visible][(at.offset_logit + k) * TED4_LANES + j] == 0.0f);
    ted4_generator_free(g);
}

/* The same visible blocks many times, so that chunks have several groups: gradients of the networks
 * are multiplied by that number. */
static void test_many_blocks(void **state)
{
    enum { TIMES = 9, N_BLOCKS = TIMES * CASE_BLOCKS };
    static float many[REF_OUT][TIMES * CASE_SPLATS];
    static _Alignas(64) float many_attr[N_BLOCKS][CASE_CHANNELS * TED4_LANES];
    static const float *attr[N_BLOCKS], *position[N_BLOCKS];
    static float *d_list[N_BLOCKS];
    static uint32_t lanes[N_BLOCKS];
    const ted4_header h = case_header(TED4_MOTION_BANK, TED4_VIEW_COLOUR);
    ted4_generator *g = make(&h, 3, 16);
    const size_t used = (size_t)scene.layout.n_channels * TED4_LANES * sizeof **many_attr;
    ted4_splat_grads gr;
    ted4_splats s;

    (void)state;
    run(g, NULL);
    memcpy(first_net, d_net, sizeof d_net);
    for (int i = 0; i < N_BLOCKS; i++) {
        attr[i] = scene.attr[i % CASE_BLOCKS];
        position[i] = scene.position[i % CASE_BLOCKS];
        lanes[i] = scene.lanes[i % CASE_BLOCKS];
        d_list[i] = many_attr[i];
    }
    for (int c = 0; c < REF_OUT; c++)
        for (int i = 0; i < TIMES * CASE_SPLATS; i++)
            many[c][i] = gradient[c][i % CASE_SPLATS];
    gr = splat_gradients(many[0], TIMES * CASE_SPLATS);
    scene.in.attr = attr;
    scene.in.position = position;
    scene.in.lanes = lanes;
    scene.in.n_visible = N_BLOCKS;
    assert_int_equal(ted4_generate(g, &scene.in, NULL, &s), 0);
    assert_int_equal(ted4_generate_backward(g, &scene.in, &gr, NULL, d_list, d_net), 0);
    for (int i = 0; i < N_BLOCKS; i++)
        assert_memory_equal(many_attr[i], d_attr[i % CASE_BLOCKS], used);
    for (size_t i = 0; i < scene.layout.nete; i++) {
        const float once = first_net[i] - 1.0f, all = d_net[i] - first_net[i];

        assert_true(fabsf(all - TIMES * once) <= 1e-3f + 1e-4f * fabsf(all));
    }
    ted4_generator_free(g);
}

static void test_threads(void **state)
{
    static const ted4_parallel runs[] = { { odd_backwards, NULL }, { odd_threads, NULL } };
    static float first_attr[CASE_BLOCKS][CASE_CHANNELS * TED4_LANES];
    float camera[3];

    (void)state;
    for (int motion = 0; motion < 4; motion++) {
        const ted4_header h = case_header(motion, TED4_VIEW_FULL);
        ted4_generator *g = make(&h, 3, 16);

        run(g, NULL);
        memcpy(first_attr, d_attr, sizeof d_attr);
        memcpy(first_net, d_net, sizeof d_net);
        memcpy(camera, ted4_generate_camera_gradient(g), sizeof camera);
        for (int i = 0; i < 2; i++) {
            run(g, &runs[i]);
            assert_memory_equal(first_attr, d_attr, sizeof d_attr);
            assert_memory_equal(first_net, d_net, sizeof d_net);
            assert_memory_equal(camera, ted4_generate_camera_gradient(g), sizeof camera);
        }
        ted4_generator_free(g);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_everything),     cmocka_unit_test(test_variants),
        cmocka_unit_test(test_depths),         cmocka_unit_test(test_times),
        cmocka_unit_test(test_activation_off), cmocka_unit_test(test_dead),
        cmocka_unit_test(test_many_blocks),    cmocka_unit_test(test_threads),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
