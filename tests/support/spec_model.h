/* spec_model.h - a whole decoder made of the code that the specification prints (decode_file of
 * annex M). Shares nothing with ref-decoder but the tables of annex A. Slow, plain; for tests, a
 * fuzzer and the generator of annex B. spec/code.h is extracted from spec/ by tests/spec/code.awk
 * (see spec.mk).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPEC_MODEL_H
#define TED4_SPEC_MODEL_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "tests/spec/names.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "spec/code.h"
#pragma GCC diagnostic pop

/* p.v is the verdict; p.v.id NULL: valid, and p.s is filled. */
typedef struct {
    struct pass_2 p;
    void *block[32]; /* owned */
    int n_blocks;
    void (*tile_done)(void *user,
                      uint32_t number); /* NULL, or called when a tile has been decoded */
    void *user;
} spec_model;

/* Memory of the printed code: never NULL. user: the spec_model, which keeps the block. */
static inline void *spec_room(void *user, uint64_t n, size_t size)
{
    spec_model *m = user;
    void *p = calloc((size_t)n + 1, size);

    if (p == NULL || m->n_blocks == (int)(sizeof m->block / sizeof *m->block))
        abort();
    return m->block[m->n_blocks++] = p;
}

static inline void spec_model_free(spec_model *m)
{
    while (m->n_blocks > 0)
        free(m->block[--m->n_blocks]);
}

/* Sum of inputs x outputs of one network. */
static inline uint64_t spec_products(const struct net *n)
{
    uint64_t sum = 0;

    for (int i = 0; i < n->n_layers; i++)
        sum += (uint64_t)n->dim[i] * (uint64_t)n->dim[i + 1];
    return sum;
}

/* What decode_file does, with a word to the caller after each tile. */
static inline void spec_decode_tiles(spec_model *m)
{
    struct pass_2 *p = &m->p;

    p->v = pass_1(p->file, p->size);
    for (uint64_t at = 12; p->v.id == NULL && at < p->size;
         at += 20 + (uint64_t)load32(p->file + at + 8)) {
        const uint64_t before = p->tiles_seen;

        judge_payload(p, at);
        if (p->v.id == NULL && p->tiles_seen > before)
            m->tile_done(m->user, (uint32_t)before);
    }
}

/* m: zeroed but for tile_done and user; free it in any case. */
static inline void spec_model_decode(spec_model *m, const uint8_t *file, uint64_t size)
{
    m->p.file = file;
    m->p.size = size;
    m->p.room = spec_room;
    m->p.user = m;
    if (m->tile_done != NULL)
        spec_decode_tiles(m);
    else
        decode_file(&m->p);
}

#endif
