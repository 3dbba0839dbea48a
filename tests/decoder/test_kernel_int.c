/* test_kernel_int.c - kernel/int_dense_*.c give the bits of norm/int_dense.c, up to the limits of
 * what R-NET-006 allows.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "base/level.h"
#include "kernel/int_kernel.h"
#include "use_kernels.h"
#include "random_scene.h"

enum { BLOCK = TED4_PRIOR_BLOCK };

/* A layer whose weights use the full range of the accumulator: sum |W| 32767 + |B| + 2^(r-1) is
 * just below 2^31. */
static ted4_int_layer make(random_source *r, unsigned in, unsigned out)
{
    ted4_int_layer l = { in, in + in % 2, out, NULL, NULL, NULL };

    l.w = calloc((size_t)out * l.in_pad + 1, sizeof *l.w);
    l.b = calloc(out, sizeof *l.b);
    l.r = calloc(out, 1);
    for (unsigned o = 0; o < out; o++) {
        int64_t left = INT32_MAX;

        l.r[o] = (uint8_t)random_in(r, 0, 24);
        left -= l.r[o] > 0 ? (int64_t)1 << (l.r[o] - 1) : 0;
        for (unsigned i = 0; i < in; i++) {
            int64_t most = left / 32767;
            int32_t w;

            most = most > 32767 ? 32767 : most;
            if (i + 1 < in)
                most = most * 2 / (int64_t)(in - i) > 0 ? most * 2 / (int64_t)(in - i) : most;
            w = (int32_t)random_in(r, 0, (uint32_t)(most > 32767 ? 32767 : most));
            left -= (int64_t)w * 32767;
            l.w[(size_t)o * l.in_pad + i] = (int16_t)(random_in(r, 0, 1) ? w : -w);
        }
        l.b[o] = (int32_t)(random_in(r, 0, 1) ? left : -left);
        if (random_in(r, 0, 3) == 0)
            l.b[o] = 0;
    }
    return l;
}

static void drop(ted4_int_layer *l)
{
    free(l->w);
    free(l->b);
    free(l->r);
}

/* Inputs at the ends of their range, small ones, and those that make the sum of unit 0 as large as
 * possible. */
static void fill(random_source *r, const ted4_int_layer *l, int16_t *x)
{
    for (unsigned i = 0; i < l->in; i++)
        for (int a = 0; a < BLOCK; a++) {
            const int16_t rail = random_in(r, 0, 1) ? 32767 : -32767;

            x[i * BLOCK + a] = a % 3 == 0 ? rail : (int16_t)(random_normal(r) * 300);
            if (a == 1)
                x[i * BLOCK + a] = l->w[i] < 0 ? -32767 : 32767;
        }
}

static void compare(const ted4_int_dense *fast)
{
    random_source r = random_seed(11);
    static _Alignas(64) int16_t x[TED4_MAX_WIDTH * BLOCK];
    static _Alignas(64) int16_t h[2][TED4_MAX_WIDTH * BLOCK];
    static _Alignas(64) int32_t y[2][TED4_MAX_WIDTH * BLOCK];

    for (int n = 0; n < 400; n++) {
        const unsigned in = n < 20 ? (unsigned)n : random_in(&r, 1, 130);
        const unsigned out = n < 20 ? random_in(&r, 1, 20) : random_in(&r, 1, 130);
        const size_t columns = n % 2 ? 32 : 64;
        ted4_int_layer l =
            make(&r, n == 399 ? TED4_MAX_WIDTH : in, n == 399 ? TED4_MAX_WIDTH : out);

        fill(&r, &l, x);
        memset(h, 0x55, sizeof h);
        memset(y, 0x55, sizeof y);
        ted4_int_dense_plain.hidden(&l, x, columns, h[0]);
        fast->hidden(&l, x, columns, h[1]);
        assert_memory_equal(h[0], h[1], sizeof h[0]);
        ted4_int_dense_plain.last(&l, x, columns, y[0]);
        fast->last(&l, x, columns, y[1]);
        assert_memory_equal(y[0], y[1], sizeof y[0]);
        drop(&l);
    }
}

static void selected(void **state)
{
    (void)state;
    compare(ted4_select_int_dense());
}

/* The variant of a test, or NULL if this machine does not have it. */
static void variant(void **state)
{
    if (*state == NULL) {
        print_message("skipped: this machine does not have it\n");
        skip();
    }
    compare(*state);
}

static void selected_by_name(void **state)
{
    (void)state;
    use_kernels("plain");
    assert_ptr_equal(ted4_select_int_dense(), &ted4_int_dense_plain);
#if defined(__x86_64__)
    use_kernels("v1");
    assert_ptr_equal(ted4_select_int_dense(), &ted4_int_dense_plain);
    use_kernels("v3");
    assert_ptr_equal(ted4_select_int_dense(), ted4_level_of_machine() >= TED4_LEVEL_V3
                                                  ? &ted4_int_dense_avx2
                                                  : &ted4_int_dense_plain);
#endif
    use_kernels(NULL);
}

/* The state of a test: the variant, or NULL if the machine does not have it. */
static void *of(const ted4_int_dense *v, int has)
{
    return has ? (void *)(uintptr_t)v : NULL;
}

int main(void)
{
    const ted4_level machine = ted4_level_of_machine();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(selected),
#if defined(__x86_64__)
        { "avx2", variant, NULL, NULL, of(&ted4_int_dense_avx2, machine >= TED4_LEVEL_V3) },
        { "avx512", variant, NULL, NULL, of(&ted4_int_dense_avx512, machine >= TED4_LEVEL_V4) },
        { "vnni", variant, NULL, NULL,
          of(&ted4_int_dense_vnni,
             machine >= TED4_LEVEL_V4 && __builtin_cpu_supports("avx512vnni")) },
#elif defined(__AARCH64EL__)
        { "neon", variant, NULL, NULL, of(&ted4_int_dense_neon, machine >= TED4_LEVEL_BASE) },
#endif
        cmocka_unit_test(selected_by_name),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
