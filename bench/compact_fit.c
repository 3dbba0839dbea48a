/* compact_fit.c - see compact.h. For each component, the mean moves by a share of what neighbours
 * missed, and the deviation by a power of how much they missed: three weights, chosen by a search
 * over the file itself. Networks that read the same numbers could find other functions of them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "compact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    double missed, sigma; /* of the symbol: k - mu, and the model's deviation */
    double mean, spread;  /* of its neighbours: mean, and log2 of magnitude against sigma */
    int any;              /* 0: it has no neighbour */
} sample;

typedef struct {
    sample *of;
    size_t n;
} samples;

enum { SHARE, POWER, WIDTH, WEIGHTS };

/* The least magnitude, in steps, that tells something: below it, rounding hides the rest. */
#define LEAST 0.3

static void gather(const compact_models *m, const int32_t *near, int type, unsigned comp,
                   samples *y)
{
    y->n = 0;
    for (size_t a = 0; a < m->n; a++) {
        const size_t at = (size_t)comp * m->n + a;
        sample *const x = &y->of[y->n];
        double magnitude;

        if (!compact_coded(m->s, type, comp, a))
            continue;
        x->missed = m->s->symbol[type][at] - m->mu[type][at] / 256.0;
        x->sigma = compact_sigma(m->sigma[type][at]);
        x->any = compact_missed(m, near, type, comp, a, &x->mean, &magnitude) > 0;
        x->spread = log2((magnitude + LEAST) / (0.8 * x->sigma + LEAST));
        y->n++;
    }
}

static double cost(const samples *y, const double *w)
{
    double bits = 0;

    for (size_t i = 0; i < y->n; i++) {
        const sample *const x = &y->of[i];
        const double mean = x->any ? w[SHARE] * x->mean : 0;
        const double sigma = x->sigma * exp2(w[WIDTH] + (x->any ? w[POWER] * x->spread : 0));

        bits += compact_bits(compact_mass(x->missed, mean, sigma));
    }
    return bits;
}

/* Moves each weight from first on by ever smaller steps for as long as that saves bits. */
static double search(const samples *y, int first)
{
    double w[WEIGHTS] = { 0 };
    double best = cost(y, w);

    for (double step = 0.25; step > 0.05; step /= 2)
        for (int i = first; i < WEIGHTS; i++)
            for (int sign = -1; sign <= 1; sign += 2) {
                double bits = best;

                do {
                    best = bits;
                    w[i] += sign * step;
                    bits = cost(y, w);
                } while (bits < best);
                w[i] -= sign * step;
            }
    return best;
}

void compact_fit(const compact_models *m, int type, const int32_t *levels, const int32_t *before,
                 compact_fitted *f)
{
    static const double none[WEIGHTS];
    samples y = { compact_need(m->n, sizeof *y.of), 0 };

    memset(f, 0, sizeof *f);
    for (unsigned comp = 0; comp < m->s->shape.dim[type]; comp++) {
        gather(m, levels, type, comp, &y);
        f->today += cost(&y, none);
        f->blind += search(&y, WIDTH);
        f->near_levels += search(&y, SHARE);
        gather(m, before, type, comp, &y);
        f->near_before += search(&y, SHARE);
    }
    free(y.of);
}
