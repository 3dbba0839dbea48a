/* depth_map.c - see depth_map.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/depth_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "data/data_util.h"

enum { D = TED4_DEPTH_PLANES, CHANNELS = 4, DETAIL = 3, FEWEST = 2 };
/* Costs are sums over the cells of a patch, in levels of 255 a cell. Above MOST, a patch tells only
 * that the depth is wrong; WRONG marks cells that a helper does not see. */
enum { PATCH = 9, MOST = 40 * PATCH, WRONG = 0xffff };
/* Penalties of semi-global matching: for a step to the next plane, and for a larger one, which is
 * smaller where the brightness changes by EDGE levels. */
enum { SLOPE = 2 * PATCH, JUMP = 16 * PATCH, EDGE = 8 };
/* Half the side of the window that gives the surroundings' brightness. */
enum { AROUND = 2 };
/* Fractions of a cell in bilinear interpolation. */
enum { PARTS = 16 };

static int at_most(int x, int most)
{
    return x < most ? x : most;
}

static int at_least(int x, int least)
{
    return x > least ? x : least;
}

static int reduced(int pixels, int n)
{
    return at_least(pixels / n, 1);
}

/* Returns the side of a cell in pixels. */
static int reduction(const ted4_camera *c)
{
    int n = 1;

    while ((size_t)reduced(c->width, n) * (size_t)reduced(c->height, n) > TED4_DEPTH_CELLS)
        n++;
    return n;
}

static int brightness(const uint8_t *cell)
{
    return (cell[0] + 2 * cell[1] + cell[2]) / 4;
}

/* Fills a cell of n by n pixels with their mean colour. Only a picture that is narrower than a cell
 * ends inside one. */
static void average(const uint8_t *rgb, const ted4_camera *c, int n, int x, int y, uint8_t *cell)
{
    const int right = at_most((x + 1) * n, c->width), low = at_most((y + 1) * n, c->height);
    const int pixels = (right - x * n) * (low - y * n);

    for (int k = 0; k < 3; k++) {
        int sum = 0;

        for (int v = y * n; v < low; v++)
            for (int u = x * n; u < right; u++)
                sum += rgb[3 * ((size_t)v * (size_t)c->width + (size_t)u) + (size_t)k];
        cell[k] = (uint8_t)((sum + pixels / 2) / pixels);
    }
}

/* Fills the deviation of each cell's brightness from that of its surroundings. */
static void add_detail(ted4_reduced *r)
{
    const int width = r->camera.width, height = r->camera.height;

    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint8_t *cell = r->cell + CHANNELS * ((size_t)y * (size_t)width + (size_t)x);
            int sum = 0, n = 0;

            for (int v = at_least(y - AROUND, 0); v <= at_most(y + AROUND, height - 1); v++)
                for (int u = at_least(x - AROUND, 0); u <= at_most(x + AROUND, width - 1); u++, n++)
                    sum += brightness(r->cell + CHANNELS * ((size_t)v * (size_t)width + (size_t)u));
            cell[DETAIL] =
                (uint8_t)at_least(at_most(128 + brightness(cell) - (sum + n / 2) / n, 255), 0);
        }
}

int ted4_reduce(ted4_reduced *r, const ted4_shown *s, size_t i)
{
    const ted4_camera *c = &s->data->pictures[s->picture[i]].camera;
    const int n = reduction(c), width = reduced(c->width, n), height = reduced(c->height, n);

    r->camera = *c;
    r->camera.width = width;
    r->camera.height = height;
    r->camera.fx /= n;
    r->camera.fy /= n;
    r->camera.cx /= n;
    r->camera.cy /= n;
    r->cell = malloc((size_t)width * (size_t)height * CHANNELS);
    if (r->cell == NULL)
        return -1;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            average(s->rgb[i], c, n, x, y,
                    r->cell + CHANNELS * ((size_t)y * (size_t)width + (size_t)x));
    add_detail(r);
    return 0;
}

void ted4_reduced_free(ted4_reduced *r)
{
    free(r->cell);
    r->cell = NULL;
}

/* A cell (x, y) of one picture at inverse depth v lies in another picture at q[0] / q[2],
 * q[1] / q[2], where q = A (x, y, 1) + b v. */
typedef struct {
    double A[9], b[3];
} plane_map;

static void relate(const ted4_camera *from, const ted4_camera *to, plane_map *m)
{
    const double K[9] = { to->fx, 0, to->cx, 0, to->fy, to->cy, 0, 0, 1 };
    double R[9], t[3], B[9];

    for (int i = 0; i < 3; i++) {
        t[i] = to->t[i];
        for (int j = 0; j < 3; j++) {
            R[3 * i + j] = 0;
            for (int k = 0; k < 3; k++)
                R[3 * i + j] += to->R[3 * i + k] * from->R[3 * j + k];
        }
        for (int j = 0; j < 3; j++)
            t[i] -= R[3 * i + j] * from->t[j];
    }
    for (int i = 0; i < 3; i++) {
        B[3 * i] = R[3 * i] / from->fx;
        B[3 * i + 1] = R[3 * i + 1] / from->fy;
        B[3 * i + 2] = R[3 * i + 2] - R[3 * i] * from->cx / from->fx -
                       R[3 * i + 1] * from->cy / from->fy;
    }
    for (int i = 0; i < 3; i++) {
        m->b[i] = 0;
        for (int k = 0; k < 3; k++)
            m->b[i] += K[3 * i + k] * t[k];
        for (int j = 0; j < 3; j++) {
            m->A[3 * i + j] = 0;
            for (int k = 0; k < 3; k++)
                m->A[3 * i + j] += K[3 * i + k] * B[3 * k + j];
        }
    }
}

