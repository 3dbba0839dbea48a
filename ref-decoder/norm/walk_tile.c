/* walk_tile.c - spec 9.1, 9.3, 10: codes one tile of anchors.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coder.h"

#include <string.h>

#include "norm/prior.h"

enum { BLOCK = TED4_PRIOR_BLOCK, MAX_SUBSTREAMS = 1 + TED4_MAX_SLICES + TED4_TYPES - 1 };

/* The state of a walk. The arrays are in the caller's work memory. */
typedef struct {
    ted4_coder *c;
    ted4_scene *s;
    const ted4_prior *prior;
    size_t first, n, n_blocks; /* first anchor, number of anchors, and of blocks of 64 anchors */
    size_t n_padded;           /* 64 n_blocks */
    unsigned n_hidden;         /* H, inputs of the hyperprior's last layer */
    int16_t *hidden;           /* [n_blocks][H][64] these inputs */
    ted4_int_layer some;       /* the last layer, restricted to some components */
    int16_t *ctx;              /* [n_blocks][F][64] inputs of the slice networks */
    int32_t *out;              /* [2 C][64] outputs of the hyperprior for one block */
    int32_t *added;            /* [2 C][64] outputs of a slice network, added to out */
    int32_t *mu;               /* [C][n_padded] models of components, for all anchors */
    uint8_t *sigma;            /* [C][n_padded] their sigma indices */
    uint32_t *index;           /* [n_index] anchors of the tile that have the current component */
    size_t n_index;
    int32_t *some_mu; /* [n_padded], like k and some_sigma: entry j is for anchor index[j] */
    int16_t *k;
    uint8_t *some_sigma;
    size_t opened; /* byte offset in the file of the open substream */
} tile;

static const char *const type_name[TED4_TYPES] = { "feature", "scaling", "offset", "phi", "tau" };
static const char *const substream_name[TED4_TYPES] = { "feature_substream", "scaling_substream",
                                                        "offset_substream", "phi_substream",
                                                        "tau_substream" };

static size_t block_count(size_t n)
{
    return (n + BLOCK - 1) / BLOCK;
}

static size_t tile_anchors(const ted4_header *h)
{
    return h->tile_size < h->n_anchors ? h->tile_size : h->n_anchors;
}

static unsigned larger(unsigned a, unsigned b)
{
    return a > b ? a : b;
}

/* The number of offsets whose models are evaluated at once. Most outputs of the hyperprior belong
 * to offsets, so they are evaluated in groups from the inputs of the last layer, which take less
 * memory. */
enum { OFFSETS = 8 };

static unsigned hidden_rows(const ted4_net_shape *hyper)
{
    return hyper->dim[hyper->n_layers - 1];
}

/* Returns C, the largest number of components that are evaluated at once. */
static unsigned most_components(const ted4_scene *s)
{
    const unsigned k = s->head.n_offsets;
    unsigned most = larger(s->shape.dim[TED4_SCALING], 3 * (k < OFFSETS ? k : OFFSETS));

    most = larger(most, larger(s->shape.dim[TED4_PHI], s->shape.dim[TED4_TAU]));
    for (unsigned m = 0; m < s->head.n_slices; m++)
        most = larger(most, s->head.slice[m]);
    return most;
}

/* Returns the size in bytes of out, which is also the size of added. */
static size_t outputs_size(const ted4_scene *s)
{
    return sizeof(int32_t) * 2 * BLOCK * most_components(s);
}

/* Returns the number of units of a layer with 2 C outputs, rounded up to a multiple of 64. */
static size_t layer_units(const ted4_scene *s)
{
    return block_count(2 * most_components(s)) * BLOCK;
}

/* Returns an upper bound on in_pad, the number of weights of a unit with their padding. */
static size_t unit_weights(const ted4_scene *s)
{
    return (size_t)hidden_rows(&s->shape.hyper) + 1;
}

size_t ted4_tile_work_size(const ted4_scene *s)
{
    const size_t n = block_count(tile_anchors(&s->head)) * BLOCK;
    const size_t per_anchor = (4 + 1) * ((size_t)most_components(s) + 1) +
                              2 * ((size_t)hidden_rows(&s->shape.hyper) + s->head.feature_dim) + 4 +
                              2;
    const size_t fixed = 2 * outputs_size(s) + layer_units(s) * (2 * unit_weights(s) + 4 + 1);

    if (n > (SIZE_MAX - fixed) / per_anchor)
        return SIZE_MAX;
    return n * per_anchor + fixed;
}

