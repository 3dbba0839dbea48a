/* model.h - the trainable model: layout of the parameters, masks, and quantisation of values.
 * Depends on norm/syntax.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MODEL_H
#define TED4_MODEL_H

#include "kernel/dense.h"
#include "norm/syntax.h"
#include "render/leveled.h"

/* Anchors are stored in blocks of TED4_LANES (32): a block is [n_channels][32] floats, 64-byte
 * aligned. The channels in order: feature F, scaling 6, offset 3K, phi d, tau 4 (types that are
 * present, with values as the decoder reconstructs them: spec 11), then K logits of the offset mask
 * and one logit of the temporal mask (both are always stored; a mask is ignored if its header flag
 * is 0). Everything is in normalised space (spec 11.1). Network parameters are one array: NETR
 * values, then BANK, then NETE, each in exactly the order of its blob (spec 7). */
typedef struct {
    ted4_header head; /* n_anchors is unused here */
    ted4_shape shape;
    int first[TED4_TYPES]; /* channel of component 0; -1 if the type is absent */
    int offset_logit, temporal_logit, n_channels;
    size_t netr, bank, nete, n_net; /* offsets into the network array, and its size */
} ted4_layout;

void ted4_layout_make(ted4_layout *l, const ted4_header *h);

/* A mask is on if sigmoid(logit) > 0.01. The test is made on the logit, because files that are
 * compiled once per level and other files both make it, and their sigmoids differ in the last bits.
 * The gradient of the mask is that of the sigmoid (straight-through). */
#define TED4_MASK_LOGIT (-4.59511985f) /* ln(0.01 / 0.99) */

static inline int ted4_mask_on(float logit)
{
    return logit > TED4_MASK_LOGIT;
}

/* A mask of motion below this logit stays closed: the straight-through gradient, tiny there, is
 * taken as 0, so that F_deform need not be evaluated for its anchor. */
#define TED4_MASK_SHUT (-8.0f)

static inline int ted4_mask_shut(float logit)
{
    return logit < TED4_MASK_SHUT;
}

/* The logit of a mask of motion that is closed on purpose: far enough below to stay so. */
#define TED4_MASK_CLOSED (TED4_MASK_SHUT - 2.0f)

/* Returns the number of floats in n rows of lanes. */
static inline size_t ted4_row_floats(size_t n)
{
    return n * TED4_LANES;
}

/* Returns the number of weights and biases of a network. */
static inline size_t ted4_network_size(const ted4_net_shape *s)
{
    size_t n = 0;

    for (int i = 0; i < s->n_layers; i++)
        n += ted4_layer_size(s, (unsigned)i);
    return n;
}

/* How values are quantised for estimating the rate. */
typedef enum {
    TED4_QUANT_NOISE,  /* x + q U, U uniform in [-1/2, 1/2): gradients with respect to x and q */
    TED4_QUANT_ROUND,  /* q round(x / q), straight-through */
    TED4_QUANT_INTEGER /* as in the decoder: norm/prior.h gives mu, sigma index and step index;
                          straight-through */
} ted4_quant;

/* The quantiser on its own, for rendering: out receives attr quantised with the given steps
 * [TED4_TYPES][32]. The noise is the same as in ted4_rate_evaluate for equal block and key. Logits
 * are copied. quant is NOISE or ROUND. After decoding, a_s <= a_f must hold: where rounding
 * violates it, a_f is raised to a_s. */
TED4_EACH_LEVEL(void, ted4_quantise, const ted4_layout *l, ted4_quant quant, const float *attr,
                const float *steps, uint32_t block, uint64_t key, float *out);

/* Computes the residuals n of all attribute channels: [A][32]. */
TED4_EACH_LEVEL(void, ted4_residuals, const ted4_layout *l, ted4_quant quant, const float *value,
                const float *steps, uint32_t block, uint64_t key, float *residual);

#endif
