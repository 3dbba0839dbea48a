/* project.c - the first stage of raster.c: projects Gaussians onto the image plane, one register of
 * them at a time, culls them, and computes tile boxes and depth keys.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/image_model.h"

#include <float.h>

typedef struct {
    struct ted4_raster *r;
    const ted4_splats *s;
    const ted4_view *v;
    ted4_guard guard;
} project_job;

/* Computes the range of pixel columns (or rows) whose centres lie within reach of centre, from
 * first to last. Returns a mask of the lanes in which there are any. The reach is widened a little,
 * since the exact end of a Gaussian is decided per pixel, when it is blended. */
static inline ted4_vi pixel_range(ted4_vf centre, ted4_vf reach, int size, ted4_vi *first,
                                  ted4_vi *last)
{
    const ted4_vf wide = ted4_vf_fma(reach, ted4_vf_all(1.001f), ted4_vf_all(0.01f));
    const ted4_vf lo = centre - wide + 0.5f, hi = centre + wide - 0.5f;
    const ted4_vf lo_in = ted4_vf_keep(lo > 0.0f, lo),
                  hi_in = ted4_vf_min(hi, ted4_vf_all((float)(size - 1)));
    const ted4_vi any = (lo < (float)size) & (hi >= 0.0f);

    *first = __builtin_convertvector(ted4_vf_keep(any, lo_in), ted4_vi);
    *last = __builtin_convertvector(ted4_vf_keep(any, hi_in), ted4_vi);
    return any & (*first <= *last);
}

/* Writes the visible ones of a register of projected Gaussians, lane by lane. i is the index of the
 * first. */
static void store_splats(const project_job *job, size_t i, const ted4_projection *p, ted4_vf level,
                         uint32_t visible)
{
    ted4_splat2d *out = (ted4_splat2d *)job->r->splat2d.data + i;
    const ted4_vf lean_x = p->b / p->c, lean_y = p->b / p->a;

    for (size_t k = 0; visible != 0; k++, visible >>= 1)
        if (visible & 1)
            out[k] = (ted4_splat2d) {
                .x = p->x[k],
                .y = p->y[k],
                .a1 = p->a1[k],
                .a2 = p->a2[k],
                .a3 = p->a3[k],
                .level = level[k],
                .colour = { job->s->colour[0][i + k], job->s->colour[1][i + k],
                            job->s->colour[2][i + k] },
                .lean_x = lean_x[k],
                .lean_y = lean_y[k],
            };
}

/* Computes the tile boxes of a register of Gaussians, empty for invisible ones, and returns a bit
 * mask of the visible ones. All conditions are false for NaN. *skipped is decremented in the lane
 * of each Gaussian that is neither behind the camera nor too faint, but is not finite. */
static uint32_t make_boxes(const project_job *job, const ted4_projection *p, ted4_vf level,
                           ted4_vf opacity, size_t n, ted4_tile_box *box, ted4_vi *skipped)
{
    /* log2(alpha) falls by log2(e) / 2 d^T cov^-1 d. The largest dx with d^T cov^-1 d <= k is
     * sqrt(k a). */
    const ted4_vf k = (level - TED4_LOG2_ALPHA_MIN) * (2.0f / TED4_LOG2_E);
    ted4_vi x0, x1, y0, y1;
    const ted4_vi finite = (p->t[2] < FLT_MAX) & (p->det < FLT_MAX) & (opacity < FLT_MAX);
    ted4_vi ok = (p->t[2] > job->v->near_z) & (opacity >= TED4_RASTER_ALPHA_MIN) & finite;

    *skipped += ~((p->t[2] <= job->v->near_z) | (opacity < TED4_RASTER_ALPHA_MIN) | finite);
    ok &= pixel_range(p->x, ted4_vf_sqrt(k * p->a), job->v->width, &x0, &x1);
    ok &= pixel_range(p->y, ted4_vf_sqrt(k * p->c), job->v->height, &y0, &y1);

    const uint32_t visible = ted4_vi_bits(ok) & ((1u << n) - 1);
    for (size_t l = 0; l < n; l++)
        box[l] = (visible >> l & 1) == 0 ? (ted4_tile_box) { 0, 0, 0, 0 }
                                         : (ted4_tile_box) { (uint16_t)(x0[l] / TED4_TILE),
                                                             (uint16_t)(y0[l] / TED4_TILE),
                                                             (uint16_t)(x1[l] / TED4_TILE + 1),
                                                             (uint16_t)(y1[l] / TED4_TILE + 1) };
    return visible;
}