/* Returns the next n elements of size bytes each and advances *at past them. n is a multiple
 * of 64. */
static void *next_array(char **at, size_t n, size_t size)
{
    void *array = *at;

    *at += n * size;
    return array;
}

static void carve(tile *t, void *work)
{
    const size_t n = t->n_blocks * BLOCK, most = most_components(t->s), units = layer_units(t->s);
    char *at = work;

    t->n_padded = n;
    t->n_hidden = hidden_rows(&t->s->shape.hyper);
    t->out = next_array(&at, outputs_size(t->s), 1);
    t->added = next_array(&at, outputs_size(t->s), 1);
    t->some.w = next_array(&at, units * unit_weights(t->s), sizeof *t->some.w);
    t->some.b = next_array(&at, units, sizeof *t->some.b);
    t->some.r = next_array(&at, units, 1);
    t->mu = next_array(&at, n * most, sizeof *t->mu);
    t->some_mu = next_array(&at, n, sizeof *t->some_mu);
    t->index = next_array(&at, n, sizeof *t->index);
    t->hidden = next_array(&at, n * t->n_hidden, sizeof *t->hidden);
    t->ctx = next_array(&at, n * t->s->head.feature_dim, sizeof *t->ctx);
    t->k = next_array(&at, n, sizeof *t->k);
    t->sigma = next_array(&at, n * most, 1);
    t->some_sigma = next_array(&at, n, 1);
}

static void walk_probability(ted4_coder *c, const char *name, int64_t index, uint16_t *prob)
{
    const size_t at = c->pos;
    const uint16_t value = (uint16_t)ted4_code(c, name, index, 2, *prob);

    ted4_require(c, value > 0, TED4_E_ENT_PROB, at);
    if (c->reads)
        *prob = value;
}

/* spec 9.1: codes everything but the substreams. */
static void walk_head(tile *t, unsigned number)
{
    ted4_coder *c = t->c;
    uint16_t *prob = t->s->prob + (size_t)number * TED4_PROBS;
    uint32_t size[MAX_SUBSTREAMS];
    size_t at = c->pos;

    ted4_require(c, ted4_code(c, "tile_index", 0, 4, number) == number, TED4_E_ENT_TILE_INDEX, at);
    if (t->s->head.temporal_mask)
        walk_probability(c, "dynamic_prob", 0, &prob[0]);
    for (int i = 0; t->s->head.offset_mask && i < 6; i++)
        walk_probability(c, "offset_prob", i, &prob[1 + i]);
    at = c->pos;
    c->ops->sizes(c, size, t->s->shape.n_substreams);
    for (unsigned i = 0; c->trace != NULL && i < t->s->shape.n_substreams; i++)
        if (c->error.code == TED4_OK)
            ted4_trace(c, at + 4 * i, "size", i, size[i]);
}

static void open_substream(tile *t, const char *name, unsigned index, size_t n)
{
    t->opened = t->c->pos;
    t->c->ops->open(t->c, n);
    ted4_trace(t->c, t->opened, name, index, (int64_t)n);
}

static void close_substream(tile *t)
{
    t->c->ops->close(t->c);
}

/* Sets the masks of anchor a that are not coded. A scene to be written must already have them,
 * because otherwise its hash would differ from the decoder's. */
static void imply(tile *t, size_t a, int dynamic_too, int offsets_too)
{
    ted4_scene *s = t->s;
    const uint8_t dynamic = s->head.motion != TED4_MOTION_NONE;
    const uint16_t all = (uint16_t)((1u << s->head.n_offsets) - 1);

    if (t->c->reads) {
        if (dynamic_too)
            s->dynamic[a] = dynamic;
        if (offsets_too)
            s->offset_bits[a] = all;
        return;
    }
    ted4_require(t->c,
                 (dynamic_too ? s->dynamic[a] == dynamic : s->dynamic[a] <= 1) &&
                     (offsets_too ? s->offset_bits[a] == all : s->offset_bits[a] <= all),
                 TED4_E_SYN_HASH, t->opened);
}

