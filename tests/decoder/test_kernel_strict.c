/* test_kernel_strict.c - kernel/strict_dense.h: each variant that this machine can run gives the
 * bits of the plain layer, for odd and even shapes, with ordinary and special numbers. All NaNs are
 * considered equal, whatever their payload: R-REC-001 refuses all of them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "base/level.h"
#include "kernel/strict_dense.h"
#include "random_source.h"
#include "use_kernels.h"
#include "recon/strict.h"

enum { MAX = 131 };

static _Alignas(64) float x[MAX * TED4_ROW], want[MAX * TED4_ROW], got[(MAX + 1) * TED4_ROW];
static float w[MAX * MAX], b[MAX];
static random_source source = { 7 };

static float ordinary(void)
{
    return (float)(int32_t)random_u32(&source) * 0x1p-31f;
}

/* Returns mostly ordinary numbers; also zeros of both signs, subnormals, huge and non-finite
 * ones. */
static float special(void)
{
    static const uint32_t list[] = { 0,          0x80000000, 1,          0x80000001, 0x007fffff,
                                     0x00800000, 0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000,
                                     0x7fc00000, 0x3f800001, 0x33800000 };
    const uint32_t pick = random_u32(&source) >> 8;

    if (pick % 4 != 0)
        return ordinary();
    return ted4_bits_float(list[pick / 4 % (sizeof list / sizeof list[0])]);
}

/* Numbers of very different sizes, without NaN, whose sums depend on the order and on fused
 * operations. */
static float wide(void)
{
    return ldexpf(ordinary(), (int)(random_u32(&source) >> 8) % 40 - 20);
}

static void fill(float *v, size_t n, float (*number)(void))
{
    for (size_t i = 0; i < n; i++)
        v[i] = number();
}

static int same(float a, float c)
{
    return ted4_float_bits(a) == ted4_float_bits(c) || (a != a && c != c);
}

static void compare(ted4_strict_dense_fn twin, unsigned in, unsigned out, int relu)
{
    const ted4_strict_layer l = { in, out, w, b, relu };
    const size_t n = (size_t)out * TED4_ROW;

    ted4_strict_dense_plain(&l, x, want);
    for (size_t i = 0; i < n + TED4_ROW; i++)
        got[i] = 1234.0f;
    twin(&l, x, got);
    for (size_t i = 0; i < n; i++)
        assert_true(same(got[i], want[i]));
    for (size_t i = n; i < n + TED4_ROW; i++)
        assert_true(got[i] == 1234.0f);
}

static void twin_is_plain(ted4_strict_dense_fn twin)
{
    float (*const kinds[])(void) = { ordinary, special, wide };

    for (int kind = 0; kind < 3; kind++)
        for (unsigned out = 1; out < 36; out++) {
            const unsigned in = random_u32(&source) % 70;

            fill(w, (size_t)in * out, kinds[kind]);
            fill(b, out, kinds[kind]);
            fill(x, (size_t)in * TED4_ROW, kinds[kind]);
            compare(twin, in, out, 0);
            compare(twin, in, out, 1);
        }
    fill(w, (size_t)MAX * MAX, wide);
    compare(twin, MAX, MAX, 1);
}

/* The variants that a machine of this kind may have. */
typedef struct {
    ted4_level level;
    ted4_strict_dense_fn twin;
} variant;

#if defined(__x86_64__)
static variant avx2 = { TED4_LEVEL_V3, ted4_strict_dense_avx2 };
static variant avx512 = { TED4_LEVEL_V4, ted4_strict_dense_avx512 };
#elif defined(__AARCH64EL__)
static variant neon = { TED4_LEVEL_BASE, ted4_strict_dense_neon };
#endif

static void variant_is_plain(void **state)
{
    const variant *v = *state;

    if (v == NULL || v->level > ted4_level_of_machine()) {
        print_message("skipped: this machine does not have it\n");
        skip();
    }
    twin_is_plain(v->twin);
}

/* The definition: one lane, one input at a time, no vector code. */
static void plain_is_the_text(void **state)
{
    const ted4_strict_layer l = { 67, 9, w, b, 1 };

    (void)state;
    fill(w, 67 * 9, wide);
    fill(b, 9, wide);
    fill(x, 67 * TED4_ROW, wide);
    ted4_strict_dense_plain(&l, x, got);
    for (unsigned o = 0; o < 9; o++)
        for (unsigned j = 0; j < TED4_ROW; j++) {
            volatile float acc = b[o];

            for (unsigned i = 0; i < 67; i++) {
                volatile float product = w[o * 67 + i] * x[i * TED4_ROW + j];

                acc = acc + product;
            }
            assert_true(same(got[o * TED4_ROW + j], acc < 0 ? 0 : acc));
        }
}

static void environment_chooses(void **state)
{
    (void)state;
    use_kernels("plain");
    assert_null(ted4_select_strict_dense());
#if defined(__x86_64__)
    use_kernels("v1");
    assert_null(ted4_select_strict_dense());
    use_kernels("v3");
    assert_ptr_equal(ted4_select_strict_dense(),
                     (ted4_level_of_machine() >= TED4_LEVEL_V3 ? ted4_strict_dense_avx2 : NULL));
#endif
    use_kernels(NULL);
    if (ted4_level_wanted() >= TED4_LEVEL_V3)
        assert_non_null(ted4_select_strict_dense());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#if defined(__x86_64__)
        { "avx2_is_plain", variant_is_plain, NULL, NULL, &avx2 },
        { "avx512_is_plain", variant_is_plain, NULL, NULL, &avx512 },
#elif defined(__AARCH64EL__)
        { "neon_is_plain", variant_is_plain, NULL, NULL, &neon },
#else
        { "no_variant", variant_is_plain, NULL, NULL, NULL },
#endif
        cmocka_unit_test(plain_is_the_text),
        cmocka_unit_test(environment_chooses),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
