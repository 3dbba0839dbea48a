/* coded_weights.c - see coded_weights.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coded_weights.h"

#include "base/bytes.h"

float ted4_weight_value(int32_t k, int exponent)
{
    const unsigned length = ted4_integer_length(k);
    const uint32_t sign = k < 0 ? (uint32_t)1 << 31 : 0;
    const int biased = (int)length - 1 + exponent + 127;
    uint32_t size = (uint32_t)(k < 0 ? -k : k);

    if (k == 0)
        return ted4_bits_float(0);
    if (biased < 1 || biased > 254)
        return ted4_bits_float(0x7f800000);
    if (length <= TED4_WEIGHT_BITS)
        size <<= TED4_WEIGHT_BITS - length;
    else if (size % ((uint32_t)1 << (length - TED4_WEIGHT_BITS)) == 0)
        size >>= length - TED4_WEIGHT_BITS;
    else
        return ted4_bits_float(0x7f800000);
    return ted4_bits_float(sign | (uint32_t)biased << 23 | (size & 0x7fffff));
}

void ted4_code_weights(ted4_coder *c, ted4_integer_model *m, int exponent, float *x, size_t n)
{
    unsigned before = 0, last = 0;

    for (size_t i = 0; i < n && c->error.code == TED4_OK; i++) {
        const unsigned expected = (before + last + 1) / 2;
        int32_t k = c->reads ? 0 : (int32_t)ted4_rne_scaled(ted4_float_bits(x[i]), -exponent);

        k = ted4_code_integer(c, m, expected, k);
        if (c->reads)
            x[i] = ted4_weight_value(k, exponent);
        before = last;
        last = ted4_integer_length(k);
    }
}
