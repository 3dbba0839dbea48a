/* rate.h - bits of chosen blocks under the prior, and their gradients (spec 9.4, 10).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RATE_H
#define TED4_RATE_H

#include "base/parallel.h"
#include "train/model/model.h"

typedef struct {
    const ted4_layout *layout;
    const float *net;     /* [n_net]; the NETE part is used */
    const uint8_t *shift; /* [n_units] for TED4_QUANT_INTEGER, else NULL */
    size_t n_visible;
    const float *const *attr;     /* [n_visible] raw blocks */
    const float *const *position; /* [n_visible] [3][32], FP16 values */
    const uint32_t *lanes;
    const uint32_t *block; /* [n_visible] block numbers: with key they select the noise */
    uint64_t key;          /* noise key of this iteration */
    ted4_quant quant;
    float bit_weight;        /* dL/d(one bit) */
    float distortion_weight; /* factor of d_value when it is passed on to step sizes */
    int activation;          /* 0: tau is not coded yet (static phase) */
} ted4_rate_input;

typedef struct ted4_rate ted4_rate;

ted4_rate *ted4_rate_new(const ted4_layout *l);
void ted4_rate_free(ted4_rate *r);
void ted4_rate_pack(ted4_rate *r, const float *net);
/* Bits of the chosen anchors per type (masked values excluded) into bits[TED4_TYPES]. steps:
 * [n_visible] of [TED4_TYPES][32] step sizes q, out (1 for absent types). d_value: [n_visible]
 * blocks, dL/d(quantised value) from the rendering, or NULL; may be d_attr. d_attr: [n_visible]
 * blocks, added to: the rate's gradient on values and mask logits (bits of an offset count times
 * its mask, phi times the temporal mask, straight-through); NULL, with d_net: no gradients. d_net:
 * NETE part added to. bits NULL: steps only. 0, or -1: no memory, or (INTEGER) weights that spec
 * 7.3 refuses.
 */
int ted4_rate_evaluate(ted4_rate *r, const ted4_rate_input *in, const ted4_parallel *p,
                       const float *const *d_value, float *const *d_attr, float *d_net,
                       float *const *steps, double *bits);

/* Bits of each anchor by itself, without gradients: lane_bits[n_visible][1 + K][32], all its values
 * but offsets, then each offset; 0 where masks leave them out. The same results. */
int ted4_rate_lanes(ted4_rate *r, const ted4_rate_input *in, const ted4_parallel *p,
                    float *const *steps, float *lane_bits);

#endif
