/* bin.c - the second stage of raster.c: sorts the visible Gaussians by depth (stable radix sort),
 * then makes the list of each tile (counting sort). Each pass splits its input into TED4_SORT_PARTS
 * parts, which count independently of each other; adds up the counts in order; and then lets the
 * parts place their items independently. The sort is stable whatever the order and the threads in
 * which the parts run.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/raster_state.h"

#include <string.h>

/* Spare tiles after the last one, which stay empty: see tile_four. */
enum { SPARE_TILES = 3 };

/* Entries after the last instance: those that blend.c prefetches, then unused ones that each part
 * writes. */
enum { CAPACITY = TED4_AHEAD + TED4_SPARE * (TED4_SORT_PARTS + 1) };

typedef struct {
    struct ted4_raster *r;
    size_t n_splats;
    const uint64_t *from;
    uint64_t *to;
    uint32_t nearest; /* depth bits of the nearest Gaussian, subtracted from all keys */
    int depth_bits;   /* number of depth bits in keys after that */
    int shift, digit; /* first bit and number of bits by which this pass sorts */
} bin_job;

static size_t part_begin(const bin_job *job, size_t part)
{
    return job->r->n_visible * part / TED4_SORT_PARTS;
}

/* Converts counts to first places. Items are ordered by bucket, then by part. bucket_first[] gets
 * the first place of each bucket, unless it is NULL. */
static void counts_to_places(uint32_t *hist, size_t n_buckets, uint32_t *bucket_first)
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
}

/* Moves the keys of a chunk to the array of all keys, with depths relative to the nearest one, and
 * makes its first_instance count from the beginning of the scene. */
static void gather_chunk(void *arg, size_t c)
{
    const bin_job *job = arg;
    const ted4_chunk before = ((const ted4_chunk *)job->r->chunk.data)[c];
    const uint32_t n_after = ((const ted4_chunk *)job->r->chunk.data)[c + 1].n_visible;
    const size_t begin = c * TED4_CHUNK,
                 end = begin + TED4_CHUNK < job->n_splats ? begin + TED4_CHUNK : job->n_splats;
    uint32_t *first_instance = job->r->first_instance.data;

    for (size_t i = 0; i < n_after - before.n_visible; i++)
        job->to[before.n_visible + i] = job->from[begin + i] - ((uint64_t)job->nearest << 32);
    for (size_t i = begin; i < end; i++)
        first_instance[i] += before.n_instances;
}

/* Replaces the counts of each chunk by the totals of the chunks before it, with one more entry for
 * the totals of all. Returns 0, or -1 if instances cannot be numbered in 32 bits. */
static int add_up_chunks(bin_job *job, size_t n_chunks)
{
    ted4_chunk *chunk = job->r->chunk.data;
    size_t n_visible = 0, n_instances = 0;
    uint32_t nearest = UINT32_MAX, farthest = 0;

    for (size_t c = 0; c <= n_chunks; c++) {
        const ted4_chunk count = c < n_chunks ? chunk[c] : (ted4_chunk) { .nearest = UINT32_MAX };

        if (n_instances > UINT32_MAX - CAPACITY)
            return -1;
        chunk[c] =
            (ted4_chunk) { .n_visible = (uint32_t)n_visible, .n_instances = (uint32_t)n_instances };
        n_visible += count.n_visible;
        n_instances += count.n_instances;
        job->r->n_skipped += count.n_skipped;
        nearest = count.nearest < nearest ? count.nearest : nearest;
        farthest = count.farthest > farthest ? count.farthest : farthest;
    }
    job->r->n_visible = n_visible;
    job->r->n_instances = n_instances;
    job->nearest = nearest;
    for (job->depth_bits = 0; n_visible > 0 && (farthest - nearest) >> job->depth_bits > 0;)
        job->depth_bits++;
    return 0;
}

static size_t digit_of(const bin_job *job, size_t i)
{
    return (size_t)(job->from[i] >> job->shift & (((uint64_t)1 << job->digit) - 1));
}