/* Returns whether each of a register of Gaussians is too faint to be drawn: no alpha of a pixel is
 * above its opacity. NaN is not faint. */
static int all_faint(ted4_vf opacity)
{
    return ted4_vi_bits(~(opacity < TED4_RASTER_ALPHA_MIN)) == 0;
}

/* Projects and stores one register of n Gaussians, i and following. */
static void project_group(const project_job *job, size_t i, size_t n, ted4_chunk *count,
                          uint64_t *key, ted4_vi *skipped)
{
    ted4_tile_box *box = (ted4_tile_box *)job->r->box.data + i;
    uint32_t *first_instance = (uint32_t *)job->r->first_instance.data + i;
    const ted4_vf opacity = ted4_vf_load_n(job->s->opacity + i, n);
    ted4_splat_lanes g;
    ted4_projection p;

    if (all_faint(opacity)) {
        memset(box, 0, n * sizeof *box);
        for (size_t k = 0; k < n; k++)
            first_instance[k] = count->n_instances;
        return;
    }
    ted4_splat_lanes_load(&g, job->s, i, n);
    ted4_project_lanes(&p, &g, job->v, &job->guard);

    ted4_vf level = ted4_vf_log2(opacity);
    if (job->guard.blur > job->guard.learnt)
        level += 0.5f * ted4_vf_log2(p.det_learnt / p.det);

    const ted4_vi depth = (ted4_vi)p.t[2];
    const uint32_t visible = make_boxes(job, &p, level, opacity, n, box, skipped);

    store_splats(job, i, &p, level, visible);
    for (size_t k = 0; k < n; k++) {
        first_instance[k] = count->n_instances;
        count->n_instances += ted4_tile_box_area(box[k]);
        key[count->n_visible] = (uint64_t)(uint32_t)depth[k] << 32 | (uint32_t)(i + k);
        count->n_visible += visible >> k & 1;
    }
}

/* Runs one job, of TED4_CHUNK Gaussians. The keys of visible ones go to the front of the chunk's
 * part of key[1]. first_instance counts from the beginning of the chunk; bin.c adds the number of
 * instances in the chunks before. */
static void project_chunk(void *arg, size_t c)
{
    const project_job *job = arg;
    const size_t begin = c * TED4_CHUNK,
                 end = begin + TED4_CHUNK < job->s->n ? begin + TED4_CHUNK : job->s->n;
    uint64_t *key = (uint64_t *)job->r->key[1].data + begin;
    ted4_chunk count = { .nearest = UINT32_MAX };
    ted4_vi skipped = { 0 };

    for (size_t i = begin; i < end; i += TED4_VEC)
        project_group(job, i, end - i < TED4_VEC ? end - i : TED4_VEC, &count, key, &skipped);
    for (int k = 0; k < TED4_VEC; k++)
        count.n_skipped -= (uint32_t)skipped[k];
    for (size_t k = 0; k < count.n_visible; k++) {
        const uint32_t depth = (uint32_t)(key[k] >> 32);

        count.nearest = depth < count.nearest ? depth : count.nearest;
        count.farthest = depth > count.farthest ? depth : count.farthest;
    }
    ((ted4_chunk *)job->r->chunk.data)[c] = count;
}

int TED4_LEVELED(ted4_raster_project)(struct ted4_raster *r, const ted4_splats *s,
                                      const ted4_view *v, const ted4_parallel *p)
{
    const size_t n_chunks = (s->n + TED4_CHUNK - 1) / TED4_CHUNK;
    project_job job = { r, s, v, ted4_guard_make(v) };

    if (s->n > UINT32_MAX - TED4_CHUNK ||
        ted4_growing_grow(&r->splat2d, s->n, sizeof(ted4_splat2d)) != 0 ||
        ted4_growing_grow(&r->box, s->n, sizeof(ted4_tile_box)) != 0 ||
        ted4_growing_grow(&r->first_instance, s->n + 1, sizeof(uint32_t)) != 0 ||
        ted4_growing_grow(&r->key[0], s->n, sizeof(uint64_t)) != 0 ||
        ted4_growing_grow(&r->key[1], s->n, sizeof(uint64_t)) != 0 ||
        ted4_growing_grow(&r->chunk, n_chunks + 1, sizeof(ted4_chunk)) != 0)
        return -1;
    ted4_parallel_for(p, n_chunks, project_chunk, &job);
    return 0;
}
