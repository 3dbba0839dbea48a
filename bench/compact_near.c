/* compact_near.c - see compact.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "compact.h"

#include <math.h>
#include <stdlib.h>
#include "norm/half.h"

static unsigned level_of(size_t place)
{
    return place % 2 == 1 ? 2 : place % 4 == 2;
}

static double distance(const float *a, const float *b)
{
    double sum = 0;

    for (int j = 0; j < 3; j++)
        sum += ((double)a[j] - (double)b[j]) * ((double)a[j] - (double)b[j]);
    return sum;
}

/* Inserts b into a's near ones, which are sorted by distance. */
static void insert(int32_t *near, double *far, int32_t b, double d)
{
    int i = COMPACT_NEAR;

    for (; i > 0 && d < far[i - 1]; i--)
        if (i < COMPACT_NEAR) {
            near[i] = near[i - 1];
            far[i] = far[i - 1];
        }
    if (i < COMPACT_NEAR) {
        near[i] = b;
        far[i] = d;
    }
}

static int32_t *find(const ted4_scene *s, int by_levels)
{
    const size_t n = s->head.n_anchors, tile = s->head.tile_size;
    int32_t *const near = compact_need(n * COMPACT_NEAR, sizeof *near);
    float *const p = compact_need(3 * n, sizeof *p);

    for (size_t i = 0; i < 3 * n; i++)
        p[i] = ted4_half_to_float(s->position[i]);
    for (size_t a = 0; a < n; a++) {
        const size_t first = a - a % tile;
        const size_t end = !by_levels ? a : n - first < tile ? n : first + tile;
        double far[COMPACT_NEAR];

        for (int i = 0; i < COMPACT_NEAR; i++) {
            far[i] = INFINITY;
            near[COMPACT_NEAR * a + (size_t)i] = COMPACT_NONE;
        }
        for (size_t b = first; b < end; b++)
            if (!by_levels || level_of(b - first) < level_of(a - first))
                insert(near + COMPACT_NEAR * a, far, (int32_t)b, distance(p + 3 * a, p + 3 * b));
    }
    free(p);
    return near;
}

int32_t *compact_near_levels(const ted4_scene *s)
{
    return find(s, 1);
}

int32_t *compact_near_before(const ted4_scene *s)
{
    return find(s, 0);
}

unsigned compact_missed(const compact_models *m, const int32_t *near, int type, unsigned comp,
                        size_t a, double *mean, double *magnitude)
{
    const double step = compact_step(m->s, type, a);
    unsigned n = 0;

    *mean = *magnitude = 0;
    for (size_t i = 0; i < COMPACT_NEAR; i++) {
        const int32_t b = near[COMPACT_NEAR * a + i];

        if (b == COMPACT_NONE || !compact_coded(m->s, type, comp, (size_t)b))
            continue;

        const size_t at = (size_t)comp * m->n + (size_t)b;
        const double missed = (m->s->symbol[type][at] - m->mu[type][at] / 256.0) *
                              compact_step(m->s, type, (size_t)b) / step;

        *mean += missed;
        *magnitude += fabs(missed);
        n++;
    }
    if (n > 0) {
        *mean /= n;
        *magnitude /= n;
    }
    return n;
}