static void count_digits(void *arg, size_t part)
{
    const bin_job *job = arg;
    uint32_t *hist = (uint32_t *)job->r->hist.data + (part << job->digit);

    memset(hist, 0, sizeof *hist << job->digit);
    for (size_t i = part_begin(job, part); i < part_begin(job, part + 1); i++)
        hist[digit_of(job, i)]++;
}

static void place_keys(void *arg, size_t part)
{
    const bin_job *job = arg;
    uint32_t *place = (uint32_t *)job->r->hist.data + (part << job->digit);

    for (size_t i = part_begin(job, part); i < part_begin(job, part + 1); i++)
        job->to[place[digit_of(job, i)]++] = job->from[i];
}

/* Sorts keys by their upper 32 bits, of which only depth_bits differ, in passes with nearly equal
 * numbers of bits. Depths are positive floats, so their bits have the same order as they have. */
static void sort_by_depth(bin_job *job, const ted4_parallel *p)
{
    int left = job->depth_bits;

    for (job->shift = 32; left > 0; job->shift += job->digit, left -= job->digit) {
        const int passes = (left + TED4_RADIX_BITS - 1) / TED4_RADIX_BITS;

        job->digit = (left + passes - 1) / passes;
        ted4_parallel_for(p, TED4_SORT_PARTS, count_digits, job);
        counts_to_places(job->r->hist.data, (size_t)1 << job->digit, NULL);
        ted4_parallel_for(p, TED4_SORT_PARTS, place_keys, job);

        uint64_t *const sorted = job->to;
        job->to = job->r->key[sorted == job->r->key[0].data].data;
        job->from = sorted;
    }
}

/* The tiles of a box of at most 2x2 tiles; there[k] is 1 if tile k exists. A box that is one tile
 * wide or high has spare tiles in the place of the missing ones, which avoids branches that depend
 * on the box. */
typedef struct {
    uint32_t tile[4], there[4];
} tile_four;

static inline int is_small(ted4_tile_box b)
{
    return b.x1 - b.x0 <= 2 && b.y1 - b.y0 <= 2;
}

/* Returns there ? tile : spare, without a branch. */
static inline uint32_t choose(uint32_t there, uint32_t tile, uint32_t spare)
{
    return spare ^ ((spare ^ tile) & -there);
}

static inline tile_four small_box(ted4_tile_box b, uint32_t tiles_x, uint32_t n_tiles)
{
    const uint32_t first = b.y0 * tiles_x + b.x0, right = b.x1 - b.x0 - 1u, low = b.y1 - b.y0 - 1u;

    return (tile_four) { { first, choose(right, first + 1, n_tiles),
                           choose(low, first + tiles_x, n_tiles + 1),
                           choose(right & low, first + tiles_x + 1, n_tiles + 2) },
                         { 1, right, low, right & low } };
}

static void count_tiles(void *arg, size_t part)
{
    const bin_job *job = arg;
    const ted4_tile_box *box = job->r->box.data;
    const uint32_t tiles_x = job->r->tiles_x, n_tiles = tiles_x * job->r->tiles_y;
    uint32_t *hist = (uint32_t *)job->r->hist.data + part * (n_tiles + SPARE_TILES);

    memset(hist, 0, (n_tiles + SPARE_TILES) * sizeof *hist);
    for (size_t i = part_begin(job, part), end = part_begin(job, part + 1); i < end; i++) {
        const ted4_tile_box b = box[(uint32_t)job->from[i]];

        if (i + TED4_AHEAD < end)
            __builtin_prefetch(&box[(uint32_t)job->from[i + TED4_AHEAD]]);
        if (is_small(b)) {
            const tile_four f = small_box(b, tiles_x, n_tiles);

            for (int k = 0; k < 4; k++)
                hist[f.tile[k]] += f.there[k];
            continue;
        }
        for (uint32_t y = b.y0; y < b.y1; y++)
            for (uint32_t x = b.x0; x < b.x1; x++)
                hist[y * tiles_x + x]++;
    }
}