/* spec 9.3: codes the offset bits of anchor a. seen, the context, is 0 if all bits so far are 0, 1
 * if all are 1 or there are none yet, and 2 if they are mixed. */
static void walk_offset_bits(tile *t, size_t a, const uint16_t *prob)
{
    ted4_scene *s = t->s;
    const unsigned k_max = s->head.n_offsets, given = s->offset_bits[a];
    unsigned bits = 0, seen = 1;

    for (unsigned k = 0; k < k_max; k++) {
        const int bit = t->c->ops->bit(t->c, prob[3 * s->dynamic[a] + seen], given >> k & 1);

        ted4_trace(t->c, t->opened, "offset_bit", (int64_t)(a * k_max + k), bit);
        bits |= (unsigned)bit << k;
        seen = bits == 0 ? 0 : bits == (2u << k) - 1 ? 1 : 2;
    }
    if (t->c->reads)
        s->offset_bits[a] = (uint16_t)bits;
}

/* spec 9.3 */
static void walk_masks(tile *t, const uint16_t *prob)
{
    ted4_scene *s = t->s;
    const int temporal = s->head.temporal_mask, offset = s->head.offset_mask;

    if (temporal || offset)
        open_substream(t, "mask_substream", 0,
                       t->n * ((temporal ? 1u : 0u) + (offset ? s->head.n_offsets : 0u)));
    for (size_t a = t->first; a < t->first + t->n; a++) {
        imply(t, a, !temporal, !offset);
        if (t->c->error.code != TED4_OK)
            return;
        if (temporal) {
            const int bit = t->c->ops->bit(t->c, prob[0], s->dynamic[a]);

            ted4_trace(t->c, t->opened, "dynamic", (int64_t)a, bit);
            if (t->c->reads)
                s->dynamic[a] = (uint8_t)bit;
        }
        if (offset)
            walk_offset_bits(t, a, prob + 1);
    }
    if (temporal || offset)
        close_substream(t);
}

/* Returns the number of anchors in block b. */
static size_t block_size(const tile *t, size_t b)
{
    const size_t left = t->n - b * BLOCK;

    return left < BLOCK ? left : BLOCK;
}

/* Sets the step indices of n anchors from the outputs v. A scene to be written must already have
 * them. */
static void take_steps(tile *t, uint8_t *step, const int32_t *v, size_t n)
{
    if (t->c->reads) {
        for (size_t i = 0; i < n; i++)
            step[i] = ted4_step_index(v[i]);
        return;
    }
    for (size_t i = 0; i < n; i++)
        ted4_require(t->c, step[i] == ted4_step_index(v[i]), TED4_E_SYN_HASH, t->c->pos);
}

/* spec 10.1: evaluates all layers of the hyperprior but the last for the whole tile, and sets the
 * step indices. */
static void evaluate(tile *t)
{
    const ted4_shape *shape = &t->s->shape;

    ted4_prior_some(t->prior, shape->first_step_output, shape->first_step_output, shape->n_types,
                    &t->some);
    t->some.out = shape->n_types;
    for (size_t b = 0; b < t->n_blocks; b++) {
        const size_t a = t->first + b * BLOCK, n = block_size(t, b);
        int16_t *hidden = t->hidden + b * t->n_hidden * BLOCK;
        const int32_t *v = t->out;

        ted4_prior_hyper_hidden(t->prior, t->s->position + 3 * a, n, hidden);
        ted4_prior_hyper_some(t->prior, &t->some, hidden, n, t->out);
        for (int type = 0; type < TED4_TYPES; type++) {
            if (shape->dim[type] == 0)
                continue;
            take_steps(t, t->s->step_index[type] + a, v, n);
            v += BLOCK;
        }
    }
}

/* spec 10.3: adds the outputs of slice network m to mu and s of block b. */
static void add_slice(tile *t, size_t b, unsigned m)
{
    const size_t size = block_size(t, b), end = 2 * (size_t)t->s->head.slice[m] * BLOCK;

    ted4_prior_slice(t->prior, m, t->ctx + b * t->s->head.feature_dim * BLOCK, size, t->added);
    for (size_t row = 0; row < end; row += BLOCK)
        for (size_t i = row; i < row + size; i++)
            t->out[i] += t->added[i];
}

