/* view_sums.c - see view_sums.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "view_sums.h"

#include <stdlib.h>
#include <string.h>

/* Floats that one job adds. */
enum { PIECE = 8192 };

typedef struct {
    float *to;         /* [n] */
    const float *from; /* [n], or NULL: to is scaled instead */
    size_t n;
    float scale;
} sum_job;

static void add_piece(void *arg, size_t piece)
{
    const sum_job *j = arg;
    const size_t at = piece * PIECE, n = j->n - at < PIECE ? j->n - at : PIECE;
    float *restrict to = j->to + at;

    if (j->from == NULL) {
        for (size_t i = 0; i < n; i++)
            to[i] *= j->scale;
        return;
    }

    const float *restrict from = j->from + at;

    for (size_t i = 0; i < n; i++)
        to[i] += from[i];
}

static void run(const ted4_parallel *p, sum_job *j)
{
    ted4_parallel_for(p, (j->n + PIECE - 1) / PIECE, add_piece, j);
}

/* Returns the number of nodes that wait after n views: one for each binary digit 1 of n. */
static int waiting(size_t n)
{
    int count = 0;

    for (; n != 0; n &= n - 1)
        count++;
    return count;
}

static void free_nodes(ted4_view_sums *s)
{
    for (int k = 0; k < TED4_VIEW_LEVELS; k++) {
        free(s->node[k]);
        s->node[k] = NULL;
    }
}

int ted4_view_sums_begin(ted4_view_sums *s, size_t size, size_t n)
{
    s->n_views = 0;
    if (size > s->capacity) {
        free_nodes(s);
        s->capacity = size + size / 4;
    }
    s->size = size;
    for (size_t k = 0; k == 0 || (n - 1) >> (k - 1) != 0; k++) {
        if (s->node[k] == NULL)
            s->node[k] = malloc((s->capacity + 1) * sizeof *s->node[k]);
        if (s->node[k] == NULL)
            return -1;
    }
    return 0;
}

void ted4_view_sums_finish(ted4_view_sums *s)
{
    free_nodes(s);
    free(s->received);
    memset(s, 0, sizeof *s);
}

float *ted4_view_sums_next(ted4_view_sums *s)
{
    return s->node[waiting(s->n_views)];
}

void ted4_view_sums_add(ted4_view_sums *s, const ted4_parallel *p)
{
    int last = waiting(s->n_views);

    s->n_views++;
    for (; last >= waiting(s->n_views); last--) {
        sum_job j = { s->node[last - 1], s->node[last], s->size, 0 };

        run(p, &j);
    }
}

float *ted4_view_sums_total(ted4_view_sums *s, const ted4_parallel *p)
{
    for (int last = waiting(s->n_views) - 1; last > 0; last--) {
        sum_job j = { s->node[last - 1], s->node[last], s->size, 0 };

        run(p, &j);
    }
    return s->node[0];
}

void ted4_view_sums_join(float *node, size_t size, size_t n, const ted4_parallel *p)
{
    for (size_t step = 1; step < n; step *= 2)
        for (size_t i = 0; i + step < n; i += 2 * step) {
            sum_job j = { node + i * size, node + (i + step) * size, size, 0 };

            run(p, &j);
        }
}

void ted4_view_sums_scale(float *x, size_t n, float factor, const ted4_parallel *p)
{
    sum_job j = { x, NULL, n, factor };

    run(p, &j);
}
