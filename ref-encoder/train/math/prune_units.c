/* prune_units.c - optimal brain surgeon (prune_units.h). Let P be the inverse of the moments of
 * the remaining units, and w the weights of a reader. Without unit j the best weights are w - P_j
 * w_j / P_jj, and the mean square error of the reader's output grows by w_j^2 / P_jj.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "prune_units.h"

#include <stdlib.h>
#include <string.h>

/* This share of the mean square of all units is added to the moment of each unit. It keeps P
 * finite where units are constant or move together. */
#define RIDGE 1e-6

/* The elimination's state. A row of weights has one weight per unit and one for the constant. The
 * first n_readers rows are the readers; the others are the units themselves, and show by what each
 * unit is replaced. */
typedef struct {
    size_t side; /* n + 1 */
    size_t n_readers, n_rows;
    double *inverse; /* [side][side] */
    double *weight;  /* [n_rows][side] */
    uint8_t *gone;   /* [side] */
} elimination;

static void invert(double *a, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        const double pivot = 1.0 / a[k * n + k];

        a[k * n + k] = 1.0;
        for (size_t j = 0; j < n; j++)
            a[k * n + j] *= pivot;
        for (size_t i = 0; i < n; i++) {
            const double f = a[i * n + k];

            if (i == k)
                continue;
            a[i * n + k] = 0.0;
            for (size_t j = 0; j < n; j++)
                a[i * n + j] -= f * a[k * n + j];
        }
    }
}

static int begin(elimination *e, const ted4_units *u)
{
    const size_t n = (size_t)u->n;
    double mean = 0;

    e->side = n + 1;
    e->n_readers = (size_t)u->n_rows;
    e->n_rows = e->n_readers + n;
    e->inverse = malloc(e->side * e->side * sizeof *e->inverse);
    e->weight = calloc(e->n_rows * e->side, sizeof *e->weight);
    e->gone = calloc(e->side, 1);
    if (e->inverse == NULL || e->weight == NULL || e->gone == NULL)
        return -1;
    memcpy(e->inverse, u->moment, e->side * e->side * sizeof *e->inverse);
    for (size_t i = 0; i < n; i++)
        mean += u->moment[i * e->side + i] / (double)n;
    for (size_t i = 0; i < n; i++)
        e->inverse[i * e->side + i] += RIDGE * mean + 1e-30;
    invert(e->inverse, e->side);
    for (size_t r = 0; r < e->n_readers; r++)
        for (size_t i = 0; i < n; i++)
            e->weight[r * e->side + i] = (double)u->readers[r * n + i];
    for (size_t i = 0; i < n; i++)
        e->weight[(e->n_readers + i) * e->side + i] = 1.0;
    return 0;
}

/* Returns by how much the mean square error, summed over the readers, grows without unit j. */
static double missed(const elimination *e, size_t j)
{
    double sum = 0;

    for (size_t r = 0; r < e->n_readers; r++)
        sum += e->weight[r * e->side + j] * e->weight[r * e->side + j];
    return sum / e->inverse[j * e->side + j];
}

static size_t least_missed(const elimination *e, const uint8_t *held)
{
    size_t least = e->side;
    double most = 0;

    for (size_t j = 0; j + 1 < e->side; j++) {
        const double m = e->gone[j] || (held != NULL && held[j]) ? -1.0 : missed(e, j);

        if (m >= 0 && (least == e->side || m < most)) {
            least = j;
            most = m;
        }
    }
    return least;
}

static void take_away(elimination *e, size_t j)
{
    const size_t side = e->side;
    const double *p = e->inverse + j * side;
    const double scale = 1.0 / p[j];

    for (size_t r = 0; r < e->n_rows; r++) {
        double *w = e->weight + r * side;
        const double f = w[j] * scale;

        for (size_t k = 0; f != 0.0 && k < side; k++)
            w[k] -= f * p[k];
        w[j] = 0.0;
    }
    for (size_t i = 0; i < side; i++) {
        const double f = e->inverse[i * side + j] * scale;

        for (size_t k = 0; i != j && k < side; k++)
            e->inverse[i * side + k] -= f * p[k];
    }
    e->gone[j] = 1;
    for (size_t i = 0; i < side; i++)
        e->inverse[i * side + j] = e->inverse[j * side + i] = 0.0;
}

static int finish(ted4_pruned_units *w, const elimination *e)
{
    const size_t n = e->side - 1;
    int to = 0;

    for (size_t i = 0; i < n; i++)
        to += !e->gone[i];
    w->from = (int)n;
    w->to = to;
    w->keep = malloc(((size_t)to + 1) * sizeof *w->keep);
    w->decode = malloc(n * ((size_t)to + 1) * sizeof *w->decode);
    if (w->keep == NULL || w->decode == NULL)
        return -1;
    for (size_t i = 0, k = 0; i < n; i++)
        if (!e->gone[i])
            w->keep[k++] = (int)i;
    for (size_t i = 0; i < n; i++) {
        const double *from = e->weight + (e->n_readers + i) * e->side;
        double *at = w->decode + i * ((size_t)to + 1);

        for (int k = 0; k < to; k++)
            at[k] = from[w->keep[k]];
        at[to] = from[n];
    }
    return 0;
}

int ted4_prune_units(ted4_pruned_units *w, const ted4_units *u, int to)
{
    elimination e = { 0 };
    int bad = begin(&e, u) != 0;

    memset(w, 0, sizeof *w);
    for (int left = u->n; !bad && left > to; left--) {
        const size_t j = least_missed(&e, u->held);

        if (j == e.side)
            break;
        take_away(&e, j);
    }
    bad = bad || finish(w, &e) != 0;
    free(e.inverse);
    free(e.weight);
    free(e.gone);
    if (bad)
        ted4_pruned_units_finish(w);
    return bad ? -1 : 0;
}

void ted4_pruned_units_finish(ted4_pruned_units *w)
{
    free(w->keep);
    free(w->decode);
    memset(w, 0, sizeof *w);
}
