/* test_rate_row.c - train/rate/rate_row.c: bits and derivatives of single symbols against double
 * arithmetic and against the coder's own tables (spec 9.4), and the tails (annex D.1: outliers need
 * a gradient).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "norm/gaussian.h"
#include "rate_ref.h"
#include "train/rate/rate_parts.h"

typedef struct {
    float u[TED4_LANES], s[TED4_LANES];
    float bits[TED4_LANES], d_u[TED4_LANES], d_s[TED4_LANES];
} row;

static void run_row(row *r)
{
    ted4_rate_row(r->u, r->s, r->bits, r->d_u, r->d_s);
}

static int close_to(double got, double want, double relative, double absolute)
{
    return fabs(got - want) <= absolute + relative * fabs(want);
}

/* Bits agree to 2e-5 for every sigma and distance; derivatives to 1e-4 of their size. */
static void test_row_values(void **state)
{
    (void)state;
    for (int i = 0; i <= 160; i++) {
        row r;

        for (int j = 0; j < TED4_LANES; j++) {
            const double s = -4.0 + 15.0 * i / 160.0;
            const double span = j < 16 ? 1.0 + exp2(s) : 12.0 * exp2(s) + 30.0;

            r.s[j] = (float)fmin(s, REF_S_MAX);
            r.u[j] = (float)(span * ref_uniform());
        }
        run_row(&r);
        for (int j = 0; j < TED4_LANES; j++) {
            const double u = (double)r.u[j], s = (double)r.s[j];
            const double hu = 1e-5 * exp2(s), hs = 1e-5;
            const double du = (ref_bits(u + hu, s) - ref_bits(u - hu, s)) / (2 * hu);
            const double ds = (ref_bits(u, s + hs) - ref_bits(u, s - hs)) / (2 * hs);

            assert_true(close_to((double)r.bits[j], ref_bits(u, s), 2e-6, 2e-5));
            if (fabs(fabs(u) - fmin(6.0 * exp2(s), 4095.0) - 2.0) < 1e-2 ||
                fabs(s - log2(4095.0 / 6.0)) < 1e-3)
                continue; /* kinks of h and w */
            assert_true(close_to((double)r.d_u[j], du, 2e-4, 2e-5 / exp2(s)));
            assert_true(close_to((double)r.d_s[j], ds, 2e-4, 5e-5));
        }
    }
}

/* Trap 4 of annex D.1: at any distance, bits are finite and grow, and the gradient leads back, also
 * on the plateau at 16 bits. */
static void test_outliers_have_gradient(void **state)
{
    static const float distance[] = { 1.4f, 5.5f, 40.0f, 1e3f, 1e5f, 1e8f, 1e20f, 3e38f };

    (void)state;
    for (size_t i = 0; i < sizeof distance / sizeof *distance; i++) {
        row r;

        for (int j = 0; j < TED4_LANES; j++) {
            r.s[j] = -4.0f + 0.1f * (float)(j / 2);
            r.u[j] = (j % 2 ? -1.0f : 1.0f) * distance[i];
            if (distance[i] < 1e5f && i > 0)
                r.u[j] *= exp2f(r.s[j]) + 0.5f / distance[i]; /* sigmas, beyond the bin of 0 */
        }
        run_row(&r);
        for (int j = 0; j < TED4_LANES; j++) {
            assert_true(isfinite(r.bits[j]));
            assert_true(r.bits[j] > 0.0f);
            assert_true(isfinite(r.d_u[j]));
            assert_true(isfinite(r.d_s[j]));
            assert_true(j % 2 ? r.d_u[j] < 0.0f : r.d_u[j] > 0.0f);
            if (distance[i] < 1e5f)
                assert_true(r.d_s[j] < 0.0f); /* a wider sigma is cheaper */
            if (distance[i] == 1e8f)
                assert_true(close_to((double)r.bits[j], 17.0 + 2.0 * log2(1e8), 0.0, 1e-3));
        }
    }
}

/* Bits that the coder of spec 9.4 spends on k. */
static double coder_bits(int32_t mu, unsigned g, int32_t k)
{
    const ted4_gauss_symbol s = ted4_gauss_of(mu, g, k);
    double bits = 16.0 - log2((double)s.slots.freq);

    if (s.escape >= 0)
        bits += 2.0 * floor(log2((double)s.escape + 1.0)) + 1.0;
    return bits;
}

static double model_bits(int32_t mu, unsigned g, int32_t k)
{
    row r;

    for (int j = 0; j < TED4_LANES; j++) {
        r.u[j] = (float)k - (float)mu / 256.0f;
        r.s[j] = (float)((int)g - 64) / 16.0f;
    }
    run_row(&r);
    return (double)r.bits[0];
}

/* Where symbols are likely, the model agrees with the coder. At the lower limit of sigma and in
 * escapes it is within 3 bits, also beyond sigma 682, where the window is narrower than the
 * distribution, except for the few symbols at the window's edge, 4095.5 on one side and 4096.5 on
 * the other. */
static void test_row_is_the_coder(void **state)
{
    (void)state;
    for (unsigned g = 0; g < TED4_N_SIGMA; g += 3) {
        const double sigma = exp2(((double)g - 64.0) / 16.0);
        const int32_t mu = (int32_t)(2000.0 * ref_uniform());
        double coded = 0.0, modelled = 0.0;

        for (int32_t k = -200; k <= 200; k++) {
            const double spread = fmax(1.0, 6.5 * sigma / 200.0);
            const int32_t at = (int32_t)(mu / 256.0 + k * spread);
            const double z = (at - mu / 256.0) / sigma, a = coder_bits(mu, g, at);
            const double b = model_bits(mu, g, at);

            if (!(fabs(a - b) < (fabs(fabs(z * sigma) - 4096.0) < 2.0 ? 9.0 : 3.0)))
                fail_msg("sigma %g, z %g, symbol %d: %g bits, model %g", sigma, z, (int)at, a, b);
            coded += exp(-0.5 * z * z) * a;
            modelled += exp(-0.5 * z * z) * b;
        }
        assert_true(close_to(modelled, coded,
                             sigma < 16.0  ? 2e-4
                             : sigma < 1e3 ? 2e-3
                                           : 6e-3,
                             1e-4));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_values),
        cmocka_unit_test(test_outliers_have_gradient),
        cmocka_unit_test(test_row_is_the_coder),
    };

    return cmocka_run_group_tests_name("rate_row", tests, NULL, NULL);
}
