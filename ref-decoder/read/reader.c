/* reader.c - the coder that reads a file in memory. It checks that elements lie within the file or
 * the payload, so that walks need not.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/reader.h"

#include <string.h>
#include "read/inflate.h"

static ted4_reader *reader_of(ted4_coder *c)
{
    return (ted4_reader *)c;
}

/* Ends the trace after a failure and returns NULL. Walks need not check for errors before each
 * element, since elements behind the first error are not traced. */
static const uint8_t *nothing(ted4_coder *c)
{
    c->trace = NULL;
    return NULL;
}

/* Returns the next size bytes, or NULL after a failure. */
static const uint8_t *take(ted4_coder *c, size_t size)
{
    ted4_reader *r = reader_of(c);
    const uint8_t *p;

    if (c->error.code != TED4_OK)
        return nothing(c);
    if (r->end - c->pos < size) {
        if (r->whole_file)
            ted4_fail(&c->error, TED4_E_CON_TRUNCATED, r->end);
        else
            ted4_fail(&c->error, TED4_E_CON_PAYLOAD_SIZE, c->pos);
        return nothing(c);
    }
    /* The pointer is made only after the checks, since data may be NULL if the file is empty. */
    p = r->data + c->pos;
    c->pos += size;
    return p;
}

static uint32_t number(ted4_coder *c, unsigned width, uint32_t value)
{
    const uint8_t *p = take(c, width);

    (void)value;
    if (p == NULL)
        return 0;
    return width == 1 ? p[0] : width == 2 ? ted4_load16(p) : ted4_load32(p);
}

static void array(ted4_coder *c, unsigned width, void *values, uint64_t n)
{
    const uint8_t *p;

    if (n > SIZE_MAX / width) {
        ted4_fail(&c->error, TED4_E_CON_PAYLOAD_SIZE, c->pos);
        (void)nothing(c);
        return;
    }
    p = take(c, (size_t)n * width);
    if (p == NULL)
        return;
    if (width == 1)
        memcpy(values, p, (size_t)n);
    for (size_t i = 0; width == 2 && i < n; i++) {
        const uint16_t v = ted4_load16(p + 2 * i);

        memcpy((char *)values + 2 * i, &v, sizeof v);
    }
    for (size_t i = 0; width == 4 && i < n; i++) {
        const uint32_t v = ted4_load32(p + 4 * i);

        memcpy((char *)values + 4 * i, &v, sizeof v);
    }
}

static void deflated(ted4_coder *c, ted4_blob *b)
{
    ted4_reader *r = reader_of(c);
    const size_t at = c->pos, size = r->end - at;
    const uint8_t *p = take(c, size);
    ted4_status verdict;

    if (p == NULL)
        return;
    verdict = ted4_inflate(r->arena, p, size, b->values, b->n);
    if (verdict != TED4_OK) {
        ted4_fail(&c->error, verdict, at);
        return;
    }
    b->deflated = ted4_arena_alloc(r->arena, size, 1);
    if (b->deflated == NULL) {
        ted4_fail(&c->error, TED4_E_LIMIT_MEMORY, at);
        return;
    }
    memcpy(b->deflated, p, size);
    b->deflated_size = size;
}

/* Reads the sizes of the substreams of a tile and checks their sum (R-ENT-003). */
static void sizes(ted4_coder *c, uint32_t *size, unsigned n)
{
    ted4_reader *r = reader_of(c);
    const size_t at = c->pos;
    uint64_t sum = 0;

    memset(size, 0, n * sizeof *size);
    array(c, 4, size, n);
    memcpy(r->size, size, n * sizeof *size);
    r->n_opened = 0;
    for (unsigned i = 0; i < n; i++)
        sum += size[i];
    ted4_require(c, sum == r->end - c->pos, TED4_E_CON_PAYLOAD_SIZE, at);
}

/* spec 9.5. A substream that is too small for n is found before its state is looked at. */
static void rest(ted4_coder *c, uint64_t n)
{
    ted4_reader *r = reader_of(c);
    const size_t size = r->end - c->pos;

    if (c->error.code != TED4_OK)
        return;
    ted4_require(c, size >= ted4_rest_least(n), TED4_E_ENT_SIZE, c->pos);
    r->size[0] = (uint32_t)size; /* part of a chunk */
    r->n_opened = 0;
}

static void open_substream(ted4_coder *c, size_t n)
{
    ted4_reader *r = reader_of(c);
    ted4_status verdict;

    if (c->error.code != TED4_OK)
        return;
    r->opened = c->pos;
    r->n_symbols = n;
    if (n > 0)
        verdict = ted4_rans_dec_init(&r->rans, r->data + c->pos, r->size[r->n_opened], n);
    else
        verdict = r->size[r->n_opened] == 0 ? TED4_OK : TED4_E_ENT_SIZE;
    ted4_require(c, verdict == TED4_OK, verdict, r->opened);
    c->pos += r->size[r->n_opened++];
}

