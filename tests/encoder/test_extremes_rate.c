/* test_extremes_rate.c - quantiser, rate model and its adjoint at extreme values: sigma and step at
 * their lower and upper limits, values and weights at FP16's limits, noise and rounding of values
 * beyond every symbol; and the coder's own tables at their limits. Compared with double precision
 * (rate_ref.h); all results are finite.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>

#include "test.h"
#include "norm/gaussian.h"
#include "norm/prior.h"
#include "rate_ref.h"
#include "train/rate/rate_parts.h"

static int close_to(double got, double want, double relative, double absolute)
{
    return fabs(got - want) <= absolute + relative * fabs(want);
}

static void all_finite(const float *x, size_t n, const char *what)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            fail_msg("%s %zu is %g", what, i, (double)x[i]);
}

/* ---- one symbol ---- */

static const float distances[] = { 0,       -0.0f,      1e-45f,  FLT_MIN, 0x1p-24f, 0.4999999f,
                                   0.5f,    0.5000001f, 1,       2.374f,  2.375f,   2.376f,
                                   4096.9f, 4097,       4097.1f, 32767,   65504,    1e9f,
                                   1.1e9f,  1e20f,      1e30f,   FLT_MAX };
static const float log_sigmas[] = { -FLT_MAX, -65504,    -5, -4.0000005f, -4,     -3.9999998f,
                                    -1e-45f,  0,         1,  9.414f,      9.415f, 10.9374f,
                                    10.9375f, 10.93751f, 12, 65504,       FLT_MAX };
enum {
    N_DISTANCES = sizeof distances / sizeof *distances,
    N_SIGMAS = sizeof log_sigmas / sizeof *log_sigmas
};

/* Bits for every distance with every sigma, and slopes where they are smooth. */
static void test_symbols(void **state)
{
    (void)state;
    for (size_t i = 0; i < N_SIGMAS; i++)
        for (size_t k = 0; k < N_DISTANCES; k++) {
            float u[TED4_LANES], s[TED4_LANES], bits[TED4_LANES], d_u[TED4_LANES], d_s[TED4_LANES];

            for (int j = 0; j < TED4_LANES; j++) {
                u[j] = j % 2 ? -distances[k] : distances[k];
                s[j] = log_sigmas[i];
            }
            ted4_rate_row(u, s, bits, d_u, d_s);
            all_finite(bits, TED4_LANES, "bits");
            all_finite(d_u, TED4_LANES, "slope by k");
            all_finite(d_s, TED4_LANES, "slope by s");

            const double sigma = fmin(fmax((double)s[0], REF_S_MIN), REF_S_MAX),
                         a = fmin((double)distances[k], 1e9);
            const double w = fmin(6 * exp2(sigma), 4095) + 2, h = 1e-5 * exp2(sigma);

            if (!close_to((double)bits[0], ref_bits(a, sigma), 2e-6, 3e-5))
                fail_msg("distance %g, log2 sigma %g: %g bits, not %g", a, sigma, (double)bits[0],
                         ref_bits(a, sigma));
            assert_true(bits[0] > 0);
            assert_true(bits[0] == bits[1]);
            assert_true(d_s[0] == d_s[1]);
            assert_true((a <= 0 || d_u[0] == -d_u[1]));
            if (fabs(a - w) < 0.01 || a < 2 * h || a > 1e8)
                continue; /* kinks, and where a step is lost in a's rounding */
            const double du = (ref_bits(a + h, sigma) - ref_bits(a - h, sigma)) / (2 * h);

            if (!close_to((double)d_u[0], du, 5e-4, 5e-5 / exp2(sigma)))
                fail_msg("distance %g, log2 sigma %g: slope %g, not %g", a, sigma, (double)d_u[0],
                         du);
        }
}

/* The coder at the same limits: every sigma index, means at the limits of what networks give,
 * symbols at both ends of their range. Slots are never empty, escapes have at most their number of
 * bits, and decoding returns the symbol. */
