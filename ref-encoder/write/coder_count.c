/* coder_count.c - the coder that counts bits.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "write/coder_count.h"

#include <string.h>
#include "math/elementary.h"
#include "write/gauss_put.h"

static ted4_counter *counter_of(ted4_coder *c)
{
    return (ted4_counter *)c;
}

static uint32_t number(ted4_coder *c, unsigned width, uint32_t value)
{
    counter_of(c)->frame += 8 * width;
    return value;
}

static void array(ted4_coder *c, unsigned width, void *values, uint64_t n)
{
    (void)values;
    counter_of(c)->frame += 8.0 * width * (double)n;
}

static void deflated(ted4_coder *c, ted4_blob *b)
{
    counter_of(c)->frame += 8.0 * (double)b->deflated_size;
}

static void sizes(ted4_coder *c, uint32_t *size, unsigned n)
{
    memset(size, 0, n * sizeof *size);
    counter_of(c)->frame += 32.0 * n;
}

/* The state of a lane takes 32 bits. 16 of them carry information about its symbols, so that 16
 * count as overhead. */
static void open_substream(ted4_coder *c, size_t n)
{
    ted4_counter *counter = counter_of(c);

    counter->n_opened++;
    if (n > 0)
        counter->frame += 16.0 * ted4_rans_lanes(n);
}

static void close_substream(ted4_coder *c)
{
    (void)c;
}

static void rest(ted4_coder *c, uint64_t n)
{
    (void)c;
    (void)n;
}

static void put(void *counter, ted4_slots s)
{
    ted4_counter *n = counter;

    n->substream[n->n_opened - 1] += TED4_SLOT_BITS - ted4_math_log2(s.freq);
}

static int bit(ted4_coder *c, uint32_t prob, int value)
{
    if (c->error.code == TED4_OK)
        put(c, (ted4_slots) { 0, value ? prob : TED4_RANS_LOW - prob });
    return value;
}

static void gauss(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    for (size_t i = 0; i < n && c->error.code == TED4_OK; i++) {
        const ted4_status s = ted4_gauss_put(mu[i], sigma[i], k[i], put, c);

        ted4_require(c, s == TED4_OK, s, 0);
    }
}

void ted4_counter_init(ted4_counter *n)
{
    static const ted4_coder_ops ops = { number,          array, deflated, sizes, open_substream,
                                        close_substream, bit,   gauss,    rest };

    memset(n, 0, sizeof *n);
    n->base.ops = &ops;
}