/* Writes the instances of a part to their places; those of spare tiles go to unused entries. */
static void place_instances(void *arg, size_t part)
{
    const bin_job *job = arg;
    const ted4_tile_box *box = job->r->box.data;
    const uint32_t *first_instance = job->r->first_instance.data;
    const uint32_t tiles_x = job->r->tiles_x, n_tiles = tiles_x * job->r->tiles_y;
    uint32_t *place = (uint32_t *)job->r->hist.data + part * (n_tiles + SPARE_TILES);
    uint32_t *owner = job->r->owner.data, *instance = job->r->instance.data;

    for (int k = 0; k < SPARE_TILES; k++)
        place[n_tiles + k] = (uint32_t)(job->r->n_instances + TED4_AHEAD + TED4_SPARE * (part + 1));
    for (size_t i = part_begin(job, part), end = part_begin(job, part + 1); i < end; i++) {
        const uint32_t g = (uint32_t)job->from[i];
        const ted4_tile_box b = box[g];
        uint32_t s = first_instance[g];

        if (i + TED4_AHEAD < end) {
            __builtin_prefetch(&box[(uint32_t)job->from[i + TED4_AHEAD]]);
            __builtin_prefetch(&first_instance[(uint32_t)job->from[i + TED4_AHEAD]]);
        }
        if (is_small(b)) {
            const tile_four f = small_box(b, tiles_x, n_tiles);

            for (int k = 0; k < 4; s += f.there[k], k++) {
                const uint32_t at = place[f.tile[k]];

                owner[at] = g;
                instance[at] = s;
                place[f.tile[k]] = at + f.there[k];
            }
            continue;
        }
        for (uint32_t y = b.y0; y < b.y1; y++)
            for (uint32_t x = b.x0; x < b.x1; x++) {
                const uint32_t at = place[y * tiles_x + x]++;

                owner[at] = g;
                instance[at] = s++;
            }
    }
}

int ted4_raster_bin(struct ted4_raster *r, const ted4_splats *s, const ted4_parallel *p)
{
    const size_t n_chunks = (s->n + TED4_CHUNK - 1) / TED4_CHUNK,
                 n_tiles = (size_t)r->tiles_x * r->tiles_y;
    const size_t n_counted = n_tiles + SPARE_TILES, n_digits = (size_t)1 << TED4_RADIX_BITS;
    bin_job job = { .r = r, .n_splats = s->n, .from = r->key[1].data, .to = r->key[0].data };

    if (add_up_chunks(&job, n_chunks) != 0 ||
        ted4_growing_grow(&r->hist, TED4_SORT_PARTS * (n_counted > n_digits ? n_counted : n_digits),
                          sizeof(uint32_t)) != 0 ||
        ted4_growing_grow(&r->tile_first, n_counted, sizeof(uint32_t)) != 0 ||
        ted4_growing_grow(&r->owner, r->n_instances + CAPACITY, sizeof(uint32_t)) != 0 ||
        ted4_growing_grow(&r->instance, r->n_instances + CAPACITY, sizeof(uint32_t)) != 0)
        return -1;
    ((uint32_t *)r->first_instance.data)[s->n] = (uint32_t)r->n_instances;
    memset((uint32_t *)r->owner.data + r->n_instances, 0, TED4_AHEAD * sizeof(uint32_t));

    ted4_parallel_for(p, n_chunks, gather_chunk, &job);
    job.from = r->key[0].data;
    job.to = r->key[1].data;
    sort_by_depth(&job, p);

    uint32_t *tile_first = r->tile_first.data;
    ted4_parallel_for(p, TED4_SORT_PARTS, count_tiles, &job);
    counts_to_places(r->hist.data, n_counted, tile_first);
    ted4_parallel_for(p, TED4_SORT_PARTS, place_instances, &job);
    return 0;
}
