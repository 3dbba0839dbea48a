/* prior.h - spec 7.3, 10.1, 10.3: the networks of Tier E in integer arithmetic, and the meaning of
 * their outputs. Depends on syntax.h. It needs no scene. Use:
 *     ted4_arena_init(&a, NULL); ted4_prior_init(&p, &head, &shape, &a);
 *     ted4_prior_load(&p, nete, shift, &error);    whenever the weights have changed
 *     ted4_prior_hyper(...); ted4_prior_slice(...);    on any number of threads
 *     ted4_arena_finish(&a);
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PRIOR_H
#define TED4_PRIOR_H

#include "base/fixed.h"
#include "norm/syntax.h"
#include "norm/tables.h"

enum {
    TED4_PRIOR_BLOCK = 64,          /* most anchors per call; arrays are [channel][64] */
    TED4_PRIOR_INPUTS = 3 + 6 * 16, /* most inputs of the hyperprior */
    TED4_INPUT_BITS = 12,
    TED4_HIDDEN_BITS = 10,
    TED4_OUTPUT_BITS = 8,
    TED4_OUTPUT_MAX = (1 << 26) - 1,
    TED4_MAX_SHIFT = 20
};

/* One dense layer: y_o = b_o + sum_i w_oi x_i, shifted right by r_o with rounding. in_pad is the
 * number of inputs, in, rounded up to an even number; the padding of w is 0. The arena of
 * ted4_prior_init owns the arrays. */
typedef struct {
    unsigned in, in_pad, out;
    int16_t *w; /* [out][in_pad] */
    int32_t *b; /* [out] */
    uint8_t *r; /* [out] */
} ted4_int_layer;

/* Functions that evaluate a layer for n columns; n is 32 or 64. x is [in][64] and y is [out][64];
 * columns from n on are neither read nor written. hidden writes max(0, sat16(y)); last writes y
 * clamped to +-TED4_OUTPUT_MAX. */
typedef struct {
    void (*hidden)(const ted4_int_layer *l, const int16_t *x, size_t n, int16_t *y);
    void (*last)(const ted4_int_layer *l, const int16_t *x, size_t n, int32_t *y);
} ted4_int_dense;

extern const ted4_int_dense ted4_int_dense_plain;

enum { TED4_HYPER_LAYERS = 5, TED4_SLICE_LAYERS = 2 };

typedef struct ted4_prior {
    const ted4_int_dense
        *dense; /* after init: ted4_int_dense_plain; may be replaced by a bit-exact variant */
    unsigned pe_octaves, context_bits;
    unsigned n_inputs, n_outputs, n_slices;
    uint8_t slice_dim[TED4_MAX_SLICES];
    unsigned n_hyper; /* number of layers of the hyperprior */
    ted4_int_layer hyper[TED4_HYPER_LAYERS];
    ted4_int_layer slice[TED4_MAX_SLICES][TED4_SLICE_LAYERS]; /* [0] is unused */
    ted4_net_shape hyper_shape, slice_shape[TED4_MAX_SLICES];
} ted4_prior;

/* Sets the shapes and allocates storage; the weights are 0 until ted4_prior_load. Returns TED4_OK
 * or TED4_E_LIMIT_MEMORY. */
ted4_status ted4_prior_init(ted4_prior *p, const ted4_header *h, const ted4_shape *s,
                            ted4_arena *arena);
/* Converts nete[n_nete] to integers with shift[n_units], using bit operations only, and checks
 * R-NET-002 to R-NET-006 in the order of the blob. Returns TED4_OK or the error; e->offset is then
 * an index into nete, or into shift for TED4_E_NET_SHIFT. e may be NULL. */
ted4_status ted4_prior_load(ted4_prior *p, const float *nete, const uint8_t *shift, ted4_error *e);

/* The quantities on which R-NET-003 to R-NET-006 depend for one output unit: f, the fraction bits
 * of its inputs, and g, the fraction bits of its output. */
typedef struct {
    int f, g;
    int32_t amplitude; /* A: bound on the magnitude of its inputs */
} ted4_unit_rule;

/* Returns the rule for layer i of network n. hyper: 1 for the hyperprior, 0 for a slice network. */
ted4_unit_rule ted4_prior_rule(const ted4_net_shape *n, unsigned i, int hyper,
                               unsigned context_bits);
/* R-NET-003, R-NET-005: returns 1 if this shift is legal, else 0. */
static inline int ted4_shift_legal(const ted4_unit_rule *u, int shift)
{
    return shift <= TED4_MAX_SHIFT && shift + u->f - u->g >= 0;
}
/* R-NET-006: returns 1 if the accumulator cannot overflow 32 bits, else 0. sum_w is the sum of |W|,
 * below 2^31. */
static inline int ted4_accumulator_legal(const ted4_unit_rule *u, int shift, int64_t sum_w,
                                         int64_t b)
{
    const int r = shift + u->f - u->g;
    const int64_t half = r > 0 ? (int64_t)1 << (r - 1) : 0;

    return sum_w * u->amplitude + (b < 0 ? -b : b) + half <= INT32_MAX;
}

/* spec 10.1: evaluates the hyperprior for n <= 64 anchors. position: [n][3] binary16 patterns with
 * |p| <= 1. out: [P][64] in Q8; columns from n on are undefined. */
void ted4_prior_hyper(const ted4_prior *p, const uint16_t *position, size_t n, int32_t *out);
/* Do the same in two steps, for callers that need only a few outputs at a time. ted4_prior_last
 * returns the last layer. hidden: [in][64] inputs of the last layer, whose member in may be 0.
 * some: a layer for a subset of the outputs, made by ted4_prior_some. */
const ted4_int_layer *ted4_prior_last(const ted4_prior *p);
void ted4_prior_hyper_hidden(const ted4_prior *p, const uint16_t *position, size_t n,
                             int16_t *hidden);
void ted4_prior_hyper_some(const ted4_prior *p, const ted4_int_layer *some, const int16_t *hidden,
                           size_t n, int32_t *out);
/* Makes *some a layer with n outputs of the last layer from index first on, followed by n outputs
 * from index second on. The caller provides the arrays of some, with room for 2 n outputs. */
void ted4_prior_some(const ted4_prior *p, unsigned first, unsigned second, unsigned n,
                     ted4_int_layer *some);
/* spec 10.3: evaluates slice network m = 1 .. n_slices - 1 for n <= 64 anchors. ctx:
 * [slice[0] + .. + slice[m-1]][64] values of ted4_context(); the columns from n to the next
 * multiple of 32 may have any 16-bit value but -32768, for example 0. out: [2 slice[m]][64], the
 * corrections to mu, followed by those to s. */
void ted4_prior_slice(const ted4_prior *p, unsigned m, const int16_t *ctx, size_t n, int32_t *out);

/* spec 10.1: returns the index into the step tables for an output v. */
static inline uint8_t ted4_step_index(int32_t v)
{
    return (uint8_t)ted4_clamp(128 + ted4_round_shift(v, 3), 0, 255);
}

/* spec 10.1: returns the sigma index for an output s. The caller has added the slice network's
 * correction to s. */
static inline uint8_t ted4_sigma_index(int32_t s)
{
    return (uint8_t)ted4_clamp(64 + ted4_round_shift(s, 4), 0, TED4_N_SIGMA - 1);
}

/* spec 10.3: returns the input of the slice networks for symbol k. */
static inline int16_t ted4_context(int16_t k, uint8_t step_index, unsigned context_bits)
{
    return (int16_t)ted4_sat16(ted4_round_shift(k * ted4_stepi[step_index], 12 - context_bits));
}

#endif
