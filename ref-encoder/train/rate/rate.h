/* rate.h - the rate model: bits of chosen blocks under the prior, and their gradients (spec 9.4,
 * 10).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RATE_H
#define TED4_RATE_H

#include "base/parallel.h"
#include "train/model/model.h"

/* The sums of one chunk, some neighbouring blocks. */
typedef struct {
    float *d_net; /* [n_nete] */
    double bits[TED4_TYPES];
} ted4_rate_sums;

/* Processes that share the chunks of an evaluation with gradients: of the n of a wave, rank r
 * evaluates those from n r / ranks to n (r + 1) / ranks. */
typedef struct {
    size_t rank, n;
    void *user; /* borrowed: first argument of join */
    /* Completes a wave of n chunks of which chunk k has the blocks first[k] to first[k + 1] of the
     * input: gives all processes d_attr and steps of all blocks and the bits of all chunks, and
     * adds d_net of all chunks, in their order, to d_nete[n_nete]. Returns 0, or -1 if memory ran
     * out. */
    int (*join)(void *user, ted4_rate_sums *sums, const size_t *first, size_t n, float *d_nete);
} ted4_rate_ranks;

typedef struct {
    const ted4_layout *layout;
    const float *net;     /* [n_net]; the NETE part is used */
    const uint8_t *shift; /* [n_units] for TED4_QUANT_INTEGER, else NULL */
    size_t n_visible;
    const float *const *attr;     /* [n_visible] raw blocks */
    const float *const *position; /* [n_visible] [3][32], FP16 values */
    const uint32_t *lanes;
    const uint32_t *block; /* [n_visible] block numbers, which select the noise together with key */
    uint64_t key;          /* key of this iteration's noise */
    ted4_quant quant;
    float bit_weight;             /* dL/d(one bit) */
    float distortion_weight;      /* factor of d_value when it is passed on to the step sizes */
    int activation;               /* 0: tau is not coded yet (static phase) */
    const ted4_rate_ranks *ranks; /* borrowed; NULL: this process evaluates all */
} ted4_rate_input;

enum { TED4_RATE_WAVE = 32 }; /* chunks of a wave, at most */

typedef struct ted4_rate ted4_rate;

ted4_rate *ted4_rate_new(const ted4_layout *l);
void ted4_rate_free(ted4_rate *r);
void ted4_rate_pack(ted4_rate *r, const float *net);
/* Estimates the rate of the chosen anchors.
 * bits[TED4_TYPES]: receives the bits per type, without masked values; NULL: compute step sizes
 * only.
 * steps: [n_visible] of [TED4_TYPES][32], receives the step sizes q (1 for absent types).
 * d_value: [n_visible] blocks, dL/d(quantised value) from rendering, or NULL; may be d_attr.
 * d_attr: [n_visible] blocks to which the rate's gradients on values and mask logits are added
 * (bits of an offset are weighted by its mask, those of phi by the temporal mask,
 * straight-through). NULL, together with d_net: no gradients.
 * d_net: the gradients of the NETE part are added to it.
 * Returns 0, or -1 if memory ran out or (INTEGER) if spec 7.3 rejects the weights. */
int ted4_rate_evaluate(ted4_rate *r, const ted4_rate_input *in, const ted4_parallel *p,
                       const float *const *d_value, float *const *d_attr, float *d_net,
                       float *const *steps, double *bits);

/* Computes the bits of each anchor separately, without gradients. lane_bits[n_visible][1 + K][32]:
 * first the bits of all values of the anchor except its offsets, then those of each offset; masked
 * values count 0. Returns the same as ted4_rate_evaluate. */
int ted4_rate_lanes(ted4_rate *r, const ted4_rate_input *in, const ted4_parallel *p,
                    float *const *steps, float *lane_bits);

#endif