static void test_coder(void **state)
{
    static const int32_t mu[] = {
        0, 1, -1, 255, -256, 32767 * 256, -32767 * 256, (1 << 23) - 1, -(1 << 23) + 1
    };
    static const int32_t symbol[] = { 0, 1, -1, 4095, -4096, 32766, 32767, -32767 };

    (void)state;
    for (unsigned g = 0; g < TED4_N_SIGMA; g++)
        for (size_t m = 0; m < sizeof mu / sizeof *mu; m++)
            for (size_t k = 0; k < sizeof symbol / sizeof *symbol; k++) {
                const ted4_gauss_symbol s = ted4_gauss_of(mu[m], g, symbol[k]);
                const int32_t whole = ted4_floor_shift(mu[m], TED4_MU_BITS),
                              fr = mu[m] - whole * 256;
                ted4_slots found;

                assert_true(s.slots.freq > 0);
                assert_true(s.slots.start + s.slots.freq <= 65536);
                assert_true(s.escape >= -1);
                assert_true(s.escape < 1 << TED4_ESCAPE_BITS);
                const uint32_t j = ted4_gauss_find(g, fr, s.slots.start + s.slots.freq - 1, &found);

                assert_int_equal(found.start, s.slots.start);
                assert_int_equal(found.freq, s.slots.freq);
                assert_int_equal(symbol[k],
                                 whole + (s.escape < 0 ? ted4_gauss_offset(g, j)
                                                       : ted4_gauss_escaped(g, j, s.escape)));
            }
}

/* ---- the quantiser ---- */

/* Values from zero to beyond every symbol, with steps from the smallest to the largest of the
 * format: rounding gives the nearest multiple within +-32767 steps, noise changes a value by less
 * than half a step, and a_f is never before a_s. */
static void test_quantiser(void **state)
{
    static const float value[] = { 0, -0.0f, 1e-45f, FLT_MIN, 0x1p-24f, 0.5f,
                                   1, 65504, -65504, 1e9f,    -1e30f,   1e31f };
    static const float step[] = { 1e-6f, 0x1p-14f, 0.01f, 1, 65504 };
    static ref_world w;
    const ted4_header h = ref_header();

    (void)state;
    ref_world_make(&w, &h);
    const ted4_layout *l = &w.layout;
    const size_t size = (size_t)l->n_channels * TED4_LANES,
                 n = (size_t)l->offset_logit * TED4_LANES;
    float *out = ref_floats(size), *residual = ref_floats(size);

    for (size_t i = 0; i < sizeof value / sizeof *value; i++)
        for (size_t k = 0; k < sizeof step / sizeof *step; k++)
            for (int quant = TED4_QUANT_NOISE; quant <= TED4_QUANT_ROUND; quant++) {
                const double x = (double)value[i], q = (double)step[k],
                             symbol = fmin(fmax(rint(x / q), -32767), 32767);

                for (size_t j = 0; j < n; j++)
                    w.attr[0][j] = value[i];
                for (size_t j = 0; j < TED4_TYPES * TED4_LANES; j++)
                    w.steps[0][j] = step[k];
                ted4_quantise(l, (ted4_quant)quant, w.attr[0], w.steps[0], 3, 9, out);
                ted4_residuals(l, (ted4_quant)quant, w.attr[0], w.steps[0], 3, 9, residual);
                all_finite(out, n, "quantised value");
                all_finite(residual, n, "residual");
                for (size_t j = 0; j < (size_t)l->first[TED4_TAU] * TED4_LANES; j++) {
                    const double k_of = x / q + (double)residual[j];

                    if (quant == TED4_QUANT_ROUND) {
                        assert_true(close_to((double)out[j], symbol * q, 1e-6,
                                             fabs(x / q - rint(x / q)) > 0.499 ? q : 0));
                        assert_true(close_to(k_of, symbol, 1e-6,
                                             1e-6 * (fabs(x / q) + 1) +
                                                 (fabs(x / q - rint(x / q)) > 0.499)));
                    } else {
                        assert_true(fabs((double)out[j] - x) <= 0.5 * q + 1e-6 * fabs(x));
                        assert_true(fabs((double)residual[j]) < 0.5);
                    }
                }
                for (size_t j = 0; j < TED4_LANES; j++)
                    assert_true(out[(size_t)l->first[TED4_TAU] * TED4_LANES + j] <=
                                out[((size_t)l->first[TED4_TAU] + 2) * TED4_LANES + j]);
            }
    free(out);
    free(residual);
    ref_world_finish(&w);
}

/* ---- the whole model ---- */

