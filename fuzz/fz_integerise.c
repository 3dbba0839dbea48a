/* fz_integerise.c - weights of Tier E from binary32 to integers: u8 shapes and finest shift, then
 * shifts and values of all units. Claims: ted4_rne_scaled() rounds the exact rational to nearest
 * even; ted4_prior_load() gives the same verdict and the same place of the failure as the rules
 * R-NET-002 to R-NET-006, applied in that order with exact numbers; values returned by ted4_snap()
 * for any input are accepted, and evaluate to the same bounded numbers with the plain layers and
 * with this machine's; profile Compact can code them as integers (spec 7.6), which are read back.
 * ted4_positions_sort() gives the order of chapter 8, the first of equal positions.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>
#include "base/bytes.h"
#include "harness.h"
#include "kernel/int_kernel.h"
#include "norm/prior.h"
#include "read/reader.h"
#include "write/coder_write.h"
#include "write/snap.h"

enum { MAX_VALUES = 4096 };

typedef struct {
    ted4_header h;
    ted4_shape shape;
    float value[MAX_VALUES];
    uint8_t shift[MAX_VALUES];
} nets;

/* A long double holds a binary32 times a power of two exactly, and rintl() rounds to nearest
 * even. */
static int64_t exact(uint32_t bits, int e)
{
    const long double v = ldexpl((long double)ted4_bits_float(bits), e);
    const long double most = 0x1p62L;

    return v > most ? (int64_t)1 << 62 : v < -most ? -((int64_t)1 << 62) : (int64_t)rintl(v);
}

static void check_rounding(fuzz_source *in)
{
    const uint32_t bits = fuzz_u32(in);
    const int e = (int)fuzz_in(in, 0, 72) - 36;
    const int64_t most = (int64_t)1 << 62;
    int64_t is;

    if (!ted4_float_legal(bits))
        return;
    is = ted4_rne_scaled(bits, e);
    /* Beyond 2^62 any result is right that exceeds every bound. */
    fuzz_require(is == exact(bits, e) || (is >= most && exact(bits, e) >= most) ||
                     (is <= -most && exact(bits, e) <= -most),
                 "rounding");
}

static int take_nets(fuzz_source *in, nets *n)
{
    ted4_header *h = &n->h;

    memset(n, 0, sizeof *n);
    h->n_anchors = 1;
    h->tile_size = 64;
    h->n_offsets = 1;
    h->n_slices = (uint8_t)fuzz_in(in, 1, 3);
    for (unsigned i = 0; i < h->n_slices; i++)
        h->feature_dim = (uint8_t)(h->feature_dim + (h->slice[i] = (uint8_t)fuzz_in(in, 1, 2)));
    h->ar_width = h->n_slices > 1 ? 2 : 0;
    h->prior = fuzz_u8(in) & 1;
    h->hyper_layers = h->prior == TED4_PRIOR_INR ? (uint8_t)fuzz_in(in, 0, 2) : 0;
    h->hyper_width = h->hyper_layers > 0 ? 3 : 0;
    h->context_bits = (uint8_t)fuzz_in(in, 0, 12);
    h->pe_octaves = h->prior == TED4_PRIOR_INR ? (uint8_t)fuzz_in(in, 0, 3) : 0;
    ted4_shape_make(&n->shape, h);
    return n->shape.n_nete <= MAX_VALUES && n->shape.n_units <= MAX_VALUES;
}

/* Shifts out of range and values of any bit pattern must occur, but not always. */
static void take_values(fuzz_source *in, nets *n)
{
    const int wild = fuzz_u8(in);

    for (size_t i = 0; i < n->shape.n_units; i++)
        n->shift[i] = wild % 4 == 0 ? fuzz_u8(in) : (uint8_t)(fuzz_u8(in) % 16 + 2);
    for (size_t i = 0; i < n->shape.n_nete; i++) {
        const uint32_t bits = fuzz_u32(in);

        n->value[i] = wild & 4 ? ted4_bits_float(bits) : (float)((int32_t)bits >> 8) / 65536.0f;
    }
}

/* Checks R-NET-003 and R-NET-005 for all units of a network. Returns SIZE_MAX if they hold, else
 * the index of the first unit that breaks one of them. */
