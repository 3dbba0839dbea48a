/* rate_integer.c - TED4_QUANT_INTEGER: builds the integer networks whenever the weights have
 * changed. rate_decoded.c evaluates them for a visible block.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rate_parts.h"

#include <stdlib.h>
#include <string.h>

#include "kernel/int_kernel.h"

static int is_made_of(const ted4_rate_integer *x, const ted4_layout *l, const float *net,
                      const uint8_t *shift)
{
    const ted4_shape *s = &l->shape;

    return x->ready && x->prior.context_bits == l->head.context_bits &&
           memcmp(x->net, net, s->n_nete * sizeof *net) == 0 &&
           memcmp(x->shift, shift, s->n_units) == 0;
}

int ted4_rate_integer_begin(ted4_rate *r, const ted4_rate_input *in)
{
    const ted4_layout *l = in->layout;

    const ted4_shape *s = &l->shape;
    const float *net = in->net + l->nete;
    ted4_rate_integer *x = &r->integer;

    if (is_made_of(x, l, net, in->shift))
        return 0;
    ted4_rate_integer_end(x);
    ted4_arena_init(&x->arena, NULL);
    x->ready = 1;
    x->net = malloc(s->n_nete * sizeof *x->net + 1);
    x->shift = malloc(s->n_units + 1);
    if (x->net != NULL && x->shift != NULL &&
        ted4_prior_init(&x->prior, &l->head, s, &x->arena) == TED4_OK &&
        ted4_prior_load(&x->prior, net, in->shift, NULL) == TED4_OK) {
        memcpy(x->net, net, s->n_nete * sizeof *x->net);
        memcpy(x->shift, in->shift, s->n_units);
        x->prior.dense = ted4_select_int_dense();
        return 0;
    }
    ted4_rate_integer_end(x);
    return -1;
}

void ted4_rate_integer_end(ted4_rate_integer *x)
{
    if (x->ready)
        ted4_arena_finish(&x->arena);
    free(x->net);
    free(x->shift);
    memset(x, 0, sizeof *x);
}