static void run(ref_world *w, double *bits)
{
    assert_int_equal(ref_run(w, NULL, bits), 0);
    for (int t = 0; t < TED4_TYPES; t++) {
        assert_true(isfinite(bits[t]));
        assert_true(bits[t] >= 0);
    }
    for (int i = 0; i < REF_BLOCKS; i++) {
        all_finite(w->d_attr[i], (size_t)w->layout.n_channels * TED4_LANES,
                   "gradient of an anchor");
        all_finite(w->steps[i], TED4_TYPES * TED4_LANES, "step");
    }
    all_finite(w->d_net, w->layout.n_net, "gradient of a network");
}

/* Compares the bits with those of the double model, within the precision that binary32 has for k
 * where x / q is large. */
static void compare(ref_world *w, const double *bits, double relative)
{
    const ref_model m = ref_model_make(w);
    double want[TED4_TYPES] = { 0 };
    float *noise = ref_floats((size_t)w->layout.n_channels * TED4_LANES);

    for (int i = 0; i < REF_BLOCKS; i++) {
        ref_noise(w, i, noise);
        for (int j = 0; j < TED4_LANES; j++) {
            ref_anchor a;
            ref_result r;

            ref_anchor_make(w, &m, i, j, noise, &a);
            ref_evaluate(&m, &a, NULL, &r);
            for (int t = 0; t < TED4_TYPES; t++)
                want[t] += r.bits[t];
        }
    }
    for (int t = 0; t < TED4_TYPES; t++)
        if (!close_to(bits[t], want[t], relative, 1e-2))
            fail_msg("type %d: %g bits, not %g", t, bits[t], want[t]);
    free(noise);
}

/* Values at FP16's limits: bits grow with the logarithm of the distance, gradients shrink with
 * it. */
static void test_values(void **state)
{
    static const float value[] = { 0, -0.0f, 0x1p-24f, 0x1p-14f, 1, 65504, -65504, 1e9f };

    (void)state;
    for (size_t i = 0; i < sizeof value / sizeof *value; i++)
        for (int quant = TED4_QUANT_NOISE; quant <= TED4_QUANT_ROUND; quant++) {
            static ref_world w;
            const ted4_header h = ref_header();
            double bits[TED4_TYPES];

            ref_world_make(&w, &h);
            w.in.quant = (ted4_quant)quant;
            for (int s = 0; s < REF_BLOCKS; s++)
                for (int c = 0; c < w.layout.offset_logit; c++)
                    for (int j = 0; j < TED4_LANES; j++)
                        w.attr[s][c * TED4_LANES + j] = value[i];
            run(&w, bits);
            /* The model clamps rounded symbols to their range and distances to 1e9; the reference
             * does neither. */
            if (quant == TED4_QUANT_NOISE && value[i] < 1e8f)
                compare(&w, bits, 1e-4);
            ref_world_finish(&w);
        }
}

/* Every output of the hyperprior at a limit: sigmas and steps at their smallest and largest, means
 * beyond every symbol. */
static void test_outputs(void **state)
{
    static const float out[] = { -65504, -200, -4, 0, 3.96875f, 10.9375f, 200, 65504 };

    (void)state;
    for (size_t i = 0; i < sizeof out / sizeof *out; i++)
        for (int which = 0; which < 3; which++) {
            static ref_world w;
            const ted4_header h = ref_header();
            double bits[TED4_TYPES];

            ref_world_make(&w, &h);
            const ted4_shape *s = &w.layout.shape;

            for (unsigned t = 0; t < TED4_TYPES; t++)
                for (unsigned c = 0; c < s->dim[t]; c++) {
                    if (which == 0)
                        *ref_bias(&w, s->first_output[t] + c) = out[i];
                    if (which == 1)
                        *ref_bias(&w, s->first_output[t] + s->dim[t] + c) = out[i];
                    if (which == 2)
                        *ref_bias(&w, s->first_step_output + t) = out[i];
                }
            run(&w, bits);
            compare(&w, bits, 1e-4);
            ref_world_finish(&w);
        }
}

/* All weights at FP16's largest and smallest, of either sign: sums stay within binary32. */
static void test_weights(void **state)
{
    static const float size[] = { 0, 0x1p-24f, 0x1p-14f, 65504 };

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        static ref_world w;
        const ted4_header h = ref_header();
        double bits[TED4_TYPES];

        ref_world_make(&w, &h);
        for (size_t k = w.layout.nete; k < w.layout.n_net; k++)
            w.net[k] = w.net[k] < 0 ? -size[i] : size[i];
        run(&w, bits);
        if (size[i] < 1)
            compare(&w, bits, 1e-5);
        ref_world_finish(&w);
    }
}

