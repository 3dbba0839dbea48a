/* coded.c - see coded.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "write/coded.h"

#include "norm/coded_weights.h"
#include "norm/half.h"
#include "norm/octree.h"
#include "norm/prior.h"
#include "write/coder_write.h"

/* Exponents that a unit can have, and what is added to them in the file. */
enum { EXPONENT_LEAST = -128, EXPONENT_MOST = 127 };

/* Returns whether each of x[n] is an integer below 2^31 times 2^exponent. */
static int fits(const float *x, size_t n, int exponent)
{
    for (size_t i = 0; i < n; i++) {
        const int64_t k = ted4_rne_scaled(ted4_float_bits(x[i]), -exponent);

        if (k < -INT32_MAX || k > INT32_MAX ||
            ted4_float_bits(ted4_weight_value((int32_t)k, exponent)) != ted4_float_bits(x[i]))
            return 0;
    }
    return 1;
}

/* Returns the largest exponent such that all of x[n] are multiples of its power of two. */
static int exponent_of(const float *x, size_t n)
{
    int least = EXPONENT_MOST + 1;

    for (size_t i = 0; i < n; i++) {
        const uint32_t bits = ted4_float_bits(x[i]) & 0x7fffffff;
        const uint32_t m = (bits & 0x7fffff) | 0x800000;
        const int e = (int)(bits >> 23) - 150 + (int)ted4_log2_floor(m & -m);

        if (bits != 0 && e < least)
            least = e;
    }
    return least > EXPONENT_MOST ? 0 : least < EXPONENT_LEAST ? EXPONENT_LEAST : least;
}

static int code_unit(const float *x, size_t n, uint8_t *exponent)
{
    const int e = exponent_of(x, n);

    *exponent = (uint8_t)(e - EXPONENT_LEAST);
    return fits(x, n, e);
}

static int code_nete(const ted4_scene *s, const ted4_blob *b)
{
    for (int m = 0; m < TED4_MAX_SLICES; m++) {
        const ted4_net_shape *n = m == 0 ? &s->shape.hyper : &s->shape.slice[m];
        const float *x = b->values + n->first;
        const uint8_t *shift = s->shift + n->first_unit;

        for (unsigned i = 0; i < n->n_layers; i++) {
            const ted4_unit_rule rule = ted4_prior_rule(n, i, m == 0, s->head.context_bits);
            const size_t in = n->dim[i], out = n->dim[i + 1];

            for (size_t o = 0; o < out; o++)
                if (!fits(x + o * in, in, -shift[o]) ||
                    !fits(x + out * in + o, 1, -(shift[o] + rule.f)))
                    return 0;
            x += ted4_layer_size(n, i);
            shift += out;
        }
    }
    return 1;
}

static int code_netr(const ted4_scene *s, const ted4_blob *b)
{
    uint8_t *exponent = b->exponent;

    for (int m = 0; m < TED4_NETS_R; m++) {
        const ted4_net_shape *n = &s->shape.netr[m];
        const float *x = b->values + n->first;

        for (unsigned i = 0; i < n->n_layers; i++) {
            const size_t in = n->dim[i], out = n->dim[i + 1];

            for (size_t o = 0; o < out; o++)
                if (!code_unit(x + o * in, in, exponent++))
                    return 0;
            if (!code_unit(x + out * in, out, exponent++))
                return 0;
            x += ted4_layer_size(n, i);
        }
    }
    return 1;
}

static int is_smaller(const ted4_scene *s, ted4_blob *b, size_t most)
{
    ted4_writer w;
    int smaller;

    ted4_writer_init(&w);
    (void)ted4_walk_coded(&w.base, s, b);
    smaller = w.base.error.code == TED4_OK && w.out.size < most;
    ted4_writer_finish(&w);
    return smaller;
}

int ted4_blob_code(const ted4_scene *s, ted4_blob *b, ted4_arena *arena, size_t most)
{
    uint8_t *const exponent = b->exponent;
    int coded;

    if (b != &s->nete) {
        b->exponent = ted4_arena_alloc(arena, b == &s->netr ? s->shape.n_units_r : 1, 1);
        if (b->exponent == NULL) {
            b->exponent = exponent;
            return 0;
        }
    }
    coded = b == &s->nete   ? code_nete(s, b)
            : b == &s->netr ? code_netr(s, b)
                            : code_unit(b->values, b->n, b->exponent);
    coded = coded && is_smaller(s, b, most);
    if (coded)
        b->mode = TED4_BLOB_CODED;
    else
        b->exponent = exponent;
    return coded;
}

static int is_on_grid(const uint16_t *position, size_t n, unsigned depth)
{
    for (size_t i = 0; i < 3 * n; i++)
        if (ted4_grid_place(position[i], depth) == UINT32_MAX)
            return 0;
    for (size_t i = 1; i < n; i++)
        if (ted4_octree_key(position + 3 * i, depth) <=
            ted4_octree_key(position + 3 * i - 3, depth))
            return 0;
    return 1;
}

unsigned ted4_coarsest_grid(const uint16_t *position, size_t n)
{
    unsigned depth = 1;

    while (depth < TED4_OCTREE_DEPTH &&
           (!ted4_grid_exists(depth) || !is_on_grid(position, n, depth)))
        depth++;
    return depth;
}
