/* walk_nets.c - spec 7.2, 7.3: codes tensor blobs and the networks of Tier E.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coder.h"

#include "base/bytes.h"
#include "norm/prior.h"

/* The byte offset in the file of value i is at + i step; step is 0 if one deflated element holds
 * all values. */
typedef struct {
    size_t at, step;
} value_offsets;

/* Codes the mode and the bytes of a blob. Returns the offsets of its values. */
static value_offsets walk_bytes(ted4_coder *c, const char *element, const ted4_scene *s,
                                ted4_blob *b)
{
    const uint8_t most = s->profile == TED4_PROFILE_MAIN ? TED4_BLOB_DEFLATED : TED4_BLOB_CODED;
    size_t at = c->pos;
    value_offsets v;

    b->mode = (uint8_t)ted4_code(c, "mode", 0, 1, b->mode);
    ted4_require(c, b->mode <= most, TED4_E_NET_MODE, at);
    at = c->pos;
    v.at = at;
    v.step = b->mode == TED4_BLOB_RAW ? 4 : 0;
    if (b->mode == TED4_BLOB_DEFLATED) {
        c->ops->deflated(c, b);
        ted4_trace(c, at, element, -1, (int64_t)b->deflated_size);
        return v;
    }
    if (b->mode == TED4_BLOB_CODED) {
        v.at = ted4_walk_coded(c, s, b);
        return v;
    }
    c->ops->array(c, 4, b->values, b->n);
    for (size_t i = 0; c->error.code == TED4_OK && c->trace != NULL && i < b->n; i++)
        ted4_trace(c, at + 4 * i, element, (int64_t)i, ted4_float_bits(b->values[i]));
    return v;
}

/* spec 7.2, 7.4, 7.5 */
void ted4_walk_blob(ted4_coder *c, const char *element, const ted4_scene *s, ted4_blob *b)
{
    const value_offsets v = walk_bytes(c, element, s, b);

    for (size_t i = 0; c->error.code == TED4_OK && i < b->n; i++) {
        ted4_require(c, ted4_float_legal(ted4_float_bits(b->values[i])), TED4_E_NET_VALUE,
                     v.at + v.step * i);
    }
}

static void walk_shifts(ted4_coder *c, uint8_t *shift, const ted4_shape *s, unsigned context_bits)
{
    for (int m = -1; m < TED4_MAX_SLICES; m++) {
        const ted4_net_shape *n = m < 0 ? &s->hyper : &s->slice[m];
        size_t unit = n->first_unit;

        for (unsigned i = 0; i < n->n_layers; i++) {
            const ted4_unit_rule rule = ted4_prior_rule(n, i, m < 0, context_bits);

            for (unsigned o = 0; o < n->dim[i + 1]; o++, unit++) {
                const size_t at = c->pos;

                shift[unit] = (uint8_t)ted4_code(c, "shift", (int64_t)unit, 1, shift[unit]);
                ted4_require(c, ted4_shift_legal(&rule, shift[unit]), TED4_E_NET_SHIFT, at);
                if (c->error.code != TED4_OK)
                    return;
            }
        }
    }
}

/* spec 7.3 */
void ted4_walk_nete(ted4_coder *c, ted4_scene *s, ted4_prior *prior)
{
    value_offsets v;
    ted4_error e = { TED4_OK, 0 };

    walk_shifts(c, s->shift, &s->shape, s->head.context_bits);
    if (c->error.code != TED4_OK)
        return;
    v = walk_bytes(c, "nete", s, &s->nete);
    if (c->error.code == TED4_OK && ted4_prior_load(prior, s->nete.values, s->shift, &e) != TED4_OK)
        ted4_fail(&c->error, e.code, v.at + v.step * e.offset);
}
