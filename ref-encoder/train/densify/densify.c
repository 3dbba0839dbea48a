/* densify.c - grows and prunes anchors (densify.h). Candidates lie in canonical space.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "densify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/math/voxel_set.h"
#include "train/model/formulas.h"
#include "math/elementary.h"
#include "train/math/random.h"
#include "train/state/arrangement.h"

enum { DEPTHS = 3 };
#define VOXEL_RATIO    0.25 /* edge of a voxel of depth i: times 4^-i */
#define GRADIENT_RATIO 2.0  /* threshold of depth i: times 2^i */
/* An offset may grow, and an anchor may be pruned, only if it was seen in this share of the steps
 * since the last adjustment. */
#define GROW_SEEN      0.4
#define PRUNE_SEEN     0.8
/* An anchor is pruned only after it was seen this often at times when it is active. Few or none of
 * the steps between two adjustments see content that lives for one frame in forty. Judged by all
 * steps, its anchor would be pruned even if it is right at its time. */
enum { SEEN_THERE = 8 };

uint32_t ted4_lanes_there(const ted4_generate_input *in, size_t visible)
{
    const int first = in->layout->first[TED4_TAU];
    const float now = (float)in->num / (float)in->den;
    uint32_t there = in->lanes[visible];

    for (int j = 0; in->activation && j < TED4_LANES; j++) {
        const float *tau = in->attr[visible] + first * TED4_LANES + j;
        const float u = ted4_find_edge(now, tau, ted4_pow2).u;

        if (!(u * u < 0.6931472f))
            there &= ~((uint32_t)1 << j);
    }
    return there;
}

typedef struct {
    ted4_trainer *t;
    const ted4_generate_input *in;
    const ted4_splats *s;
    float *to; /* [n_visible][ted4_densify_per_block] */
} gather_job;

/* Adds the statistics of visible block i in one view: to the rows of the anchors' opacity [3][32],
 * and to those of their Gaussians' gradients [2 K][32]. A block that is not drawn has visits only.
 */
static void add_block(const gather_job *g, size_t i, float *opacity, float *gradient)
{
    const ted4_trainer *t = g->t;
    const int K = t->layout.head.n_offsets;
    const int drawn = i < g->in->n_visible;
    const uint32_t lanes = g->in->lanes[i], there = drawn ? ted4_lanes_there(g->in, i) : 0;

    for (int j = 0; j < TED4_LANES; j++) {
        opacity[TED4_LANES + j] += (float)(lanes >> j & 1);
        opacity[2 * TED4_LANES + j] += (float)(there >> j & 1);
    }
    for (int k = 0; drawn && k < K; k++) {
        const size_t at = (i * (size_t)K + (size_t)k) * TED4_LANES;
        const float *d = t->work.splat_gradient.mean2d + at, *shown = g->s->opacity + at;
        const uint8_t *seen = t->work.splat_gradient.visible + at;
        float *sum = gradient + k * TED4_LANES;
        float *count = gradient + (K + k) * TED4_LANES;

        for (int j = 0; j < TED4_LANES; j++) {
            const float on = (float)seen[j];

            opacity[j] += shown[j];
            sum[j] += on * d[j];
            count[j] += on;
        }
    }
}

static void gather_block(void *arg, size_t i)
{
    const gather_job *g = arg;
    const size_t block = g->t->visible_blocks.block[i];

    add_block(g, i, ted4_block(&g->t->anchors, TED4_ROW_OPACITY, block),
              ted4_block(&g->t->anchors, TED4_ROW_GRADIENT, block));
}

void ted4_densify_gather(ted4_trainer *t, const ted4_generate_input *in, const ted4_splats *s)
{
    gather_job j = { t, in, s, NULL };

    ted4_parallel_for(t->parallel, t->visible_blocks.n, gather_block, &j);
}

/* Rows of the anchors' opacity, before those of gradients. */
enum { OPACITY_ROWS = 3 };

size_t ted4_densify_per_block(const ted4_trainer *t)
{
    return (OPACITY_ROWS + 2 * (size_t)t->layout.head.n_offsets) * TED4_LANES;
}

static void view_block(void *arg, size_t i)
{
    const gather_job *g = arg;
    const size_t size = ted4_densify_per_block(g->t);
    float *to = g->to + i * size;

    memset(to, 0, size * sizeof *to);
    add_block(g, i, to, to + OPACITY_ROWS * TED4_LANES);
}

void ted4_densify_view(ted4_trainer *t, const ted4_generate_input *in, const ted4_splats *s,
                       float *to)
{
    gather_job j = { t, in, s, to };

    ted4_parallel_for(t->parallel, t->visible_blocks.n, view_block, &j);
}

