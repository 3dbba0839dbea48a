/* still_anchors.c - finds the anchors whose motion explains nothing, and closes them: see
 * still_anchors.h. What an anchor shows without motion is nearly its Gaussians' mean over time,
 * once training has repaired what does not change over time. So the difference between a Gaussian
 * and its mean is what closing would change.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "still_anchors.h"

#include <math.h>
#include <stdlib.h>

#include "train/state/anchor_masks.h"
#include "train/state/picture.h"
#include "train/state/view_subset.h"
#include "train/state/visible_blocks.h"

/* A path is sampled at this many times at most. */
enum { MOST_TIMES = 64 };
/* Added to the opacity by which a time is weighted, for anchors that are never opaque. */
#define LEAST_WEIGHT 1e-6f
/* The number of sampled pictures, as a share of the steps of stage 1, and at least FEWEST. */
#define SHARE        0.01
enum { FEWEST = 64 };

/* What motion changes of a Gaussian: mean 3, scale 3, rotation 4. */
enum { PARTS = 10 };

/* All arrays are owned. Gaussians are numbered as by ted4_generate for all blocks: Gaussian k of
 * anchor i is (i / 32 K + k) 32 + i % 32. */
typedef struct {
    size_t room;      /* Gaussians of all blocks */
    float *mean_part; /* [PARTS][room] over time: sums, then means */
    float *weight;    /* [n] sum of the weights of all times */
    float *middle;    /* [n][3] of the path, relative to the position; normalised space */
    float *harm;      /* [n] */
    uint8_t *seen;    /* [n] whether a sampled picture shows the anchor */
} survey;

static float *position(const ted4_trainer *t, size_t i, int c)
{
    return ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, c);
}

static float *logit(const ted4_trainer *t, size_t i)
{
    return ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.temporal_logit);
}

static size_t gaussian(const ted4_trainer *t, size_t i, size_t k)
{
    return (i / TED4_LANES * t->layout.head.n_offsets + k) * TED4_LANES + i % TED4_LANES;
}

static void parts_of(const ted4_splats *g, const float *part[PARTS])
{
    for (int c = 0; c < 3; c++) {
        part[c] = g->mean[c];
        part[3 + c] = g->scale[c];
    }
    for (int c = 0; c < 4; c++)
        part[6 + c] = g->rot[c];
}

/* Generates the Gaussians of t->visible_blocks at a frame, as seen from the camera of picture item.
 */
static int generate(ted4_trainer *t, uint32_t item, uint32_t frame, ted4_splats *g)
{
    const uint32_t frames = t->data->n_frames;
    ted4_view v;
    ted4_generate_input in = { .layout = &t->layout,
                               .net = t->net.value,
                               .n_visible = t->visible_blocks.n,
                               .attr = t->visible_blocks.used,
                               .position = t->visible_blocks.position,
                               .lanes = t->visible_blocks.lanes,
                               .num = frames > 1 ? frame : 0,
                               .den = frames > 1 ? frames - 1 : 1,
                               .activation = t->layout.head.activation };

    ted4_trainer_view(t, &t->data->pictures[item], &v, in.camera);
    ted4_generator_pack(t->work.generator, t->net.value);
    return ted4_generate(t->work.generator, &in, t->parallel, g) != 0
               ? ted4_trainer_fail(t, "no memory to look at motion")
               : 0;
}

static float opacity(const ted4_trainer *t, const ted4_splats *g, size_t i)
{
    float sum = LEAST_WEIGHT;

    for (size_t k = 0; k < t->layout.head.n_offsets; k++)
        sum += g->opacity[gaussian(t, i, k)];
    return sum;
}

/* Adds the Gaussians of all anchors at one time. */
static void add_time(const ted4_trainer *t, const ted4_splats *g, survey *s)
{
    const float *part[PARTS];

    parts_of(g, part);
    for (size_t i = 0; i < t->anchors.n; i++) {
        const float w = opacity(t, g, i);

        s->weight[i] += w;
        for (size_t k = 0; k < t->layout.head.n_offsets; k++)
            for (size_t p = 0; p < PARTS; p++)
                s->mean_part[p * s->room + gaussian(t, i, k)] += w * part[p][gaussian(t, i, k)];
    }
}

/* Computes the means over time of all Gaussians. */
static int find_means(ted4_trainer *t, survey *s)
{
    const uint32_t frames = t->data->n_frames > 0 ? t->data->n_frames : 1,
                   n = frames < MOST_TIMES ? frames : MOST_TIMES;

    if (ted4_visible_blocks_fill(t, NULL) != 0)
        return -1;
    for (uint32_t k = 0; k < n; k++) {
        const uint32_t frame = n > 1 ? (uint32_t)((uint64_t)k * (frames - 1) / (n - 1)) : 0;
        ted4_splats g;

        if (generate(t, t->order.item[0], frame, &g) != 0)
            return -1;
        add_time(t, &g, s);
    }
    for (size_t i = 0; i < t->anchors.n; i++)
        for (size_t k = 0; k < t->layout.head.n_offsets; k++)
            for (size_t p = 0; p < PARTS; p++)
                s->mean_part[p * s->room + gaussian(t, i, k)] /= s->weight[i];
    return 0;
}

/* Computes the middles of all paths: the first Gaussian's mean over time less its mean without
 * motion, since its distance from the anchor is the same at all times (spec 11.5). */