/* spec 10.1: evaluates the models of n components of a type from comp on, for the whole tile. m:
 * the slice if the type is feature, otherwise 0. */
static void evaluate_components(tile *t, ted4_type type, unsigned comp, unsigned n, unsigned m)
{
    const unsigned first = t->s->shape.first_output[type] + comp;

    ted4_prior_some(t->prior, first, first + t->s->shape.dim[type], n, &t->some);
    for (size_t b = 0; b < t->n_blocks; b++) {
        const size_t size = block_size(t, b);

        ted4_prior_hyper_some(t->prior, &t->some, t->hidden + b * t->n_hidden * BLOCK, size,
                              t->out);
        if (m > 0)
            add_slice(t, b, m);
        for (unsigned c = 0; c < n; c++) {
            const int32_t *mu = t->out + (size_t)c * BLOCK, *s = mu + (size_t)n * BLOCK;
            const size_t to = c * t->n_padded + b * BLOCK;
            uint8_t *sigma = t->sigma + to;

            memcpy(t->mu + to, mu, size * sizeof *mu);
            for (size_t i = 0; i < size; i++)
                sigma[i] = ted4_sigma_index(s[i]);
        }
    }
}

/* Set index to the anchors that have a component: all anchors, those that move, or those that keep
 * offset k. */
static void choose_all(tile *t)
{
    t->n_index = t->n;
    for (size_t i = 0; i < t->n; i++)
        t->index[i] = (uint32_t)i;
}

static void choose_dynamic(tile *t)
{
    const uint8_t *dynamic = t->s->dynamic + t->first;
    size_t n = 0;

    for (size_t i = 0; i < t->n; i++) {
        t->index[n] = (uint32_t)i;
        n += dynamic[i];
    }
    t->n_index = n;
}

static void choose_offset(tile *t, unsigned k)
{
    const uint16_t *bits = t->s->offset_bits + t->first;
    size_t n = 0;

    for (size_t i = 0; i < t->n; i++) {
        t->index[n] = (uint32_t)i;
        n += bits[i] >> k & 1;
    }
    t->n_index = n;
}

/* Copies the models of the chosen anchors. */
static void pick_models(tile *t, const int32_t *mu, const uint8_t *sigma)
{
    const uint32_t *index = t->index;
    int32_t *some_mu = t->some_mu;
    uint8_t *some_sigma = t->some_sigma;

    for (size_t j = 0, n = t->n_index; j < n; j++) {
        some_mu[j] = mu[index[j]];
        some_sigma[j] = sigma[index[j]];
    }
}

/* spec 10.2: codes component comp of a type for the chosen anchors. i is its index among the
 * components that were evaluated last. */
static void walk_component(tile *t, ted4_type type, unsigned comp, unsigned i)
{
    const size_t row = (size_t)comp * t->s->head.n_anchors + t->first;
    const int32_t *mu = t->mu + i * t->n_padded;
    const uint8_t *sigma = t->sigma + i * t->n_padded;
    int16_t *symbol = t->s->symbol[type] + row;
    const int some = t->n_index != t->n;
    int16_t *k = some ? t->k : symbol;

    if (t->c->error.code != TED4_OK)
        return;
    if (some) {
        pick_models(t, mu, sigma);
        mu = t->some_mu;
        sigma = t->some_sigma;
    }
    for (size_t j = 0; some && !t->c->reads && j < t->n_index; j++)
        k[j] = symbol[t->index[j]];
    t->c->ops->gauss(t->c, t->n_index, mu, sigma, k);
    for (size_t j = 0; some && t->c->reads && j < t->n_index; j++)
        symbol[t->index[j]] = k[j];
    for (size_t j = 0; t->c->reads && t->c->trace != NULL && j < t->n_index; j++)
        ted4_trace(t->c, t->opened, type_name[type], (int64_t)(row + t->index[j]), k[j]);
}

