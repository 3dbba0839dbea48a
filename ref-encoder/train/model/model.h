/* model.h - the trainable model: where each parameter lies, masks, and how values are quantised.
 * Depends on norm/syntax.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MODEL_H
#define TED4_MODEL_H

#include "kernel/dense.h"
#include "norm/syntax.h"
#include "render/leveled.h"

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

/* Floats of n rows of lanes. */
static inline size_t ted4_row_floats(size_t n)
{
    return n * TED4_LANES;
}

/* How values are quantised when the rate is estimated. */
typedef enum {
    TED4_QUANT_NOISE,  /* x + q U, U uniform in [-1/2, 1/2): gradients to x and q */
    TED4_QUANT_ROUND,  /* q round(x / q), straight-through */
    TED4_QUANT_INTEGER /* as the decoder does it: norm/prior.h gives mu, sigma index, step index;
                          straight-through */
} ted4_quant;

/* The quantiser by itself, for rendering: out = quantised attr with given steps [TED4_TYPES][32];
 * the same noise as ted4_rate_evaluate for equal block and key. Logits are copied. NOISE or ROUND.
 * After decoding, a_s <= a_f must hold: where rounding breaks it, a_f is raised to a_s. */
TED4_EACH_LEVEL(void, ted4_quantise, const ted4_layout *l, ted4_quant quant, const float *attr,
                const float *steps, uint32_t block, uint64_t key, float *out);

/* The residuals n of all attribute channels: [A][32]. */
TED4_EACH_LEVEL(void, ted4_residuals, const ted4_layout *l, ted4_quant quant, const float *value,
                const float *steps, uint32_t block, uint64_t key, float *residual);

#endif
