/* settle_positions.c - see settle_positions.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "settle_positions.h"

#include <math.h>
#include <stdlib.h>

#include "math/elementary.h"
#include "norm/half.h"
#include "norm/octree.h"

enum { NEIGHBOURS = 27, HASHED = 64, COARSEST_GRID = 6, FINEST_GRID = 12 };

#define PI             0x1.921fb54442d18p1
/* Of offsets, so that it is not 0 where all are. */
#define LEAST_VARIANCE 1e-6

unsigned ted4_position_bits(const ted4_trainer *t)
{
    return t->phase.grid != 0 ? (unsigned)t->phase.grid : TED4_OCTREE_DEPTH;
}

/* bench/compact.md: an octree of 12 bits takes 18 to 24 bits an anchor, and each level 3. */
double ted4_anchor_bits(const ted4_trainer *t)
{
    const unsigned bits = ted4_position_bits(t);

    return 1.0 + (bits == TED4_OCTREE_DEPTH ? 48.0 : 3.0 * (double)bits - 17.0);
}

uint64_t ted4_position_key(const ted4_trainer *t, size_t i)
{
    uint16_t p[3];

    for (int j = 0; j < 3; j++)
        p[j] = ted4_float_to_half(*ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j));
    return ted4_octree_key(p, ted4_position_bits(t));
}

static void round_to_half(ted4_anchors *a)
{
    for (size_t i = 0; i < a->n; i++)
        for (int j = 0; j < 3; j++) {
            float *p = ted4_anchor_value(a, TED4_ROW_POSITION, i, j);

            *p = ted4_half_to_float(ted4_float_to_half(*p)) + 0.0f;
        }
}

/* Lists the anchors, order[*n], of which none has the position of the one before it. */
static void drop_doubles(const ted4_anchors *a, uint32_t *order, size_t *n)
{
    uint64_t last = 0;

    *n = 0;
    for (size_t i = 0; i < a->n; i++) {
        const uint64_t code = ted4_anchor_morton(a, i);

        if (i == 0 || code != last)
            order[(*n)++] = (uint32_t)i;
        last = code;
    }
}

/* The cells that are taken: a hash table with open addresses, of which at most half are used. An
 * entry is a cell's number plus 1; 0: free. */
typedef struct {
    uint64_t *entry; /* owned, [mask + 1] */
    uint64_t mask;
} cells;

static int cells_begin(cells *c, size_t n)
{
    size_t size = HASHED;

    while (size < 2 * n)
        size *= 2;
    c->mask = size - 1;
    c->entry = calloc(size, sizeof *c->entry);
    return c->entry == NULL ? -1 : 0;
}

/* Takes a cell. Returns 1, or 0 if it is taken already. */
static int take(cells *c, uint64_t cell)
{
    uint64_t at = cell * 0x9e3779b97f4a7c15u >> 20 & c->mask;

    for (; c->entry[at] != 0; at = (at + 1) & c->mask)
        if (c->entry[at] == cell + 1)
            return 0;
    c->entry[at] = cell + 1;
    return 1;
}

typedef struct {
    float distance; /* squared, in cells */
    int place[3];   /* on the grid, from its centre */
} target;

/* Lists the cell nearest to x[3], in cells, and those around it, the nearest first. half: half the
 * width of the grid, in cells. Returns their number. */
static int list_targets(const float *x, int half, target *list)
{
    int n = 0;

    for (int k = 0; k < NEIGHBOURS; k++) {
        const int step[3] = { k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1 };
        target t = { 0, { 0, 0, 0 } };
        int inside = 1, at;

        for (int j = 0; j < 3; j++) {
            const int nearest = (int)fminf(fmaxf(rintf(x[j]), (float)-half), (float)(half - 1));
            const float d = (float)(nearest + step[j]) - x[j];

            t.place[j] = nearest + step[j];
            t.distance += d * d;
            inside &= t.place[j] >= -half && t.place[j] < half;
        }
        if (!inside)
            continue;
        for (at = n++; at > 0 && list[at - 1].distance > t.distance; at--)
            list[at] = list[at - 1];
        list[at] = t;
    }
    return n;
}

/* Moves anchor i to p[3]. Gaussian k is at position + offset_k 2^size (spec 11.5). */
static void move(const ted4_trainer *t, size_t i, const float *p)
{
    const ted4_anchors *a = &t->anchors;

    for (int j = 0; j < 3; j++) {
        float *position = ted4_anchor_value(a, TED4_ROW_POSITION, i, j);
        const float size = ted4_math_exp2f(
            *ted4_anchor_value(a, TED4_ROW_VALUE, i, t->layout.first[TED4_SCALING] + j));
        const float change = (*position - p[j]) / size;

        for (int k = 0; k < t->layout.head.n_offsets; k++)
            *ted4_anchor_value(a, TED4_ROW_VALUE, i, t->layout.first[TED4_OFFSET] + 3 * k + j) +=
                change;
        *position = p[j];
    }
}