/* Weights of bits and gradients of rendered values from zero to huge. */
static void test_gradient_sizes(void **state)
{
    static const float factor[] = { 0, 1e-45f, 0x1p-100f, 1, 0x1p60f, 0x1p90f };

    (void)state;
    for (size_t i = 0; i < sizeof factor / sizeof *factor; i++) {
        static ref_world w;
        const ted4_header h = ref_header();
        double bits[TED4_TYPES];

        ref_world_make(&w, &h);
        w.in.bit_weight = factor[i];
        for (int s = 0; s < REF_BLOCKS; s++)
            for (int k = 0; k < w.layout.offset_logit * TED4_LANES; k++)
                w.d_value[s][k] *= factor[i];
        run(&w, bits);
        if (factor[i] == 0)
            for (size_t k = 0; k < w.layout.n_net; k++)
                assert_true(w.d_net[k] == 0);
        ref_world_finish(&w);
    }
}

/* ---- integer networks, as in the decoder ---- */

/* Integer networks with all weights at the limits that their shifts allow, and values at FP16's
 * limits: steps, means and sigmas stay within the tables. A value beyond the last symbol counts as
 * that symbol, also in the contexts of others. */
static void test_integer(void **state)
{
    static const float value[] = { 0, 0x1p-24f, 1, 65504, 5e5f, -65504, -5e5f, 1e9f };
    double before[2] = { 0 }; /* bits of features at the last symbol, for comparison */

    (void)state;
    for (size_t i = 0; i < sizeof value / sizeof *value; i++)
        for (int rail = 0; rail < 2; rail++) {
            static ref_world w;
            ted4_header h = ref_header();
            double bits[TED4_TYPES];

            h.step[TED4_FEATURE] = 0.01f;
            ref_source = random_seed(5); /* the same networks for every value */
            ref_world_make(&w, &h);
            uint8_t *shift = calloc(w.layout.shape.n_units, 1);

            assert_non_null(shift);
            for (size_t k = 0; k < w.layout.shape.n_units; k++)
                shift[k] = rail ? 5 : 8;
            for (size_t k = w.layout.nete; k < w.layout.n_net; k++) {
                const float x = rail ? (w.net[k] < 0 ? -100.0f : 100.0f) : w.net[k];

                w.net[k] = rintf(x * 256.0f) / 256.0f + 0.0f; /* no -0 */
            }
            for (int s = 0; s < REF_BLOCKS; s++)
                for (int k = 0; k < w.layout.offset_logit * TED4_LANES; k++)
                    w.attr[s][k] = k % 3 == 1 ? -value[i] : value[i];
            for (int s = 0; s < REF_BLOCKS; s++)
                for (int k = 0; k < 3 * TED4_LANES; k++)
                    w.position[s][k] = k % 4 == 0   ? 1
                                       : k % 4 == 1 ? -1
                                       : k % 4 == 2 ? 0x1p-24f
                                                    : -0x1p-24f;
            w.in.quant = TED4_QUANT_INTEGER;
            w.in.shift = shift;
            run(&w, bits);
            for (int s = 0; s < REF_BLOCKS; s++)
                for (int t = 0; t < TED4_TYPES; t++)
                    for (int j = 0; j < TED4_LANES; j++) {
                        const double q = (double)w.steps[s][t * TED4_LANES + j] / (double)h.step[t];

                        assert_true(q >= exp2(REF_V_MIN) * 0.999999);
                        assert_true(q <= exp2(REF_V_MAX) * 1.000001);
                    }
            if (fabs((double)value[i]) == 5e5 &&
                !close_to(bits[TED4_FEATURE], before[rail], 1e-3, 0))
                fail_msg("%g: %g bits, not %g", (double)value[i], bits[TED4_FEATURE], before[rail]);
            before[rail] = bits[TED4_FEATURE];
            free(shift);
            ref_world_finish(&w);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_symbols),        cmocka_unit_test(test_coder),
        cmocka_unit_test(test_quantiser),      cmocka_unit_test(test_values),
        cmocka_unit_test(test_outputs),        cmocka_unit_test(test_weights),
        cmocka_unit_test(test_gradient_sizes), cmocka_unit_test(test_integer),
    };

    return cmocka_run_group_tests_name("rate at extreme values", tests, NULL, NULL);
}
