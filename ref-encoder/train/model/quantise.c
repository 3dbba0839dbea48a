/* quantise.c - calls the quantiser of model.h in the version for the instruction set in use.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "model.h"

void ted4_residuals(const ted4_layout *l, ted4_quant quant, const float *value, const float *steps,
                    uint32_t block, uint64_t key, float *residual)
{
    TED4_IN_USE(ted4_residuals)(l, quant, value, steps, block, key, residual);
}

void ted4_quantise(const ted4_layout *l, ted4_quant quant, const float *attr, const float *steps,
                   uint32_t block, uint64_t key, float *out)
{
    TED4_IN_USE(ted4_quantise)(l, quant, attr, steps, block, key, out);
}
