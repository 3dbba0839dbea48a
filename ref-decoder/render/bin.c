/* bin.c - second stage of raster.c: visible Gaussians in depth order (stable radix sort), then the list of each tile (counting sort).
 * Each pass splits its input into TED4_SORT_PARTS parts that count alone, adds the counts up in order, and lets the parts
 * place their items alone: a stable sort whatever runs the parts. Used by raster.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/raster_state.h"

enum { BUCKETS = 1 << TED4_RADIX_BITS };

typedef struct {
    struct ted4_raster *r;
    size_t              n_splats;
    const uint64_t     *from;
    uint64_t           *to;
    int                 shift;          /* of the digit that this pass sorts by */
} bin_job;

static size_t part_begin(const bin_job *job, size_t part)
{
    return job->r->n_visible * part / TED4_SORT_PARTS;
}

/* Counts to first places: item order is bucket, then part. total: where the last bucket ends. */
static uint32_t counts_to_places(uint32_t *hist, size_t n_buckets, uint32_t *bucket_first)
{
    uint32_t total = 0;

    for (size_t b = 0; b < n_buckets; b++) {
        if (bucket_first != NULL)
            bucket_first[b] = total;
        for (size_t part = 0; part < TED4_SORT_PARTS; part++) {
            const uint32_t count = hist[part * n_buckets + b];
            hist[part * n_buckets + b] = total;
            total += count;
        }
    }
    return total;
}

/* Moves a chunk's keys to their common array and makes its slots count from the beginning of the scene. */
static void gather_chunk(void *arg, size_t c)
{
    const bin_job   *job = arg;
    const ted4_chunk before = ((const ted4_chunk *)job->r->chunk.data)[c];
    const uint32_t   n_after = ((const ted4_chunk *)job->r->chunk.data)[c + 1].n_visible;
    const size_t     begin = c * TED4_CHUNK, end = begin + TED4_CHUNK < job->n_splats ? begin + TED4_CHUNK : job->n_splats;
    uint32_t        *first_slot = job->r->first_slot.data;

    memcpy(job->to + before.n_visible, job->from + begin, (n_after - before.n_visible) * sizeof *job->to);
    for (size_t i = begin; i < end; i++)
        first_slot[i] += before.n_instances;
}

/* The chunks' counts become the totals before them, with one entry more for all. -1: more instances than 32 bits count. */
static int add_up_chunks(struct ted4_raster *r, size_t n_chunks)
{
    ted4_chunk *chunk = r->chunk.data;
    size_t      n_visible = 0, n_instances = 0;

    for (size_t c = 0; c <= n_chunks; c++) {
        const ted4_chunk count = c < n_chunks ? chunk[c] : (ted4_chunk){0, 0};

        if (n_instances > UINT32_MAX)
            return -1;
        chunk[c] = (ted4_chunk){ (uint32_t)n_visible, (uint32_t)n_instances };
        n_visible   += count.n_visible;
        n_instances += count.n_instances;
    }
    r->n_visible   = n_visible;
    r->n_instances = n_instances;
    return 0;
}

static void count_digits(void *arg, size_t part)
{
    const bin_job *job = arg;
    uint32_t      *hist = (uint32_t *)job->r->hist.data + part * BUCKETS;

    memset(hist, 0, BUCKETS * sizeof *hist);
    for (size_t i = part_begin(job, part); i < part_begin(job, part + 1); i++)
        hist[job->from[i] >> job->shift & (BUCKETS - 1)]++;
}

static void place_keys(void *arg, size_t part)
{
    const bin_job *job = arg;
    uint32_t      *place = (uint32_t *)job->r->hist.data + part * BUCKETS;

    for (size_t i = part_begin(job, part); i < part_begin(job, part + 1); i++)
        job->to[place[job->from[i] >> job->shift & (BUCKETS - 1)]++] = job->from[i];
}

/* Sorts by the upper 32 bits. Depths are positive, so their bits are in their order. */
static void sort_by_depth(bin_job *job, const ted4_parallel *p)
{
    for (job->shift = 32; job->shift < 64; job->shift += TED4_RADIX_BITS) {
        ted4_parallel_for(p, TED4_SORT_PARTS, count_digits, job);
        counts_to_places(job->r->hist.data, BUCKETS, NULL);
        ted4_parallel_for(p, TED4_SORT_PARTS, place_keys, job);

        uint64_t *const sorted = job->to;
        job->to   = job->r->key[sorted == job->r->key[0].data].data;
        job->from = sorted;
    }
}