/* spec 10.3: stores the context of one feature component for the following slices. */
static void keep_context(tile *t, unsigned comp)
{
    const ted4_scene *s = t->s;
    const int16_t *k = s->symbol[TED4_FEATURE] + (size_t)comp * s->head.n_anchors + t->first;
    const uint8_t *step = s->step_index[TED4_FEATURE] + t->first;
    const unsigned bits = s->head.context_bits;

    for (size_t b = 0; b < t->n_blocks; b++, k += BLOCK, step += BLOCK) {
        const size_t n = block_size(t, b);
        int16_t *x = t->ctx + (b * s->head.feature_dim + comp) * BLOCK;

        for (size_t i = 0; i < n; i++)
            x[i] = ted4_context(k[i], step[i], bits);
        memset(x + n, 0, (BLOCK - n) * sizeof *x);
    }
}

/* spec 9.1, 10.3 */
static void walk_feature(tile *t)
{
    const ted4_header *h = &t->s->head;
    unsigned comp = 0;

    choose_all(t);
    for (unsigned m = 0; m < h->n_slices; m++) {
        evaluate_components(t, TED4_FEATURE, comp, h->slice[m], m);
        open_substream(t, substream_name[TED4_FEATURE], m, t->n * h->slice[m]);
        for (unsigned i = 0; i < h->slice[m]; i++, comp++) {
            walk_component(t, TED4_FEATURE, comp, i);
            if (t->c->error.code != TED4_OK)
                return;
            if (m + 1 < h->n_slices)
                keep_context(t, comp);
        }
        close_substream(t);
    }
}

/* Codes a type all of whose components have the chosen anchors. */
static void walk_type(tile *t, ted4_type type)
{
    const unsigned dim = t->s->shape.dim[type];

    if (dim == 0)
        return;
    open_substream(t, substream_name[type], 0, t->n_index * dim);
    evaluate_components(t, type, 0, dim, 0);
    for (unsigned i = 0; i < dim; i++)
        walk_component(t, type, i, i);
    close_substream(t);
}

static void walk_offsets(tile *t)
{
    const unsigned k_max = t->s->head.n_offsets;
    size_t n = 0;

    for (unsigned k = 0; k < k_max; k++) {
        choose_offset(t, k);
        n += 3 * t->n_index;
    }
    open_substream(t, substream_name[TED4_OFFSET], 0, n);
    for (unsigned k = 0; k < k_max; k++) {
        const unsigned i = k % OFFSETS, left = k_max - (k - i);
        const unsigned some = left < OFFSETS ? left : OFFSETS;

        if (i == 0)
            evaluate_components(t, TED4_OFFSET, 3 * k, 3 * some, 0);
        choose_offset(t, k);
        for (unsigned j = 0; j < 3; j++)
            walk_component(t, TED4_OFFSET, 3 * k + j, 3 * i + j);
    }
    close_substream(t);
}

/* R-ATT-001 */
static void judge_tau(tile *t)
{
    const size_t n = t->s->head.n_anchors;
    const int16_t *start, *end;

    if (t->s->shape.dim[TED4_TAU] == 0 || t->c->error.code != TED4_OK)
        return;
    start = t->s->symbol[TED4_TAU] + t->first;
    end = start + 2 * n;
    for (size_t i = 0; i < t->n; i++)
        ted4_require(t->c, start[i] <= end[i], TED4_E_ATT_TAU_ORDER, t->opened);
}

/* spec 9.1 */
void ted4_walk_tile(ted4_coder *c, ted4_scene *s, const ted4_prior *prior, unsigned number,
                    void *work)
{
    tile t = { .c = c, .s = s, .prior = prior };

    t.first = (size_t)number * s->head.tile_size;
    t.n = s->head.n_anchors - t.first;
    if (t.n > s->head.tile_size)
        t.n = s->head.tile_size;
    t.n_blocks = block_count(t.n);
    carve(&t, work);
    walk_head(&t, number);
    walk_masks(&t, s->prob + (size_t)number * TED4_PROBS);
    if (c->error.code != TED4_OK)
        return;
    evaluate(&t);
    walk_feature(&t);
    choose_all(&t);
    walk_type(&t, TED4_SCALING);
    walk_offsets(&t);
    choose_dynamic(&t);
    walk_type(&t, TED4_PHI);
    choose_all(&t);
    walk_type(&t, TED4_TAU);
    judge_tau(&t);
}