static size_t bad_shift(const nets *n, const ted4_net_shape *s, int hyper)
{
    size_t at = s->first_unit;

    for (unsigned i = 0; i < s->n_layers; i++) {
        const int f = i > 0   ? 10
                      : hyper ? 12
                              : n->h.context_bits,
                  g = i + 1u < s->n_layers ? 10 : 8;

        for (unsigned o = 0; o < s->dim[i + 1]; o++, at++)
            if (n->shift[at] > 20 || n->shift[at] + f - g < 0)
                return at;
    }
    return SIZE_MAX;
}

/* Returns the first value of a layer that breaks one of R-NET-002, R-NET-004 and R-NET-006, in the
 * order in which a decoder meets them. */
static int bad_layer(const nets *n, unsigned in, unsigned out, const uint8_t *shift, size_t at,
                     int f, int g, int64_t amplitude, ted4_error *e)
{
    const size_t bias = at + (size_t)in * out;

    for (size_t i = 0; i < (size_t)in * out; i++) {
        const uint32_t bits = ted4_float_bits(n->value[at + i]);

        if (!ted4_float_legal(bits))
            ted4_fail(e, TED4_E_NET_VALUE, at + i);
        else if (fabsl((long double)exact(bits, shift[i / in])) > 32767)
            ted4_fail(e, TED4_E_NET_WEIGHT_RANGE, at + i);
    }
    for (unsigned o = 0; o < out; o++) {
        const int r = shift[o] + f - g;
        const uint32_t bits = ted4_float_bits(n->value[bias + o]);
        int64_t most = r > 0 ? (int64_t)1 << (r - 1) : 0;

        if (!ted4_float_legal(bits))
            ted4_fail(e, TED4_E_NET_VALUE, bias + o);
        if (e->code != TED4_OK)
            return 1;
        for (unsigned i = 0; i < in; i++) {
            const int64_t w = exact(ted4_float_bits(n->value[at + (size_t)o * in + i]), shift[o]);

            most += (int64_t)(w < 0 ? -w : w) * amplitude;
        }
        const int64_t b = exact(bits, shift[o] + f);

        if (most + (b < 0 ? -b : b) > INT32_MAX)
            ted4_fail(e, TED4_E_NET_ACCUMULATOR, bias + o);
    }
    return e->code != TED4_OK;
}

static void bad_value(const nets *n, const ted4_net_shape *s, int hyper, ted4_error *e)
{
    size_t at = s->first, unit = s->first_unit;

    for (unsigned i = 0; i < s->n_layers; i++) {
        const int f = i > 0   ? 10
                      : hyper ? 12
                              : n->h.context_bits,
                  g = i + 1u < s->n_layers ? 10 : 8;
        const unsigned in = s->dim[i], out = s->dim[i + 1];

        if (bad_layer(n, in, out, n->shift + unit, at, f, g, i == 0 && hyper ? 4096 : 32767, e))
            return;
        at += ((size_t)in + 1) * out;
        unit += out;
    }
}

static ted4_error expected(const nets *n)
{
    ted4_error e = { TED4_OK, 0 };

    for (unsigned m = 0; m < n->h.n_slices; m++) {
        const ted4_net_shape *s = m == 0 ? &n->shape.hyper : &n->shape.slice[m];
        const size_t at = bad_shift(n, s, m == 0);

        if (at != SIZE_MAX)
            ted4_fail(&e, TED4_E_NET_SHIFT, at);
    }
    for (unsigned m = 0; m < n->h.n_slices && e.code == TED4_OK; m++)
        bad_value(n, m == 0 ? &n->shape.hyper : &n->shape.slice[m], m == 0, &e);
    return e;
}

/* Evaluates loaded networks on positions and contexts of the input. */
static void evaluate(fuzz_source *in, const nets *n, ted4_prior *prior)
{
    enum { ANCHORS = 5, MOST = 64 };
    static _Alignas(64) int16_t ctx[MOST * TED4_PRIOR_BLOCK];
    static _Alignas(64) int32_t out[2][MOST * TED4_PRIOR_BLOCK];
    uint16_t position[3 * ANCHORS];

    for (size_t i = 0; i < 3 * ANCHORS; i++)
        position[i] = (uint16_t)fuzz_in(in, 0, 0x3c00);
    for (size_t i = 0; i < MOST * TED4_PRIOR_BLOCK; i++)
        ctx[i] = in->at < in->end ? (int16_t)ted4_sat16((int16_t)fuzz_u16(in)) : 32767;
    for (unsigned m = 0; m < n->h.n_slices; m++) {
        const unsigned outputs = m == 0 ? n->shape.n_outputs : 2u * n->h.slice[m];

        for (int fast = 0; fast < 2; fast++) {
            prior->dense = fast ? ted4_select_int_dense() : &ted4_int_dense_plain;
            if (m == 0)
                ted4_prior_hyper(prior, position, ANCHORS, out[fast]);
            else
                ted4_prior_slice(prior, m, ctx, ANCHORS, out[fast]);
        }
        for (unsigned i = 0; i < outputs * TED4_PRIOR_BLOCK; i++)
            if (i % TED4_PRIOR_BLOCK < ANCHORS)
                fuzz_require(out[0][i] == out[1][i] && out[0][i] >= -TED4_OUTPUT_MAX &&
                                 out[0][i] <= TED4_OUTPUT_MAX,
                             "outputs");
    }
}