static void count_tiles(void *arg, size_t part)
{
    const bin_job       *job = arg;
    const ted4_tile_box *box = job->r->box.data;
    const size_t         n_tiles = (size_t)job->r->tiles_x * job->r->tiles_y;
    uint32_t            *hist = (uint32_t *)job->r->hist.data + part * n_tiles;

    memset(hist, 0, n_tiles * sizeof *hist);
    for (size_t i = part_begin(job, part), end = part_begin(job, part + 1); i < end; i++) {
        const ted4_tile_box b = box[(uint32_t)job->from[i]];

        if (i + TED4_AHEAD < end)
            __builtin_prefetch(&box[(uint32_t)job->from[i + TED4_AHEAD]]);
        for (uint32_t y = b.y0; y < b.y1; y++)
            for (uint32_t x = b.x0; x < b.x1; x++)
                hist[y * job->r->tiles_x + x]++;
    }
}

static void place_instances(void *arg, size_t part)
{
    const bin_job       *job = arg;
    const ted4_tile_box *box = job->r->box.data;
    const uint32_t      *first_slot = job->r->first_slot.data;
    uint32_t *place = (uint32_t *)job->r->hist.data + part * ((size_t)job->r->tiles_x * job->r->tiles_y);
    uint32_t *owner = job->r->owner.data, *slot = job->r->slot.data;

    for (size_t i = part_begin(job, part), end = part_begin(job, part + 1); i < end; i++) {
        const uint32_t      g = (uint32_t)job->from[i];
        const ted4_tile_box b = box[g];
        uint32_t            s = first_slot[g];

        if (i + TED4_AHEAD < end) {
            __builtin_prefetch(&box[(uint32_t)job->from[i + TED4_AHEAD]]);
            __builtin_prefetch(&first_slot[(uint32_t)job->from[i + TED4_AHEAD]]);
        }
        for (uint32_t y = b.y0; y < b.y1; y++)
            for (uint32_t x = b.x0; x < b.x1; x++) {
                const uint32_t at = place[y * job->r->tiles_x + x]++;

                owner[at] = g;
                slot[at]  = s++;
            }
    }
}

int ted4_raster_bin(struct ted4_raster *r, const ted4_splats *s, const ted4_parallel *p)
{
    const size_t n_chunks = (s->n + TED4_CHUNK - 1) / TED4_CHUNK, n_tiles = (size_t)r->tiles_x * r->tiles_y;
    const size_t n_buckets = n_tiles > BUCKETS ? n_tiles : BUCKETS;
    bin_job      job = { .r = r, .n_splats = s->n, .from = r->key[1].data, .to = r->key[0].data };

    if (add_up_chunks(r, n_chunks) != 0
        || ted4_growing_grow(&r->hist, TED4_SORT_PARTS * n_buckets, sizeof(uint32_t)) != 0
        || ted4_growing_grow(&r->tile_first, n_tiles + 1, sizeof(uint32_t)) != 0
        || ted4_growing_grow(&r->owner, r->n_instances + TED4_AHEAD, sizeof(uint32_t)) != 0
        || ted4_growing_grow(&r->slot, r->n_instances, sizeof(uint32_t)) != 0)
        return -1;
    ((uint32_t *)r->first_slot.data)[s->n] = (uint32_t)r->n_instances;
    memset((uint32_t *)r->owner.data + r->n_instances, 0, TED4_AHEAD * sizeof(uint32_t));

    ted4_parallel_for(p, n_chunks, gather_chunk, &job);
    job.from = r->key[0].data;
    job.to   = r->key[1].data;
    sort_by_depth(&job, p);

    uint32_t *tile_first = r->tile_first.data;
    ted4_parallel_for(p, TED4_SORT_PARTS, count_tiles, &job);
    tile_first[n_tiles] = counts_to_places(r->hist.data, n_tiles, tile_first);
    ted4_parallel_for(p, TED4_SORT_PARTS, place_instances, &job);
    return 0;
}
