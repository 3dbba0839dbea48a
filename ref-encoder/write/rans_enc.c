/* rans_enc.c - spec 9.2 in reverse: undoes the steps of the decoder in reverse order, starting from
 * the state in which the decoder has to end.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "write/rans_enc.h"

#include <stdlib.h>
#include "base/bytes.h"

void ted4_rans_enc_free(ted4_rans_enc *e)
{
    free(e->record);
    e->record = NULL;
    e->n = e->capacity = 0;
}

void ted4_rans_enc_init(ted4_rans_enc *e, size_t n)
{
    e->n = 0;
    e->n_lanes = ted4_rans_lanes(n);
    e->lane = 0;
}

void ted4_rans_enc_put(ted4_rans_enc *e, ted4_slots s)
{
    if (e->n == e->capacity) {
        const size_t capacity = 2 * e->capacity + 4096;
        ted4_rans_record *r = realloc(e->record, capacity * sizeof *r);

        if (r == NULL) {
            e->failed = 1;
            return;
        }
        e->record = r;
        e->capacity = capacity;
    }
    e->record[e->n++] =
        (ted4_rans_record) { (uint16_t)s.start, (uint16_t)s.freq, (uint8_t)e->lane };
}

/* The inverse of ted4_rans_dec_take(), which computes:
 *     x = freq (x >> 16) + (x & 0xffff) - start;  if (x < 2^16) x = x << 16 | word
 * Returns 1 with *word filled if the decoder will read a word, and 0 otherwise. */
static int push(uint32_t *x, ted4_rans_record r, uint16_t *word)
{
    const int full = *x >> 16 >= r.freq;

    if (full) {
        *word = (uint16_t)*x;
        *x >>= 16;
    }
    *x = (*x / r.freq << 16) + *x % r.freq + r.start;
    return full;
}

void ted4_rans_enc_finish(ted4_rans_enc *e, ted4_buffer *out)
{
    uint32_t state[TED4_MAX_LANES];
    uint16_t *words = malloc((e->n + 1) * sizeof *words);
    size_t n_words = 0;
    uint8_t *p;

    if (words == NULL || e->failed) {
        free(words);
        out->failed = 1;
        return;
    }
    for (unsigned i = 0; i < e->n_lanes; i++)
        state[i] = TED4_RANS_LOW;
    for (size_t i = e->n; i > 0; i--)
        n_words += (size_t)push(&state[e->record[i - 1].lane], e->record[i - 1], &words[n_words]);
    p = ted4_buffer_add(out, 4 * (size_t)e->n_lanes + 2 * n_words);
    for (unsigned i = 0; p != NULL && i < e->n_lanes; i++, p += 4)
        ted4_store32(p, state[i]);
    for (size_t i = n_words; p != NULL && i > 0; i--, p += 2)
        ted4_store16(p, words[i - 1]);
    free(words);
}
