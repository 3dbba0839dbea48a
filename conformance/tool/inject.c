/* inject.c - see inject.h. Wraps the writing coder and codes one symbol differently.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "inject.h"

#include <stdlib.h>
#include <string.h>
#include "write/coder_write.h"
#include "write/gauss_put.h"
#include "write/tiles.h"

typedef struct {
    ted4_writer w; /* must be first: the coder's operations take it as a writer */
    const ted4_coder_ops *plain;
    const conf_injection *what;
    unsigned n_opened;
    size_t n_symbols; /* symbols of the open substream so far */
} injector;

static injector *injector_of(ted4_coder *c)
{
    return (injector *)c;
}

static void open_substream(ted4_coder *c, size_t n)
{
    injector *j = injector_of(c);

    j->n_opened++;
    j->n_symbols = 0;
    j->plain->open(c, n);
}

static void put(void *encoder, ted4_slots s)
{
    ted4_rans_enc_put(encoder, s);
}

/* Writes the bits of E = value: b ones, a zero, and the b low bits (zeros above bit 63). */
static void put_number(ted4_rans_enc *e, uint64_t value, unsigned b)
{
    const uint32_t half = TED4_RANS_LOW / 2;

    for (unsigned i = 0; i < b; i++)
        put(e, (ted4_slots) { half, half });
    put(e, (ted4_slots) { 0, half });
    for (unsigned i = b; i > 0; i--)
        put(e, (ted4_slots) { i > 64 ? 0 : (uint32_t)(value >> (i - 1) & 1) * half, half });
}

static void put_escape(ted4_rans_enc *e, int32_t mu, unsigned g, int high, uint64_t value,
                       unsigned b)
{
    const int32_t fr = mu - ted4_floor_shift(mu, TED4_MU_BITS) * 256;
    const uint32_t j = high ? ted4_gauss_size(g) - 1 : 0;
    const uint32_t from = ted4_gauss_cum(g, fr, j);

    put(e, (ted4_slots) { from, ted4_gauss_cum(g, fr, j + 1) - from });
    put_number(e, value, b);
}

static unsigned log2_of(uint64_t x)
{
    unsigned n = 0;

    while (x >> (n + 1) != 0)
        n++;
    return n;
}

static void put_forbidden(ted4_rans_enc *e, const conf_injection *what, int32_t mu, unsigned g)
{
    const int32_t hw = ted4_half[g], m = ted4_floor_shift(mu, TED4_MU_BITS);
    const int64_t r = what->value - m;

    if (what->way == CONF_INJECT_ONES)
        put_escape(e, mu, g, what->high, 0, (unsigned)what->value);
    else if (what->way == CONF_INJECT_ESCAPE)
        put_escape(e, mu, g, what->high, (uint64_t)what->value + 1,
                   log2_of((uint64_t)what->value + 1));
    else if (r < -hw)
        put_escape(e, mu, g, 0, (uint64_t)(-hw - r), log2_of((uint64_t)(-hw - r)));
    else if (r > hw + 1)
        put_escape(e, mu, g, 1, (uint64_t)(r - hw - 1), log2_of((uint64_t)(r - hw - 1)));
    else
        put(e, ted4_gauss_of(mu, g, (int32_t)what->value).slots);
}

static void gauss(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    injector *j = injector_of(c);

    for (size_t i = 0; i < n; i++, j->n_symbols++) {
        if (j->what->way != CONF_INJECT_NOTHING && j->n_opened == j->what->substream + 1 &&
            j->n_symbols == j->what->symbol)
            put_forbidden(&j->w.rans, j->what, mu[i], sigma[i]);
        else
            (void)ted4_gauss_put(mu[i], sigma[i], k[i], put, &j->w.rans);
        ted4_rans_enc_next(&j->w.rans);
    }
}

void conf_inject(conf_bytes *payload, const ted4_scene *s, unsigned tile,
                 const conf_injection *what)
{
    ted4_coder_ops ops;
    ted4_draft d;
    injector j = { .what = what };
    void *work;

    if (ted4_draft_init(&d, s) != TED4_OK ||
        ted4_prior_load(&d.prior, s->nete.values, s->shift, NULL) != TED4_OK)
        conf_die("no draft of a tile");
    work = ted4_arena_alloc(&d.arena, 1, ted4_tile_work_size(&d.s));
    if (work == NULL)
        conf_die("no memory");
    ted4_writer_init(&j.w);
    j.plain = j.w.base.ops;
    ops = *j.plain;
    ops.open = open_substream;
    ops.gauss = gauss;
    j.w.base.ops = &ops;
    ted4_walk_tile(&j.w.base, &d.s, &d.prior, tile, work);
    conf_add(payload, j.w.out.data, j.w.out.size);
    ted4_writer_finish(&j.w);
    ted4_draft_finish(&d);
}