/* Returns by how much a cell differs from another picture at (x, y), at most WRONG - 1, or WRONG
 * if that is outside. */
static int difference(const uint8_t *cell, const ted4_reduced *other, double x, double y)
{
    const int width = other->camera.width, height = other->camera.height;

    if (!(x >= 0.5 && y >= 0.5 && x < width - 0.5 && y < height - 0.5))
        return WRONG;

    const int u = (int)((x - 0.5) * PARTS), v = (int)((y - 0.5) * PARTS);
    const int right = u % PARTS, down = v % PARTS;
    const uint8_t *a = other->cell +
                       CHANNELS * ((size_t)(v / PARTS) * (size_t)width + (size_t)(u / PARTS));
    const uint8_t *b = a + (down > 0 ? CHANNELS * (size_t)width : 0);
    const int next = right > 0 ? CHANNELS : 0;
    int off[CHANNELS];

    for (int k = 0; k < CHANNELS; k++)
        off[k] = abs((a[k] * (PARTS - right) + a[next + k] * right) * (PARTS - down) +
                     (b[k] * (PARTS - right) + b[next + k] * right) * down -
                     cell[k] * PARTS * PARTS);
    return ((off[0] + off[1] + off[2]) / 3 + 2 * off[DETAIL]) / (PARTS * PARTS);
}

/* Buffers of one map. */
typedef struct {
    const ted4_reduced *r;
    int width, height, n_helpers;
    size_t cells;
    uint16_t *difference;                /* [cells] to one helper at one plane */
    uint16_t *patch[TED4_SWEEP_HELPERS]; /* [cells] sums over patches, of each helper */
    uint16_t *cost;                      /* [cells][D] */
    uint16_t *sum;                       /* [cells][D] of all paths */
    uint16_t *path[2];                   /* [width][D] costs along a path, of two rows */
} matching;

static void warp(matching *m, const ted4_reduced *helper, const plane_map *to, double inverse)
{
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            const size_t at = (size_t)y * (size_t)m->width + (size_t)x;
            double q[3];

            for (int k = 0; k < 3; k++)
                q[k] = to->A[3 * k] * (x + 0.5) + to->A[3 * k + 1] * (y + 0.5) + to->A[3 * k + 2] +
                       to->b[k] * inverse;
            m->difference[at] = (uint16_t)(q[2] > 0 ? difference(m->r->cell + CHANNELS * at, helper,
                                                                 q[0] / q[2], q[1] / q[2])
                                                    : WRONG);
        }
}

/* Sums differences over the patch around each cell; cells of the patch that are outside either
 * picture count as the one in the middle. */
static void sum_patches(const matching *m, uint16_t *patch)
{
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            const size_t at = (size_t)y * (size_t)m->width + (size_t)x;
            const int middle = m->difference[at];
            int sum = 0;

            patch[at] = WRONG;
            if (middle == WRONG)
                continue;
            for (int v = y - 1; v <= y + 1; v++)
                for (int u = x - 1; u <= x + 1; u++) {
                    const int inside = u >= 0 && v >= 0 && u < m->width && v < m->height;
                    const int d = inside ? m->difference[(size_t)v * (size_t)m->width + (size_t)u]
                                         : WRONG;

                    sum += d == WRONG ? middle : d;
                }
            patch[at] = (uint16_t)at_most(sum, WRONG - 1);
        }
}

/* The mean of the better half of the helpers that see a cell, at least two: the others may see
 * something in front of it. */
static int better_half(const matching *m, size_t at)
{
    int x[TED4_SWEEP_HELPERS], n = 0, sum = 0;

    for (int h = 0; h < m->n_helpers; h++) {
        const int d = m->patch[h][at];
        int k = n;

        if (d == WRONG)
            continue;
        for (; k > 0 && x[k - 1] > d; k--)
            x[k] = x[k - 1];
        x[k] = d;
        n++;
    }
    if (n < FEWEST)
        return MOST;

    const int half = at_least(n / 2, FEWEST);

    for (int k = 0; k < half; k++)
        sum += x[k];
    return at_most(sum / half, MOST);
}

static double plane(const ted4_sweep *w, double k)
{
    return 1 / w->farthest + k * ted4_depth_step(w);
}

double ted4_depth_step(const ted4_sweep *w)
{
    return (1 / w->nearest - 1 / w->farthest) / (D - 1);
}