static void close_substream(ted4_coder *c)
{
    ted4_reader *r = reader_of(c);

    if (c->error.code == TED4_OK && r->n_symbols > 0)
        ted4_require(c, ted4_rans_dec_finish(&r->rans) == TED4_OK, TED4_E_ENT_FINAL, r->opened);
}

static int bit(ted4_coder *c, uint32_t prob, int value)
{
    ted4_reader *r = reader_of(c);
    const int one = ted4_rans_dec_slot(&r->rans) < prob;

    (void)value;
    if (c->error.code != TED4_OK)
        return 0;
    ted4_rans_dec_take(&r->rans, one ? (ted4_slots) { 0, prob }
                                     : (ted4_slots) { prob, TED4_RANS_LOW - prob });
    ted4_rans_dec_next(&r->rans);
    ted4_require(c, !r->rans.underrun, TED4_E_ENT_UNDERRUN, r->opened);
    return one;
}

/* Reads one bit of an escape from the lane of its symbol. */
static uint32_t escape_bit(ted4_rans_dec *d)
{
    const uint32_t half = TED4_RANS_LOW / 2;
    const uint32_t one = ted4_rans_dec_slot(d) >= half;

    ted4_rans_dec_take(d, (ted4_slots) { one * half, half });
    return one;
}

/* Reads an escape (spec 9.4, Escapes). Returns e >= 0, or -1 if the escape is too long or a word is
 * missing. */
static int32_t escape(ted4_rans_dec *d)
{
    uint32_t value = 1, n = 0;

    while (escape_bit(d))
        if (++n > TED4_ESCAPE_BITS || d->underrun)
            return -1;
    for (; n > 0; n--)
        value = 2 * value + escape_bit(d);
    return (int32_t)value - 1;
}

/* Reads one symbol (spec 9.4). */
static int32_t gauss_symbol(ted4_coder *c, int32_t mu, unsigned g)
{
    ted4_reader *r = reader_of(c);
    ted4_rans_dec *d = &r->rans;
    const int32_t m = ted4_floor_shift(mu, TED4_MU_BITS);
    ted4_slots slots;
    const uint32_t j =
        ted4_gauss_find(g, mu - m * (1 << TED4_MU_BITS), ted4_rans_dec_slot(d), &slots);
    int32_t k;

    ted4_rans_dec_take(d, slots);
    if (j == 0 || j == ted4_gauss_size(g) - 1) {
        const int32_t e = escape(d);

        ted4_require(c, !d->underrun, TED4_E_ENT_UNDERRUN, r->opened);
        ted4_require(c, e >= 0, TED4_E_ENT_ESCAPE, r->opened);
        k = m + ted4_gauss_escaped(g, j, e);
    } else {
        k = m + ted4_gauss_offset(g, j);
    }
    ted4_require(c, !d->underrun, TED4_E_ENT_UNDERRUN, r->opened);
    ted4_require(c, k >= -32767 && k <= 32767, TED4_E_ENT_SYMBOL_RANGE, r->opened);
    ted4_rans_dec_next(d);
    return k;
}

/* Reads up to n symbols with the vector kernel, and returns how many it has read. */
static size_t gauss_many(ted4_reader *r, size_t n, const int32_t *mu, const uint8_t *sigma,
                         int16_t *k)
{
    ted4_rans_dec *d = &r->rans;
    ted4_gauss_lanes lanes = { d->state, d->n_lanes, d->lane, d->word, d->end };
    const size_t done = r->many(&lanes, n, mu, sigma, k);

    d->word = lanes.word;
    d->lane = (d->lane + (unsigned)done) & (d->n_lanes - 1);
    return done;
}

/* Uses the vector kernel where there is one; symbols that it does not read are read one by one. */
static void gauss(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    ted4_reader *r = reader_of(c);
    const int many = r->many != NULL && r->rans.n_lanes >= TED4_MANY_LANES;

    for (size_t i = 0; i < n && c->error.code == TED4_OK; i++) {
        if (many)
            i += gauss_many(r, n - i, mu + i, sigma + i, k + i);
        if (i < n)
            k[i] = (int16_t)gauss_symbol(c, mu[i], sigma[i]);
    }
}

void ted4_reader_init(ted4_reader *r, const uint8_t *data, size_t pos, size_t end, int whole_file)
{
    static const ted4_coder_ops ops = { number,          array, deflated, sizes, open_substream,
                                        close_substream, bit,   gauss,    rest };

    memset(r, 0, sizeof *r);
    r->base.ops = &ops;
    r->base.reads = 1;
    r->base.pos = pos;
    r->data = data;
    r->end = end;
    r->whole_file = whole_file;
}