/* The substream has at least a bit a value (R-ENT-016). */
static void in_compact(nets *n, ted4_prior *prior)
{
    static nets back;
    ted4_scene s = { .head = n->h, .shape = n->shape, .profile = TED4_PROFILE_COMPACT }, t;
    ted4_writer w;
    ted4_reader r;

    back = *n;
    memset(back.value, 0, sizeof back.value);
    memset(back.shift, 0, sizeof back.shift);
    s.nete = (ted4_blob) { .values = n->value, .n = n->shape.n_nete, .mode = TED4_BLOB_CODED };
    s.shift = n->shift;
    t = s;
    t.nete.values = back.value;
    t.shift = back.shift;
    ted4_writer_init(&w);
    ted4_walk_nete(&w.base, &s, prior);
    if (w.base.error.code == TED4_OK) {
        ted4_reader_init(&r, w.out.data, 0, w.out.size, 0);
        ted4_walk_nete(&r.base, &t, prior);
        fuzz_require(r.base.error.code == TED4_OK && r.base.pos == w.out.size &&
                         t.nete.mode == TED4_BLOB_CODED && memcmp(n, &back, sizeof back) == 0,
                     "the same weights in profile Compact");
    } else {
        fuzz_require(w.base.error.code == TED4_E_ENT_SIZE, "written in profile Compact");
    }
    ted4_writer_finish(&w);
}

/* The positions have few bits, so that some are equal. */
static void check_order(fuzz_source *in)
{
    enum { ANCHORS = 12 };
    uint16_t position[3 * ANCHORS];
    uint32_t order[ANCHORS];
    size_t n, k;

    for (size_t i = 0; i < 3 * ANCHORS; i++)
        position[i] = fuzz_u16(in) & 0x3401;
    n = ted4_positions_sort(position, ANCHORS, order);
    fuzz_require(n > 0 && n <= ANCHORS, "a number of anchors");
    for (size_t i = 1; i < n; i++)
        fuzz_require(ted4_morton(position + 3 * order[i - 1]) <
                         ted4_morton(position + 3 * order[i]),
                     "codes that rise");
    for (uint32_t a = 0; a < ANCHORS; a++) {
        for (k = 0; k < n; k++)
            if (memcmp(position + 3 * order[k], position + 3 * a, 3 * sizeof *position) == 0)
                break;
        fuzz_require(k < n && order[k] <= a, "the first of equal positions");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static nets n;
    fuzz_source in = { data, data + size };
    ted4_arena arena;
    ted4_prior prior;
    ted4_error e = { TED4_OK, 0 }, want;
    int finest;

    for (int i = 0; i < 8; i++)
        check_rounding(&in);
    if (!take_nets(&in, &n))
        return 0;
    take_values(&in, &n);
    ted4_arena_init(&arena, NULL);
    fuzz_require(ted4_prior_init(&prior, &n.h, &n.shape, &arena) == TED4_OK, "memory");
    want = expected(&n);
    fuzz_require(ted4_prior_load(&prior, n.value, n.shift, &e) == want.code,
                 "the verdict of the rules");
    fuzz_require(e.code == want.code && e.offset == want.offset, "the first value that breaks one");
    finest = fuzz_u8(&in) % (TED4_MAX_SHIFT + 1);
    if (finest == TED4_MAX_SHIFT)
        ted4_snap(&n.h, &n.shape, n.value, n.shift);
    else
        ted4_snap_coarse(&n.h, &n.shape, finest, n.value, n.shift);
    fuzz_require(ted4_prior_load(&prior, n.value, n.shift, NULL) == TED4_OK, "snapped values");
    in_compact(&n, &prior);
    evaluate(&in, &n, &prior);
    check_order(&in);
    ted4_arena_finish(&arena);
    return 0;
}