/* Moves anchor i to the nearest free cell. Returns 0 if there is none. */
static int move_to_grid(const ted4_trainer *t, size_t i, unsigned bits, cells *taken)
{
    const int half = 1 << (bits - 1);
    target list[NEIGHBOURS];
    float x[3];

    for (int j = 0; j < 3; j++)
        x[j] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j) * (float)half;

    const int n = list_targets(x, half, list);

    for (int k = 0; k < n; k++) {
        const int *place = list[k].place;
        uint64_t cell = 0;

        for (int j = 0; j < 3; j++)
            cell = cell << bits | (uint64_t)(place[j] + half);
        if (take(taken, cell)) {
            for (int j = 0; j < 3; j++)
                x[j] = (float)place[j] / (float)half;
            move(t, i, x);
            return 1;
        }
    }
    return 0;
}

static int settle_on_grid(const ted4_trainer *t, unsigned bits, uint32_t *order, size_t *n)
{
    cells taken;

    *n = 0;
    if (cells_begin(&taken, t->anchors.n) != 0)
        return -1;
    for (size_t i = 0; i < t->anchors.n; i++)
        if (move_to_grid(t, i, bits, &taken))
            order[(*n)++] = (uint32_t)i;
    free(taken.entry);
    return 0;
}

/* Returns the mean magnitude of offsets along an axis, in units of their anchors' sizes. */
static double mean_offset(const ted4_trainer *t, int axis)
{
    const int K = t->layout.head.n_offsets;
    double sum = 0;

    for (size_t i = 0; i < t->anchors.n; i++)
        for (int k = 0; k < K; k++)
            sum += (double)fabsf(*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                                    t->layout.first[TED4_OFFSET] + 3 * k + axis));
    return sum / ((double)K * (double)t->anchors.n);
}

/* Returns the bits by which offsets grow, in all anchors, when positions move to cells of a width:
 * each position moves by an amount that is uniform in its cell, of variance width^2 / 12, and all
 * offsets of its anchor move back by that, in units of its size. Offsets are taken for Gaussian,
 * with the deviation that goes with their mean magnitude, and the bits of a Gaussian grow with the
 * logarithm of its deviation. */
static double bits_of_offsets(const ted4_trainer *t, double width)
{
    const double gaussian = 0.5 * PI;
    double bits = 0;

    for (int j = 0; j < 3; j++) {
        const double mean = mean_offset(t, j), variance = gaussian * mean * mean + LEAST_VARIANCE;

        for (size_t i = 0; i < t->anchors.n; i++) {
            const double size = (double)ted4_math_exp2f(*ted4_anchor_value(
                &t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_SCALING] + j));
            const double moved = width / size;

            bits += 0.5 * ted4_math_log2(1.0 + moved * moved / (12.0 * variance));
        }
    }
    return bits * (double)t->layout.head.n_offsets;
}

/* Returns the bits of the grid with which positions and offsets take the fewest bits: a level of
 * the octree takes 3 bits an anchor. */
static int cheapest_grid(const ted4_trainer *t)
{
    double least = INFINITY;
    int best = FINEST_GRID;

    for (int g = FINEST_GRID; g >= COARSEST_GRID; g--) {
        const double bits = 3.0 * (double)g * (double)t->anchors.n +
                            bits_of_offsets(t, ldexp(2.0, -g));

        if (bits < least) {
            least = bits;
            best = g;
        }
    }
    return best;
}

int ted4_settle_positions(ted4_trainer *t)
{
    ted4_anchors *a = &t->anchors;
    uint32_t *order = malloc((a->n + 1) * sizeof *order);
    size_t n = 0;
    int bad = order == NULL;

    if (t->opt.profile == TED4_PROFILE_COMPACT)
        t->phase.grid = t->opt.grid != 0 ? t->opt.grid : cheapest_grid(t);

    const unsigned bits = ted4_position_bits(t);

    round_to_half(a);
    bad = bad || ted4_anchors_sort(a, NULL) != 0;
    if (!bad && bits == TED4_OCTREE_DEPTH)
        drop_doubles(a, order, &n);
    else
        bad = bad || settle_on_grid(t, bits, order, &n) != 0;
    bad = bad || ted4_anchors_select(a, order, n) != 0;
    free(order);
    return bad ? ted4_trainer_fail(t, "no memory to settle positions") : 0;
}
