/* coded_integer.c - see coded_integer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coded_integer.h"

void ted4_integer_model_init(ted4_integer_model *m)
{
    ted4_adaptive_init(m->length[0], TED4_INTEGER_LENGTHS * TED4_INTEGER_LENGTHS);
    ted4_adaptive_init(&m->sign, 1);
    ted4_adaptive_init(m->top, TED4_INTEGER_LENGTHS);
}

unsigned ted4_integer_length(int32_t x)
{
    return x == 0 ? 0 : ted4_log2_floor((uint32_t)(x < 0 ? -x : x)) + 1;
}

static unsigned code_bit(ted4_coder *c, ted4_adaptive *m, unsigned value)
{
    const int coded = c->ops->bit(c, m->p, (int)value);

    ted4_adaptive_update(m, coded);
    return (unsigned)coded;
}

static unsigned code_length(ted4_coder *c, ted4_adaptive *tree, unsigned length)
{
    unsigned node = 1;

    for (int i = 4; i >= 0; i--)
        node = 2 * node + code_bit(c, &tree[node], length >> i & 1);
    return node - TED4_INTEGER_LENGTHS;
}

int32_t ted4_code_integer(ted4_coder *c, ted4_integer_model *m, unsigned expected, int32_t x)
{
    const unsigned length = code_length(c, m->length[expected], ted4_integer_length(x));
    const uint32_t from = (uint32_t)(x < 0 ? -x : x);
    uint32_t size = 1;
    unsigned negative;

    if (length == 0)
        return 0;
    negative = code_bit(c, &m->sign, x < 0);
    for (unsigned i = length - 1; i > 0; i--) {
        const unsigned value = from >> (i - 1) & 1;

        size = 2 * size + (i == length - 1 ? code_bit(c, &m->top[length], value)
                                           : (unsigned)c->ops->bit(c, 32768, (int)value));
    }
    return negative ? -(int32_t)size : (int32_t)size;
}
