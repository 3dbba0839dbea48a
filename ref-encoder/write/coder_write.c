/* coder_write.c - the coder that writes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "write/coder_write.h"

#include <string.h>
#include "base/bytes.h"
#include "write/gauss_put.h"

static ted4_writer *writer_of(ted4_coder *c)
{
    return (ted4_writer *)c;
}

/* Appends size bytes and returns a pointer to them, or NULL after a failure. */
static uint8_t *add(ted4_coder *c, size_t size)
{
    ted4_writer *w = writer_of(c);
    uint8_t *p;

    if (c->error.code != TED4_OK)
        return NULL;
    p = ted4_buffer_add(&w->out, size);
    ted4_require(c, p != NULL, TED4_E_LIMIT_MEMORY, c->pos);
    c->pos = w->out.size;
    return p;
}

static void store(uint8_t *p, unsigned width, uint32_t value)
{
    if (width == 1)
        *p = (uint8_t)value;
    else if (width == 2)
        ted4_store16(p, (uint16_t)value);
    else
        ted4_store32(p, value);
}

static uint32_t number(ted4_coder *c, unsigned width, uint32_t value)
{
    uint8_t *p = add(c, width);

    if (p != NULL)
        store(p, width, value);
    return value;
}

static void array(ted4_coder *c, unsigned width, void *values, uint64_t n)
{
    uint8_t *p = add(c, (size_t)n * width);
    const char *from = values;

    for (size_t i = 0; p != NULL && i < n; i++) {
        uint8_t v1;
        uint16_t v2;
        uint32_t v4;

        if (width == 1) {
            memcpy(&v1, from + i, 1);
            v4 = v1;
        } else if (width == 2) {
            memcpy(&v2, from + 2 * i, 2);
            v4 = v2;
        } else {
            memcpy(&v4, from + 4 * i, 4);
        }
        store(p + i * width, width, v4);
    }
}

static void deflated(ted4_coder *c, ted4_blob *b)
{
    uint8_t *p = add(c, b->deflated_size);

    if (p != NULL)
        memcpy(p, b->deflated, b->deflated_size);
}

static void sizes(ted4_coder *c, uint32_t *size, unsigned n)
{
    writer_of(c)->sizes = c->pos;
    writer_of(c)->least = 0;
    memset(size, 0, n * sizeof *size);
    array(c, 4, size, n);
}

static void rest(ted4_coder *c, uint64_t n)
{
    writer_of(c)->sizes = SIZE_MAX;
    writer_of(c)->least = ted4_rest_least(n);
}

static void open_substream(ted4_coder *c, size_t n)
{
    ted4_writer *w = writer_of(c);

    w->opened = c->pos;
    w->n_symbols = n;
    if (n > 0)
        ted4_rans_enc_init(&w->rans, n);
}

static void close_substream(ted4_coder *c)
{
    ted4_writer *w = writer_of(c);

    if (c->error.code != TED4_OK)
        return;
    if (w->n_symbols > 0)
        ted4_rans_enc_finish(&w->rans, &w->out);
    if (!ted4_require(c, !w->out.failed, TED4_E_LIMIT_MEMORY, c->pos))
        return;
    c->pos = w->out.size;
    ted4_require(c, c->pos - w->opened >= w->least, TED4_E_ENT_SIZE, w->opened);
    if (w->sizes == SIZE_MAX)
        return;
    ted4_store32(w->out.data + w->sizes, (uint32_t)(c->pos - w->opened));
    w->sizes += 4;
}

static int bit(ted4_coder *c, uint32_t prob, int value)
{
    ted4_rans_enc *e = &writer_of(c)->rans;

    if (c->error.code == TED4_OK) {
        ted4_rans_enc_put(e, value ? (ted4_slots) { 0, prob }
                                   : (ted4_slots) { prob, TED4_RANS_LOW - prob });
        ted4_rans_enc_next(e);
    }
    return value;
}

static void put(void *encoder, ted4_slots s)
{
    ted4_rans_enc_put(encoder, s);
}

static void gauss(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    ted4_writer *w = writer_of(c);

    for (size_t i = 0; i < n && c->error.code == TED4_OK; i++) {
        const ted4_status s = ted4_gauss_put(mu[i], sigma[i], k[i], put, &w->rans);

        ted4_require(c, s == TED4_OK, s, w->opened);
        ted4_rans_enc_next(&w->rans);
    }
}

void ted4_writer_init(ted4_writer *w)
{
    static const ted4_coder_ops ops = { number,          array, deflated, sizes, open_substream,
                                        close_substream, bit,   gauss,    rest };

    memset(w, 0, sizeof *w);
    w->base.ops = &ops;
}

void ted4_writer_finish(ted4_writer *w)
{
    ted4_buffer_free(&w->out);
    ted4_rans_enc_free(&w->rans);
}