void ted4_densify_add(ted4_trainer *t, const float *sum)
{
    const size_t size = ted4_densify_per_block(t), first = OPACITY_ROWS * TED4_LANES;

    for (size_t i = 0; i < t->visible_blocks.n; i++) {
        const size_t block = t->visible_blocks.block[i];
        float *opacity = ted4_block(&t->anchors, TED4_ROW_OPACITY, block);
        float *gradient = ted4_block(&t->anchors, TED4_ROW_GRADIENT, block);
        const float *from = sum + i * size;

        for (size_t k = 0; k < first; k++)
            opacity[k] += from[k];
        for (size_t k = first; k < size; k++)
            gradient[k - first] += from[k];
    }
}

typedef struct {
    float gradient;
    uint32_t parent; /* index of an anchor */
    uint64_t found;  /* number of candidates found before it */
    float position[3];
    float voxel;
} candidate;

static int compare_candidates(const void *x, const void *y)
{
    const candidate *a = x, *b = y;

    if (a->gradient != b->gradient)
        return a->gradient > b->gradient ? -1 : 1;
    if (a->parent != b->parent)
        return a->parent < b->parent ? -1 : 1;
    return a->found < b->found ? -1 : a->found > b->found;
}

/* Computes the canonical position of offset k of anchor i. */
static void place(const ted4_trainer *t, size_t i, int k, float p[3])
{
    const ted4_layout *l = &t->layout;

    for (int j = 0; j < 3; j++)
        p[j] =
            *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j) +
            *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, l->first[TED4_OFFSET] + 3 * k + j) *
                ted4_math_exp2f(
                    *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, l->first[TED4_SCALING] + j));
}

/* Returns the mean screen-space gradient of offset k, or -1 if the offset was not seen often
 * enough. */
static float mean_gradient(const ted4_trainer *t, size_t i, int k)
{
    const int K = t->layout.head.n_offsets;
    const float count = *ted4_anchor_value(&t->anchors, TED4_ROW_GRADIENT, i, K + k);
    const float sum = *ted4_anchor_value(&t->anchors, TED4_ROW_GRADIENT, i, k);

    if ((double)count <= GROW_SEEN * (double)t->opt.grow_every)
        return -1.0f;
    return sum / count;
}

/* Appends the candidates of one depth to out, at most one per free voxel. Returns the new number
 * of candidates. */
static size_t collect(const ted4_trainer *t, int depth, ted4_voxel_set *set, candidate *out,
                      size_t n)
{
    const double voxel = t->voxel * ted4_math_pow(VOXEL_RATIO, depth);
    const double threshold = t->opt.grow_gradient * ted4_math_pow(GRADIENT_RATIO, depth);
    const double keep = 1.0 - ted4_math_pow(0.5, depth + 1);
    const uint64_t key = ted4_mix(t->opt.seed ^ (t->iteration << 8) ^ (uint64_t)depth);
    const int K = t->layout.head.n_offsets;

    ted4_voxel_set_clear(set);
    for (size_t i = 0; i < t->anchors.n; i++) {
        float p[3];

        for (int j = 0; j < 3; j++)
            p[j] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j);
        ted4_voxel_set_add(set, ted4_voxel_key(p, voxel));
    }
    for (size_t i = 0; i < t->anchors.n; i++) {
        for (int k = 0; k < K; k++) {
            const float g = mean_gradient(t, i, k);
            candidate c = { g, (uint32_t)i, n, { 0 }, (float)voxel };
            int inside = 1;

            if ((double)g < threshold ||
                (double)ted4_uniform(key, i * (size_t)K + (size_t)k) >= keep)
                continue;
            place(t, i, k, c.position);
            for (int j = 0; j < 3; j++) {
                c.position[j] = (float)(rint((double)c.position[j] / voxel) * voxel);
                inside &= fabsf(c.position[j]) <= 1.0f;
            }
            if (inside && ted4_voxel_set_add(set, ted4_voxel_key(c.position, voxel)))
                out[n++] = c;
        }
    }
    return n;
}

static int add_anchor(ted4_trainer *t, const candidate *c)
{
    const ted4_layout *l = &t->layout;
    ted4_anchors *a = &t->anchors;
    const size_t i = a->n;

    if (ted4_anchors_resize(a, i + 1) != 0)
        return ted4_trainer_fail(t, "no memory for %zu anchors", i + 1);
    for (int r = 0; r < l->n_channels; r++)
        *ted4_anchor_value(a, TED4_ROW_VALUE, i, r) =
            *ted4_anchor_value(a, TED4_ROW_VALUE, c->parent, r);
    for (int j = 0; j < 3; j++)
        *ted4_anchor_value(a, TED4_ROW_POSITION, i, j) = c->position[j];
    for (int j = 0; j < 3 * l->head.n_offsets; j++)
        *ted4_anchor_value(a, TED4_ROW_VALUE, i, l->first[TED4_OFFSET] + j) = 0.0f;
    for (int j = 0; j < 6; j++)
        *ted4_anchor_value(a, TED4_ROW_VALUE, i, l->first[TED4_SCALING] + j) =
            ted4_math_log2f(c->voxel);
    return 0;
}