static int find_middles(ted4_trainer *t, survey *s)
{
    float *before = malloc((t->anchors.n + 1) * sizeof *before);
    ted4_splats g;
    int bad;

    if (before == NULL)
        return ted4_trainer_fail(t, "no memory to look at motion");
    for (size_t i = 0; i < t->anchors.n; i++) {
        before[i] = *logit(t, i);
        *logit(t, i) = TED4_MASK_CLOSED;
    }
    bad = generate(t, t->order.item[0], 0, &g) != 0;
    for (size_t i = 0; i < t->anchors.n; i++) {
        *logit(t, i) = before[i];
        for (size_t c = 0; !bad && c < 3; c++)
            s->middle[3 * i + c] = s->mean_part[c * s->room + gaussian(t, i, 0)] -
                                   g.mean[c][gaussian(t, i, 0)];
    }
    free(before);
    return bad ? -1 : 0;
}

/* Adds the first-order change of one picture's distortion if each anchor showed its means. g: its
 * Gaussians, of t->visible_blocks. */
static void gather(const ted4_trainer *t, const ted4_splats *g, float weight, survey *s)
{
    const ted4_splat_grads *d = &t->work.splat_gradient;
    const float *const slope[PARTS] = { d->mean[0],  d->mean[1],  d->mean[2], d->scale[0],
                                        d->scale[1], d->scale[2], d->rot[0],  d->rot[1],
                                        d->rot[2],   d->rot[3] };
    const size_t K = t->layout.head.n_offsets;
    const float *part[PARTS];

    parts_of(g, part);
    for (size_t b = 0; b < t->visible_blocks.awake; b++)
        for (size_t j = 0; j < TED4_LANES; j++) {
            const size_t i = t->visible_blocks.block[b] * (size_t)TED4_LANES + j;
            float change = 0;

            if (!(t->visible_blocks.lanes[b] >> j & 1))
                continue; /* may be one of the last block's lanes behind the last anchor */
            for (size_t k = 0; k < K; k++) {
                const size_t at = (b * K + k) * TED4_LANES + j;

                if (!d->visible[at])
                    continue;
                s->seen[i] = 1;
                for (size_t p = 0; p < PARTS; p++)
                    change += slope[p][at] *
                              (s->mean_part[p * s->room + gaussian(t, i, k)] - part[p][at]);
            }
            s->harm[i] += weight * fabsf(change);
        }
}

static int look(ted4_trainer *t, survey *s)
{
    const size_t want = (size_t)fmax(FEWEST, SHARE * (double)t->opt.stage1),
                 n = want < t->order.n ? want : t->order.n;
    uint32_t *item = malloc((n + 1) * sizeof *item);
    int bad = item == NULL ? ted4_trainer_fail(t, "no memory to look at motion")
                           : ted4_view_subset_choose(t, t->opt.seed ^ 0x7374696c6cu, n, item) != 0;

    bad = bad || find_means(t, s) != 0 || find_middles(t, s) != 0;
    for (size_t i = 0; !bad && i < n; i++) {
        ted4_splats g;

        bad = ted4_distortion_gradient(t, item[i], &g) != 0;
        if (!bad)
            gather(t, &g, 1.0f / (float)n, s);
    }
    free(item);
    return bad ? -1 : 0;
}

/* Returns whether anchor i is to be closed, if its motion is worth less than price. The comparisons
 * are false for numbers that are not finite. */
static int explains_nothing(const ted4_trainer *t, const survey *s, size_t i, double price)
{
    int inside = 1;

    for (int c = 0; c < 3; c++)
        inside &= fabsf(*position(t, i, c) + s->middle[3 * i + (size_t)c]) <= 1.0f;
    return inside && s->seen[i] && (double)s->harm[i] < price;
}

static void decide(ted4_trainer *t, const survey *s)
{
    const double price = t->opt.motion_worth * t->progress.loss / (double)t->anchors.n;

    t->closing = (ted4_closing) { .anchors = t->anchors.n, .moving = ted4_count_dynamic(t) };
    for (size_t i = 0; i < t->anchors.n; i++)
        if (ted4_is_dynamic(t, i) && explains_nothing(t, s, i, price)) {
            for (int c = 0; c < 3; c++)
                *position(t, i, c) += s->middle[3 * i + (size_t)c];
            *logit(t, i) = TED4_MASK_CLOSED;
            t->closing.closed++;
        }
}

int ted4_close_still_anchors(ted4_trainer *t)
{
    const ted4_header *h = &t->layout.head;
    const size_t n = t->anchors.n;
    survey s = { 0 };
    int bad;

    if (h->motion == TED4_MOTION_NONE || !h->temporal_mask || !(t->opt.motion_worth > 0))
        return 0;
    s.room = t->anchors.n_blocks * h->n_offsets * TED4_LANES;
    s.mean_part = calloc(PARTS * s.room + 1, sizeof *s.mean_part);
    s.weight = calloc(n + 1, sizeof *s.weight);
    s.middle = calloc(3 * n + 1, sizeof *s.middle);
    s.harm = calloc(n + 1, sizeof *s.harm);
    s.seen = calloc(n + 1, sizeof *s.seen);
    bad = s.mean_part == NULL || s.weight == NULL || s.middle == NULL || s.harm == NULL ||
                  s.seen == NULL
              ? ted4_trainer_fail(t, "no memory to look at motion")
              : look(t, &s);
    if (!bad)
        decide(t, &s);
    free(s.mean_part);
    free(s.weight);
    free(s.middle);
    free(s.harm);
    free(s.seen);
    return bad;
}
