/* coded_integer.h - codes integers whose sizes are alike, such as the weights of a network on its
 * grid, with adaptive probabilities.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CODED_INTEGER_H
#define TED4_CODED_INTEGER_H

#include "norm/adaptive.h"
#include "norm/coder.h"

/* A length is a number of bits, 0 .. 31: that of the magnitude of an integer. */
enum { TED4_INTEGER_LENGTHS = 32 };

/* length: for each length expected, a binary tree of five levels, whose root is 1. top: the bit
 * below the leading one, by length. */
typedef struct {
    ted4_adaptive length[TED4_INTEGER_LENGTHS][TED4_INTEGER_LENGTHS];
    ted4_adaptive sign, top[TED4_INTEGER_LENGTHS];
} ted4_integer_model;

void ted4_integer_model_init(ted4_integer_model *m);
/* Returns the length of an integer above -2^31. */
unsigned ted4_integer_length(int32_t x);
/* Codes x, which is not -2^31: its length, its sign, and the bits below the leading one, of which
 * only the first is adaptive. expected: a length, the closer the better. At most 36 symbols.
 * Returns the coded integer. */
int32_t ted4_code_integer(ted4_coder *c, ted4_integer_model *m, unsigned expected, int32_t x);

#endif
