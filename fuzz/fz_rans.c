/* fz_rans.c - substreams: u8 kind, u8 n, then n models, then bytes. Kind 0: symbols from the input
 * pass through writer and reader. Kind 1: the rest of the input is itself a substream. Claims: what
 * is written is read back, with the coder in its final state at the last byte (R-ENT-005), and a
 * byte more or less is refused; a substream that is accepted equals the one that the writer makes
 * from its symbols.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "harness.h"
#include "read/reader.h"
#include "write/coder_write.h"

enum { MAX_N = 255, SIZES = 4 };

/* Each symbol is of one of two kinds: a bit with a probability, or k with its mu and sigma. */
typedef struct {
    unsigned n;
    uint8_t is_bit[MAX_N], sigma[MAX_N];
    uint16_t prob[MAX_N];
    int32_t mu[MAX_N];
    int16_t k[MAX_N];
} symbols;

static void take_models(fuzz_source *in, symbols *s)
{
    s->n = 1 + fuzz_u8(in) % MAX_N;
    for (unsigned i = 0; i < s->n; i++) {
        const uint8_t g = fuzz_u8(in);

        s->is_bit[i] = g >= TED4_N_SIGMA;
        s->sigma[i] = g % TED4_N_SIGMA;
        s->prob[i] = (uint16_t)(1 + fuzz_u16(in) % 65535);
        s->mu[i] = (int16_t)s->prob[i] * (1 << g % 3 * 6);
        s->k[i] = s->is_bit[i] ? 0 : (int16_t)fuzz_u16(in);
    }
}

/* Codes all symbols with a writer or a reader. */
static void walk(ted4_coder *c, symbols *s)
{
    uint32_t size;

    c->ops->sizes(c, &size, 1);
    c->ops->open(c, s->n);
    for (unsigned i = 0; i < s->n; i++)
        if (s->is_bit[i])
            s->k[i] = (int16_t)c->ops->bit(c, s->prob[i], s->k[i]);
        else
            c->ops->gauss(c, 1, &s->mu[i], &s->sigma[i], &s->k[i]);
    c->ops->close(c);
}

static ted4_status read_all(const uint8_t *data, size_t size, symbols *s)
{
    ted4_reader r;

    ted4_reader_init(&r, data, 0, size, 0);
    walk(&r.base, s);
    fuzz_require(r.base.error.code != TED4_OK || r.base.pos == size, "every byte read");
    return r.base.error.code;
}

static void there_and_back(symbols *s)
{
    symbols back = *s;
    ted4_writer w;
    uint8_t *d;

    for (unsigned i = 0; i < s->n; i++)
        if (s->is_bit[i])
            s->k[i] &= 1;
        else if (s->k[i] == INT16_MIN)
            s->k[i] = 0;
    ted4_writer_init(&w);
    walk(&w.base, s);
    fuzz_require(w.base.error.code == TED4_OK, "written");
    fuzz_require(read_all(w.out.data, w.out.size, &back) == TED4_OK, "read");
    fuzz_require(memcmp(back.k, s->k, s->n * sizeof *s->k) == 0, "the same symbols");
    d = calloc(w.out.size + 2, 1);
    fuzz_require(d != NULL, "memory");
    memcpy(d, w.out.data, w.out.size);
    for (int more = -2; more <= 2; more++)
        if (more != 0) {
            const size_t size = w.out.size + (size_t)more;

            ted4_store32(d, (uint32_t)(size - SIZES));
            fuzz_require(read_all(d, size, &back) != TED4_OK, "another length is refused");
        }
    free(d);
    ted4_writer_finish(&w);
}

static void any_bytes(fuzz_source *in, symbols *s)
{
    const size_t n = (size_t)(in->end - in->at);
    uint8_t *const d = malloc(n + SIZES);
    ted4_writer w;

    fuzz_require(d != NULL, "memory");
    ted4_store32(d, (uint32_t)n);
    memcpy(d + SIZES, in->at, n);
    if (read_all(d, n + SIZES, s) == TED4_OK) {
        ted4_writer_init(&w);
        walk(&w.base, s);
        fuzz_require(w.base.error.code == TED4_OK && w.out.size == n + SIZES &&
                         memcmp(w.out.data, d, n + SIZES) == 0,
                     "the writer's own bytes");
        ted4_writer_finish(&w);
    }
    free(d);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static symbols s;
    fuzz_source in = { data, data + size };
    const int kind = fuzz_u8(&in) & 1;

    if (size < 2)
        return 0;
    take_models(&in, &s);
    if (kind == 0)
        there_and_back(&s);
    else
        any_bytes(&in, &s);
    return 0;
}
