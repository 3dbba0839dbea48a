/* model.h - the trainable model: where each parameter lies, and the functions that turn anchors
 * into Gaussians and back. Depends on norm/syntax.h, render/raster.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MODEL_H
#define TED4_MODEL_H

#include "kernel/dense.h"
#include "norm/syntax.h"
#include "train/raster/raster_bwd.h"

/* Anchors lie in blocks of TED4_LANES (32): a block is [n_channels][32] floats, 64-byte aligned.
 * Channels in order: feature F, scaling 6, offset 3K, phi d, tau 4 (types that are present, as the
 * decoder reconstructs them: spec 11), then K logits of the offset mask, one logit of the temporal
 * mask (both always there; the mask is ignored when its header flag is 0). Everything is in
 * normalised space (spec 11.1). Network parameters are one array: NETR values, then BANK, then
 * NETE, each exactly in the order of its blob (spec 7). */
typedef struct {
    ted4_header head; /* n_anchors is not used here */
    ted4_shape shape;
    int first[TED4_TYPES]; /* channel of component 0; -1: type absent */
    int offset_logit, temporal_logit, n_channels;
    size_t netr, bank, nete, n_net; /* offsets into, and size of, the network array */
} ted4_layout;

void ted4_layout_make(ted4_layout *l, const ted4_header *h);

/* A mask is on when sigmoid(logit) > 0.01, which is asked of the logit: files compiled once a level
 * and others, whose sigmoids differ in the last bits, both ask it. Its gradient is that of the
 * sigmoid (straight-through). */
#define TED4_MASK_LOGIT (-4.59511985f) /* ln(0.01 / 0.99) */

static inline int ted4_mask_on(float logit)
{
    return logit > TED4_MASK_LOGIT;
}

/* One query over chosen blocks ("slots"). Slot i, offset k, lane j is splat (i K + k) 32 + j. */
typedef struct {
    const ted4_layout *layout;
    const float *net; /* [n_net] */
    size_t n_slots;
    const float *const
        *attr; /* [n_slots] blocks; values as they are to be used (quantised, noisy or plain) */
    const float *const *position; /* [n_slots] [3][32] */
    const uint32_t *lanes;        /* [n_slots] bit j: lane j holds an anchor to be used; others give
                                     opacity 0, gradient 0 */
    uint32_t num, den;            /* time, spec 11 */
    float camera[3];              /* normalised space: (c - origin) 2^-e */
    int activation; /* 0: activation is taken as 1 (static phase), even if tau is present */
} ted4_generate_input;

typedef struct ted4_generator ted4_generator; /* saved activations, packed weights */

ted4_generator *ted4_generator_new(const ted4_layout *l);
void ted4_generator_free(ted4_generator *g);

/* Copies network weights into kernel order. Call after they change, before forward. */
void ted4_generator_pack(ted4_generator *g, const float *net);
/* Gaussians in normalised space, valid until the next call; opacity is 0 for unused lanes, masked
 * offsets and heads <= 0. Also keeps what backward needs. 0, or -1: no memory. */
int ted4_generate(ted4_generator *g, const ted4_generate_input *in, const ted4_parallel *p,
                  ted4_splats *out);
/* After ted4_generate with the same input. gr: gradients of the splats. d_attr: [n_slots] blocks,
 * overwritten. d_net: NETR and BANK parts are added to. Fixed order of sums. */
int ted4_generate_backward(ted4_generator *g, const ted4_generate_input *in,
                           const ted4_splat_grads *gr, const ted4_parallel *p, float *const *d_attr,
                           float *d_net);

/* How values are quantised when the rate is estimated. */
typedef enum {
    TED4_QUANT_NOISE,  /* x + q U, U uniform in [-1/2, 1/2): gradients to x and q */
    TED4_QUANT_ROUND,  /* q round(x / q), straight-through */
    TED4_QUANT_INTEGER /* as the decoder does it: norm/prior.h gives mu, sigma index, step index;
                          straight-through */
} ted4_quant;

typedef struct {
    const ted4_layout *layout;
    const float *net;     /* [n_net]; the NETE part is used */
    const uint8_t *shift; /* [n_units] for TED4_QUANT_INTEGER, else NULL */
    size_t n_slots;
    const float *const *attr;     /* [n_slots] raw blocks */
    const float *const *position; /* [n_slots] [3][32], FP16 values */
    const uint32_t *lanes;
    const uint32_t *block; /* [n_slots] block numbers: with key they select the noise */
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
 * [n_slots] of [TED4_TYPES][32] step sizes q, out (1 for absent types). d_value: [n_slots] blocks,
 * dL/d(quantised value) from the rendering, or NULL; may be d_attr. d_attr: [n_slots] blocks, added
 * to: the rate's gradient on values and mask logits (bits of an offset count times its mask, phi
 * times the temporal mask, straight-through); NULL, with d_net: no gradients. d_net: NETE part
 * added to. bits NULL: steps only. 0, or -1: no memory, or (INTEGER) weights that spec 7.3 refuses.
 */
int ted4_rate_evaluate(ted4_rate *r, const ted4_rate_input *in, const ted4_parallel *p,
                       const float *const *d_value, float *const *d_attr, float *d_net,
                       float *const *steps, double *bits);

/* Bits of each anchor by itself, without gradients: lane_bits[n_slots][1 + K][32], all its values
 * but offsets, then each offset; 0 where masks leave them out. The same results. */
int ted4_rate_lanes(ted4_rate *r, const ted4_rate_input *in, const ted4_parallel *p,
                    float *const *steps, float *lane_bits);

/* The quantiser by itself, for rendering: out = quantised attr with given steps [TED4_TYPES][32];
 * the same noise as ted4_rate_evaluate for equal block and key. Logits are copied. NOISE or ROUND.
 * After decoding, a_s <= a_f must hold: where rounding breaks it, a_f is raised to a_s. */
TED4_EACH_LEVEL(void, ted4_quantise, const ted4_layout *l, ted4_quant quant, const float *attr,
                const float *steps, uint32_t block, uint64_t key, float *out);

#endif
