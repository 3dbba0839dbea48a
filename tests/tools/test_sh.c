/* test_sh.c - tool/sh.h: compares the basis with Legendre functions, and fits colours with known
 * coefficients. The programs' helpers are in no library, so the source is included here.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "random_source.h"
#include "tool/sh.h"

enum { N = 37 };

static random_source source = { 3 };

/* Colours computed from known coefficients. */
typedef struct {
    int degree, calls, fail_at;
    float sh[N * 3 * TED4_SH_MAX_COEFS];
} known;

static double known_colour(const known *s, size_t i, size_t c, const double d[3])
{
    double basis[TED4_SH_MAX_COEFS], v = 0.5;

    ted4_sh_basis(d, s->degree, basis);
    for (int k = 0; k < ted4_sh_count(s->degree); k++)
        v += basis[k] * (double)s->sh[(i * 3 + c) * (size_t)ted4_sh_count(s->degree) + (size_t)k];
    return v;
}

static int sample_known(void *user, const double d[3], float *const colour[3])
{
    known *const k = user;

    assert_true(fabs(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - 1.0) < 1e-12);
    if (k->calls++ == k->fail_at)
        return 5;
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < N; i++)
            colour[c][i] = (float)known_colour(k, i, c, d);
    return 0;
}

static void test_fit_exact(void **state)
{
    static float sh[N * 3 * TED4_SH_MAX_COEFS];

    (void)state;
    for (int degree = 0; degree <= 3; degree++) {
        known k = { .degree = degree, .fail_at = -1 };
        double rms;

        for (int i = 0; i < N * 3 * ted4_sh_count(degree); i++)
            k.sh[i] = random_float(&source, -0.6f, 0.6f);
        assert_int_equal(ted4_sh_fit(degree, N, sample_known, &k, sh, &rms), 0);
        assert_true(rms < 1e-5);
        for (int i = 0; i < N * 3 * ted4_sh_count(degree); i++)
            assert_true(fabsf(sh[i] - k.sh[i]) < 1e-5f);
        if (degree == 0)
            continue;
        assert_int_equal(ted4_sh_fit(degree - 1, N, sample_known, &k, sh, &rms), 0);
        assert_true(rms > 0.05); /* a degree that is too low cannot fit */
        k.calls = 0;
        k.fail_at = 70;
        assert_int_equal(ted4_sh_fit(degree, N, sample_known, &k, sh, &rms), 5);
    }
}

/* Associated Legendre function with the Condon-Shortley phase. */
static double legendre(int l, int m, double x)
{
    double below = 0.0, p = 1.0;

    for (int i = 1; i <= m; i++)
        p *= -(2.0 * i - 1.0) * sqrt(1.0 - x * x);
    for (int i = m; i < l; i++) {
        const double next = ((2.0 * i + 1.0) * x * p - (i + m) * below) / (i - m + 1.0);

        below = p;
        p = next;
    }
    return p;
}

static double harmonic(int l, int m, const double d[3])
{
    const double pi = 3.14159265358979323846, phi = atan2(d[1], d[0]);
    const int a = abs(m);
    const double scale =
        sqrt((2.0 * l + 1.0) / (4.0 * pi) * tgamma(l - a + 1.0) / tgamma(l + a + 1.0)) *
        legendre(l, a, d[2]);

    return m == 0 ? scale : sqrt(2.0) * scale * (m < 0 ? sin(a * phi) : cos(a * phi));
}

static void test_basis(void **state)
{
    double b[TED4_SH_MAX_COEFS], d[3];

    (void)state;
    for (int i = 0; i < 50; i++) {
        const double z = 0.98 - 0.039 * i, r = sqrt(1.0 - z * z);

        d[0] = r * cos(2.4 * i + 0.1);
        d[1] = r * sin(2.4 * i + 0.1);
        d[2] = z;
        ted4_sh_basis(d, 3, b);
        for (int l = 0, n = 0; l <= 3; l++)
            for (int m = -l; m <= l; m++, n++)
                assert_true(fabs(b[n] - harmonic(l, m, d)) < 1e-12);
    }
}

static void test_constant(void **state)
{
    static float block[3][N], sh[N * 3 * 4];
    const float *const colour[3] = { block[0], block[1], block[2] };

    (void)state;
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++)
            block[c][i] = random_float(&source, -0.6f, 0.6f);
    ted4_sh_constant(1, N, colour, sh);
    for (size_t i = 0; i < N; i++) {
        for (size_t c = 0; c < 3; c++) {
            assert_true(fabsf(0.5f + 0.28209479f * sh[(i * 3 + c) * 4] - block[c][i]) < 1e-6f);
            assert_true(sh[(i * 3 + c) * 4 + 1] == 0.0f);
            assert_true(sh[(i * 3 + c) * 4 + 3] == 0.0f);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fit_exact),
        cmocka_unit_test(test_basis),
        cmocka_unit_test(test_constant),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
