/* walk_coded.c - spec 7.6: codes the values of a blob of mode 2, integers times powers of two.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coder.h"

#include "norm/coded_weights.h"
#include "norm/prior.h"

/* Exponents are stored with this added, which makes them non-negative. */
enum { EXPONENT_ZERO = 128 };

/* Opens the substream of a blob. Returns its byte offset. */
static size_t begin(ted4_coder *c, const ted4_blob *b)
{
    const size_t at = c->pos;

    c->ops->rest(c, b->n);
    c->ops->open(c, 1);
    ted4_trace(c, at, "weights_substream", 0, (int64_t)b->n);
    return at;
}

/* Codes a layer of Tier E. x: its weights, which its biases follow. Biases have contexts of their
 * own, as they are on a finer grid than the weights. */
static void walk_layer_e(ted4_coder *c, const ted4_net_shape *n, unsigned layer, int f, float *x,
                         const uint8_t *shift)
{
    const size_t in = n->dim[layer], out = n->dim[layer + 1];
    ted4_integer_model weights, biases;

    ted4_integer_model_init(&weights);
    ted4_integer_model_init(&biases);
    for (size_t o = 0; o < out; o++)
        ted4_code_weights(c, &weights, -shift[o], x + o * in, in);
    for (size_t o = 0; o < out; o++)
        ted4_code_weights(c, &biases, -(shift[o] + f), x + out * in + o, 1);
}

static size_t walk_nete(ted4_coder *c, const ted4_scene *s, ted4_blob *b)
{
    const size_t at = begin(c, b);

    for (int m = 0; m < TED4_MAX_SLICES; m++) {
        const ted4_net_shape *n = m == 0 ? &s->shape.hyper : &s->shape.slice[m];
        size_t first = n->first, unit = n->first_unit;

        for (unsigned i = 0; i < n->n_layers && c->error.code == TED4_OK; i++) {
            const ted4_unit_rule rule = ted4_prior_rule(n, i, m == 0, s->head.context_bits);

            walk_layer_e(c, n, i, rule.f, b->values + first, s->shift + unit);
            first += ted4_layer_size(n, i);
            unit += n->dim[i + 1];
        }
    }
    c->ops->close(c);
    return at;
}

static void walk_exponents(ted4_coder *c, ted4_blob *b, size_t n)
{
    for (size_t i = 0; i < n && c->error.code == TED4_OK; i++) {
        const uint32_t e =
            ted4_code(c, "unit_exponent", (int64_t)i, 1, b->exponent != NULL ? b->exponent[i] : 0);

        if (b->exponent != NULL)
            b->exponent[i] = (uint8_t)e;
    }
}

/* Codes a layer of Tier R: a unit for each row of weights, and one for the biases. */
static void walk_layer_r(ted4_coder *c, const ted4_net_shape *n, unsigned layer, float *x,
                         const uint8_t *exponent)
{
    const size_t in = n->dim[layer], out = n->dim[layer + 1];
    ted4_integer_model m;

    ted4_integer_model_init(&m);
    for (size_t o = 0; o < out; o++)
        ted4_code_weights(c, &m, exponent[o] - EXPONENT_ZERO, x + o * in, in);
    ted4_code_weights(c, &m, exponent[out] - EXPONENT_ZERO, x + out * in, out);
}

static size_t walk_netr(ted4_coder *c, const ted4_scene *s, ted4_blob *b)
{
    const uint8_t *exponent = b->exponent;
    size_t at;

    walk_exponents(c, b, s->shape.n_units_r);
    at = begin(c, b);
    for (int m = 0; m < TED4_NETS_R; m++) {
        const ted4_net_shape *n = &s->shape.netr[m];
        size_t first = n->first;

        for (unsigned i = 0; i < n->n_layers && c->error.code == TED4_OK; i++) {
            walk_layer_r(c, n, i, b->values + first, exponent);
            first += ted4_layer_size(n, i);
            exponent += n->dim[i + 1] + 1u;
        }
    }
    c->ops->close(c);
    return at;
}

static size_t walk_bank(ted4_coder *c, ted4_blob *b)
{
    ted4_integer_model m;
    size_t at;

    walk_exponents(c, b, 1);
    at = begin(c, b);
    ted4_integer_model_init(&m);
    if (c->error.code == TED4_OK)
        ted4_code_weights(c, &m, b->exponent[0] - EXPONENT_ZERO, b->values, b->n);
    c->ops->close(c);
    return at;
}

size_t ted4_walk_coded(ted4_coder *c, const ted4_scene *s, ted4_blob *b)
{
    return b == &s->nete   ? walk_nete(c, s, b)
           : b == &s->netr ? walk_netr(c, s, b)
                           : walk_bank(c, b);
}
