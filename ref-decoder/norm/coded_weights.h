/* coded_weights.h - spec 7.6: codes the weights of a unit as integers times a power of two.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CODED_WEIGHTS_H
#define TED4_CODED_WEIGHTS_H

#include "norm/coded_integer.h"

/* The magnitudes of the integers have so many significant bits at most, from the highest to the
 * lowest that is 1: each is exact in binary32. */
enum { TED4_WEIGHT_BITS = 24 };

/* Returns k 2^exponent, or infinity where that is neither 0 nor a normal binary32.
 * exponent: within +-256. */
float ted4_weight_value(int32_t k, int exponent);
/* Codes x[n], which a writing coder has as multiples of 2^exponent, below 2^31 of them. A
 * reading coder fills x; values that the format does not allow are infinite. m: of the layer. */
void ted4_code_weights(ted4_coder *c, ted4_integer_model *m, int exponent, float *x, size_t n);

#endif