static int grow(ted4_trainer *t, size_t allowance)
{
    const size_t n = t->anchors.n, K = t->layout.head.n_offsets;
    candidate *c = malloc((DEPTHS * n * K + 1) * sizeof *c);
    ted4_voxel_set set;
    size_t found = 0;
    int bad = 0;

    if (c == NULL || ted4_voxel_set_init(&set, n * (K + 1)) != 0) {
        free(c);
        return ted4_trainer_fail(t, "no memory to grow anchors");
    }
    for (int depth = 0; depth < DEPTHS; depth++)
        found = collect(t, depth, &set, c, found);
    qsort(c, found, sizeof *c, compare_candidates);
    for (size_t i = 0; i < found && i < allowance && !bad; i++)
        bad = add_anchor(t, &c[i]) != 0;
    ted4_voxel_set_finish(&set);
    free(c);
    return bad ? -1 : 0;
}

/* Clears those statistics of anchor i that were used. */
static void reset_statistics(ted4_trainer *t, size_t i, int opacity)
{
    const int K = t->layout.head.n_offsets;

    for (int k = 0; k < K; k++) {
        float *count = ted4_anchor_value(&t->anchors, TED4_ROW_GRADIENT, i, K + k);

        if ((double)*count > GROW_SEEN * (double)t->opt.grow_every) {
            *count = 0.0f;
            *ted4_anchor_value(&t->anchors, TED4_ROW_GRADIENT, i, k) = 0.0f;
        }
    }
    for (int r = 0; opacity && r < 3; r++)
        *ted4_anchor_value(&t->anchors, TED4_ROW_OPACITY, i, r) = 0.0f;
}

/* An anchor to be pruned, and its mean opacity. */
typedef struct {
    double opacity;
    uint32_t anchor;
} faded;

static int compare_faded(const void *x, const void *y)
{
    const faded *a = x, *b = y;

    if (a->opacity != b->opacity)
        return a->opacity > b->opacity ? -1 : 1;
    return a->anchor < b->anchor ? -1 : a->anchor > b->anchor;
}

/* At least so many anchors stay, namely those of highest opacity, however low it is, so that the
 * model can grow again. */
enum { FEWEST = TED4_LANES };

/* Completes the list of anchors that stay, order[n], from those to be pruned, gone[m]. Returns the
 * new length of order. */
static size_t keep_fewest(uint32_t *order, size_t n, faded *gone, size_t m)
{
    if (n < FEWEST && m > 0)
        qsort(gone, m, sizeof *gone, compare_faded);
    for (size_t i = 0; i < m && n < FEWEST; i++)
        order[n++] = gone[i].anchor;
    return n;
}

static int prune(ted4_trainer *t, size_t n_old)
{
    ted4_anchors *a = &t->anchors;
    uint32_t *order = malloc((a->n + 1) * sizeof *order);
    faded *gone = malloc((a->n + 1) * sizeof *gone);
    size_t n = 0, m = 0;
    int bad = order == NULL || gone == NULL;

    for (size_t i = 0; !bad && i < a->n; i++) {
        const double visits = (double)*ted4_anchor_value(a, TED4_ROW_OPACITY, i, 1);
        const double there = (double)*ted4_anchor_value(a, TED4_ROW_OPACITY, i, 2);
        const double opacity = (double)*ted4_anchor_value(a, TED4_ROW_OPACITY, i, 0);
        const int ripe = visits > PRUNE_SEEN * (double)t->opt.grow_every && there >= SEEN_THERE;

        if (i < n_old)
            reset_statistics(t, i, ripe);
        if (i >= n_old || !ripe || opacity >= t->opt.prune_opacity * there)
            order[n++] = (uint32_t)i;
        else
            gone[m++] = (faded) { opacity / there, (uint32_t)i };
    }
    bad = bad || ted4_anchors_select(a, order, keep_fewest(order, n, gone, m)) != 0;
    free(order);
    free(gone);
    return bad ? ted4_trainer_fail(t, "no memory to prune anchors") : 0;
}

int ted4_densify_adjust(ted4_trainer *t, size_t allowance)
{
    const size_t n = t->anchors.n;

    if (grow(t, allowance) != 0 || prune(t, n) != 0)
        return -1;
    return ted4_arrange_anchors(t);
}
