/* substream_case.h - symbols with their models, and the substream that write/coder_write.c makes of
 * them, for tests of its readers.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef SUBSTREAM_CASE_H
#define SUBSTREAM_CASE_H

#include <stdlib.h>
#include "random_scene.h"
#include "test.h"
#include "write/coder_write.h"

/* n symbols with their models: means in 1/256, indices of sigma. */
typedef struct {
    size_t n;
    int32_t *mu;
    uint8_t *sigma;
    int16_t *k;
} symbols;

/* far: one symbol in so many needs an escape; 0: none. widest: the largest index of sigma; the
 * wider the distributions, the less predictable the symbols. */
static inline symbols symbols_make(uint64_t seed, size_t n, unsigned far, unsigned widest)
{
    random_source r = random_seed(seed);
    symbols s = { n, malloc(n * sizeof *s.mu), malloc(n), malloc(n * sizeof *s.k) };

    for (size_t i = 0; i < n; i++) {
        const double x = random_normal(&r) * 40;

        s.sigma[i] = (uint8_t)random_in(&r, 0, widest);
        s.mu[i] = (int32_t)(256 * x);
        s.k[i] = (int16_t)rint(x + random_normal(&r) * exp2((s.sigma[i] - 64) / 16.0));
        if (far > 0 && random_in(&r, 0, far - 1) == 0)
            s.k[i] = (int16_t)((int)random_in(&r, 0, 65534) - 32767);
    }
    return s;
}

static inline void symbols_free(symbols *s)
{
    free(s->mu);
    free(s->sigma);
    free(s->k);
}

/* Writes one substream, preceded by its size. The caller ends *w with ted4_writer_finish. */
static inline void symbols_write(ted4_writer *w, const symbols *s)
{
    uint32_t size;

    ted4_writer_init(w);
    w->base.ops->sizes(&w->base, &size, 1);
    w->base.ops->open(&w->base, s->n);
    w->base.ops->gauss(&w->base, s->n, s->mu, s->sigma, s->k);
    w->base.ops->close(&w->base);
    assert_int_equal(w->base.error.code, TED4_OK);
}

#endif