static void fill_costs(matching *m, const ted4_sweep *w, const ted4_reduced *const *helper)
{
    plane_map to[TED4_SWEEP_HELPERS];

    for (int h = 0; h < m->n_helpers; h++)
        relate(&m->r->camera, &helper[h]->camera, &to[h]);
    for (int d = 0; d < D; d++) {
        for (int h = 0; h < m->n_helpers; h++) {
            warp(m, helper[h], &to[h], plane(w, d));
            sum_patches(m, m->patch[h]);
        }
        for (size_t i = 0; i < m->cells; i++)
            m->cost[i * D + (size_t)d] = (uint16_t)better_half(m, i);
    }
}

/* Continues a path by one cell: Hirschmueller, equation 13. before: costs of the cell before, or
 * NULL where a path begins. */
static void continue_path(const uint16_t *cost, const uint16_t *before, int jump, uint16_t *now)
{
    int least = WRONG;

    if (before == NULL) {
        memcpy(now, cost, D * sizeof *now);
        return;
    }
    for (int d = 0; d < D; d++)
        least = at_most(before[d], least);
    for (int d = 0; d < D; d++) {
        int best = at_most(before[d], least + jump);

        if (d > 0)
            best = at_most(before[d - 1] + SLOPE, best);
        if (d + 1 < D)
            best = at_most(before[d + 1] + SLOPE, best);
        now[d] = (uint16_t)(cost[d] + best - least);
    }
}

/* Adds the costs along all paths in one direction. */
static void add_paths(matching *m, int right, int down)
{
    const int backwards = down < 0 || (down == 0 && right < 0);

    for (int j = 0; j < m->height; j++) {
        const int y = backwards ? m->height - 1 - j : j;

        for (int i = 0; i < m->width; i++) {
            const int x = backwards ? m->width - 1 - i : i, u = x - right, v = y - down;
            const size_t at = (size_t)y * (size_t)m->width + (size_t)x;
            const int begins = u < 0 || v < 0 || u >= m->width || v >= m->height;
            const size_t last = begins ? at : (size_t)v * (size_t)m->width + (size_t)u;
            const int change = abs(brightness(m->r->cell + CHANNELS * at) -
                                   brightness(m->r->cell + CHANNELS * last));
            const int jump = at_least(JUMP * EDGE / (EDGE + change), SLOPE + 1);
            uint16_t *now = m->path[j % 2] + (size_t)x * D;

            const uint16_t *before = begins ? NULL
                                            : m->path[(down == 0 ? j : j + 1) % 2] + (size_t)u * D;

            continue_path(m->cost + at * D, before, jump, now);
            for (int d = 0; d < D; d++)
                m->sum[at * D + (size_t)d] = (uint16_t)(m->sum[at * D + (size_t)d] + now[d]);
        }
    }
}

/* Returns the plane of least sum, refined by a parabola through its neighbours, or -1 if it is the
 * first or the last: then the depth lies outside the range. */
static double best_plane(const uint16_t *sum)
{
    int best = 0;

    for (int d = 1; d < D; d++)
        best = sum[d] < sum[best] ? d : best;
    if (best == 0 || best == D - 1)
        return -1;

    const int before = sum[best - 1] - sum[best], after = sum[best + 1] - sum[best];

    return best + (before + after > 0 ? 0.5 * (before - after) / (before + after) : 0);
}

static int allocate(matching *m)
{
    const size_t row = (size_t)m->width * D;
    int bad = 0;

    m->difference = malloc(m->cells * sizeof *m->difference);
    m->cost = malloc(m->cells * D * sizeof *m->cost);
    m->sum = calloc(m->cells * D, sizeof *m->sum);
    for (int k = 0; k < 2; k++) {
        m->path[k] = malloc(row * sizeof *m->path[k]);
        bad |= m->path[k] == NULL;
    }
    for (int h = 0; h < m->n_helpers; h++) {
        m->patch[h] = malloc(m->cells * sizeof *m->patch[h]);
        bad |= m->patch[h] == NULL;
    }
    return bad || m->difference == NULL || m->cost == NULL || m->sum == NULL ? -1 : 0;
}

static void release(matching *m)
{
    free(m->difference);
    free(m->cost);
    free(m->sum);
    for (int k = 0; k < 2; k++)
        free(m->path[k]);
    for (int h = 0; h < m->n_helpers; h++)
        free(m->patch[h]);
}

int ted4_depth_map(const ted4_sweep *w, const ted4_reduced *r, const ted4_reduced *const *helper,
                   int n_helpers, float *inverse)
{
    matching m = { .r = r, .width = r->camera.width, .height = r->camera.height };

    m.n_helpers = n_helpers;
    m.cells = (size_t)m.width * (size_t)m.height;
    if (allocate(&m) != 0) {
        release(&m);
        return -1;
    }
    fill_costs(&m, w, helper);
    for (int down = -1; down <= 1; down++)
        for (int right = -1; right <= 1; right++)
            if (right != 0 || down != 0)
                add_paths(&m, right, down);
    for (size_t i = 0; i < m.cells; i++) {
        const double k = best_plane(m.sum + i * D);

        inverse[i] = k < 0 ? 0.0f : (float)plane(w, k);
    }
    release(&m);
    return 0;
}
