/* fz_net_int.c - one dense layer of Tier E: u8 in, u8 out, then for each unit its shift, bias and
 * weights, then inputs; beyond its end these are the worst ones for unit 0. Claims: the accumulator
 * rule (R-NET-006) agrees with 64-bit sums of the worst inputs; if it holds, the plain layer,
 * 64-bit summation in reverse order, columns in halves as two threads would compute them, and every
 * vector kernel of this machine give the same bits, and columns beyond the last are not touched.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "harness.h"
#include "base/level.h"
#include "kernel/int_kernel.h"

enum { BLOCK = TED4_PRIOR_BLOCK, MAX_IN = 70, MAX_OUT = 20, UNTOUCHED = 0x55 };

/* Storage of a layer, its inputs [in][64], and its outputs. */
typedef struct {
    ted4_int_layer l;
    _Alignas(64) int16_t w[MAX_OUT * (MAX_IN + 1)];
    int32_t b[MAX_OUT];
    uint8_t r[MAX_OUT];
    _Alignas(64) int16_t x[MAX_IN * BLOCK];
} layer;

typedef struct {
    _Alignas(64) int16_t hidden[MAX_OUT * BLOCK];
    _Alignas(64) int32_t last[MAX_OUT * BLOCK];
} outputs;

/* R-NET-006 in 64 bits, for inputs whose products all have the same sign. Returns whether the rule
 * holds. */
static int fits(const layer *n, unsigned o, int32_t amplitude)
{
    int64_t most = n->b[o] < 0 ? -(int64_t)n->b[o] : n->b[o];

    for (unsigned i = 0; i < n->l.in; i++) {
        const int64_t w = n->w[o * n->l.in_pad + i];

        most += (w < 0 ? -w : w) * amplitude;
    }
    if (n->r[o] > 0)
        most += (int64_t)1 << (n->r[o] - 1);
    return most <= INT32_MAX;
}

/* Reads a layer from the input. Its units are halved until the rule holds. */
static void take_layer(fuzz_source *in, layer *n)
{
    const ted4_unit_rule rule = { 0, 0, 32767 };

    memset(n, 0, sizeof *n);
    n->l.in = fuzz_u8(in) % (MAX_IN + 1);
    n->l.in_pad = n->l.in + n->l.in % 2;
    n->l.out = 1 + fuzz_u8(in) % MAX_OUT;
    n->l.w = n->w;
    n->l.b = n->b;
    n->l.r = n->r;
    for (unsigned o = 0; o < n->l.out; o++) {
        int16_t *w = n->w + o * n->l.in_pad;
        int64_t sum = 0;

        n->r[o] = fuzz_u8(in) % 25;
        n->b[o] = (int32_t)fuzz_u32(in);
        n->b[o] = n->b[o] == INT32_MIN ? 0 : n->b[o];
        for (unsigned i = 0; i < n->l.in; i++) {
            w[i] = (int16_t)fuzz_u16(in);
            w[i] = w[i] == INT16_MIN ? 0 : w[i];
            sum += w[i] < 0 ? -w[i] : w[i];
        }
        for (;;) {
            const int legal = ted4_accumulator_legal(&rule, n->r[o], sum, n->b[o]);

            fuzz_require(legal == fits(n, o, rule.amplitude), "the accumulator rule");
            if (legal)
                break;
            sum = 0;
            n->b[o] /= 2;
            for (unsigned i = 0; i < n->l.in; i++) {
                w[i] = (int16_t)(w[i] / 2);
                sum += w[i] < 0 ? -w[i] : w[i];
            }
        }
    }
}

/* Reads inputs of up to +-32767; beyond the input's end they are the worst ones for unit 0. */
static void take_inputs(fuzz_source *in, layer *n)
{
    for (unsigned i = 0; i < n->l.in; i++)
        for (unsigned a = 0; a < BLOCK; a++) {
            const int16_t worst = (n->w[i] < 0) == (a % 2 == 0) ? -32767 : 32767;

            n->x[i * BLOCK + a] = in->at < in->end ? (int16_t)ted4_sat16((int16_t)fuzz_u16(in))
                                                   : worst;
        }
}

/* The definition of 7.3 in 64 bits, summed in reverse order. */
static void define(const layer *n, outputs *y)
{
    for (unsigned o = 0; o < n->l.out; o++)
        for (unsigned a = 0; a < BLOCK; a++) {
            const int64_t unit = (int64_t)1 << n->r[o];
            int64_t acc = 0, v;

            for (unsigned i = n->l.in; i > 0; i--)
                acc += (int64_t)n->w[o * n->l.in_pad + i - 1] * n->x[(i - 1) * BLOCK + a];
            acc += n->b[o] + unit / 2;
            v = acc / unit - (acc % unit < 0);
            y->hidden[o * BLOCK + a] = (int16_t)(v < 0 ? 0 : v > 32767 ? 32767 : v);
            y->last[o * BLOCK + a] = (int32_t)(v < -TED4_OUTPUT_MAX  ? -TED4_OUTPUT_MAX
                                               : v > TED4_OUTPUT_MAX ? TED4_OUTPUT_MAX
                                                                     : v);
        }
}

static void compare(const layer *n, const ted4_int_dense *d, const outputs *right)
{
    static outputs y, half;
    const size_t units = n->l.out * (size_t)BLOCK;

    d->hidden(&n->l, n->x, BLOCK, y.hidden);
    d->last(&n->l, n->x, BLOCK, y.last);
    fuzz_require(memcmp(y.hidden, right->hidden, units * sizeof *y.hidden) == 0, "hidden layer");
    fuzz_require(memcmp(y.last, right->last, units * sizeof *y.last) == 0, "last layer");
    memset(&half, UNTOUCHED, sizeof half);
    d->hidden(&n->l, n->x + BLOCK / 2, BLOCK / 2, half.hidden);
    d->last(&n->l, n->x, BLOCK / 2, half.last);
    for (size_t i = 0; i < units; i++) {
        const int inside = i % BLOCK < BLOCK / 2;

        fuzz_require(half.last[i] == (inside ? right->last[i] : UNTOUCHED * 0x01010101),
                     "half of the last layer");
        fuzz_require(half.hidden[i] == (inside ? right->hidden[i + BLOCK / 2] : UNTOUCHED * 0x0101),
                     "half of the hidden layer");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static layer n;
    static outputs right;
    fuzz_source in = { data, data + size };

    take_layer(&in, &n);
    take_inputs(&in, &n);
    define(&n, &right);
    compare(&n, &ted4_int_dense_plain, &right);
#if defined(__x86_64__)
    if (ted4_level_of_machine() >= TED4_LEVEL_V3)
        compare(&n, &ted4_int_dense_avx2, &right);
    if (ted4_level_of_machine() >= TED4_LEVEL_V4)
        compare(&n, &ted4_int_dense_avx512, &right);
    if (ted4_level_of_machine() >= TED4_LEVEL_V4 && __builtin_cpu_supports("avx512vnni"))
        compare(&n, &ted4_int_dense_vnni, &right);
#elif defined(__AARCH64EL__)
    compare(&n, &ted4_int_dense_neon, &right);
#endif
    return 0;
}
