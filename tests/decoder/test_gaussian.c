/* test_gaussian.c - norm/gaussian.h: the cumulative frequencies of every model, and the search for
 * the symbol of a slot (spec 9.4).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "norm/gaussian.h"
#include "random_scene.h"

/* Replaces assert_int_equal, which is too slow for millions of calls. */
static void check(int holds)
{
    if (!holds)
        fail();
}

/* Every sigma index with every fraction of mu. */
static void increasing(void **state)
{
    (void)state;
    for (unsigned g = 0; g < TED4_N_SIGMA; g++) {
        const uint32_t size = ted4_gauss_size(g);

        for (int32_t fr = 0; fr < 256; fr++) {
            uint32_t before = 0;

            for (uint32_t j = 1; j < size; j++) {
                const uint32_t c = ted4_gauss_inner(g, fr, j);
                const int64_t d = 256 * ((int64_t)j - 1 - ted4_half[g]) - 128 - fr;

                check(c > before);
                check(d * ted4_inv[g] < (int64_t)1 << 31 && d * ted4_inv[g] > -((int64_t)1 << 31));
                before = c;
            }
            check(before < 65536);
            check(ted4_gauss_cum(g, fr, 0) == 0);
            check(ted4_gauss_cum(g, fr, size) == 65536);
        }
    }
}

/* Compares with the distribution whose sigma is that of INV, which is rounded: the error of all
 * steps of the integer path together is less than four slots (z alone: 1.6). */
static void accurate(void **state)
{
    (void)state;
    for (unsigned g = 0; g < TED4_N_SIGMA; g += 3) {
        const double sigma = 131072.0 / ted4_inv[g];
        const uint32_t size = ted4_gauss_size(g);

        check(fabs(sigma / exp2((g - 64.0) / 16) - 1) < 0.008);
        for (int32_t fr = 0; fr < 256; fr += 51)
            for (uint32_t j = 1; j < size; j++) {
                const double x = (double)j - 1 - ted4_half[g] - 0.5 - fr / 256.0;
                const double p = erfc(-x / sigma / sqrt(2)) / 2;
                const double c = p * (65536 - size) + j;

                check(fabs(ted4_gauss_cum(g, fr, j) - c) < 4);
            }
    }
}

static void find_is_inverse(void **state)
{
    static const int32_t fractions[] = { 0, 1, 127, 128, 200, 255 };

    (void)state;
    for (unsigned g = 0; g < TED4_N_SIGMA; g++)
        for (size_t f = 0; f < sizeof fractions / sizeof *fractions; f++)
            for (uint32_t j = 0; j < ted4_gauss_size(g); j++) {
                const int32_t fr = fractions[f];
                const uint32_t from = ted4_gauss_cum(g, fr, j);
                const uint32_t to = ted4_gauss_cum(g, fr, j + 1);
                ted4_slots s;

                check(ted4_gauss_find(g, fr, from, &s) == j);
                check(s.start == from && s.freq == to - from);
                check(ted4_gauss_find(g, fr, to - 1, &s) == j);
                check(s.start == from && s.freq == to - from);
            }
}

/* Converts k to symbol and escape, and back. */
static void symbols(void **state)
{
    random_source r = random_seed(2);

    (void)state;
    for (int n = 0; n < 1000000; n++) {
        const unsigned g = random_in(&r, 0, TED4_N_SIGMA - 1);
        const int32_t mu = (int32_t)random_u32(&r) >> random_in(&r, 4, 31);
        const int32_t m = (int32_t)floor(mu / 256.0);
        const int32_t near = m + (int32_t)random_in(&r, 0, 9000) - 4500;
        const int32_t k = n % 2 ? near : (int32_t)random_in(&r, 0, 65534) - 32767;
        const ted4_gauss_symbol s = ted4_gauss_of(mu, g, k);
        ted4_slots slots;
        const uint32_t j = ted4_gauss_find(g, mu - 256 * m, s.slots.start, &slots);

        check(slots.freq == s.slots.freq && slots.start == s.slots.start);
        check((j == 0 || j == ted4_gauss_size(g) - 1) == (s.escape >= 0));
        check(k ==
              m + (s.escape >= 0 ? ted4_gauss_escaped(g, j, s.escape) : ted4_gauss_offset(g, j)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(increasing),
        cmocka_unit_test(accurate),
        cmocka_unit_test(find_is_inverse),
        cmocka_unit_test(symbols),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
