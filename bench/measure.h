/* measure.h - common functions of the benchmarks: a clock, allocation that ends the program on
 * failure, counts of blended pairs, and the machine's name. Compiled at the base level (BENCH_FREE
 * in bench.mk), whichever level is in use.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BENCH_MEASURE_H
#define TED4_BENCH_MEASURE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "render/image_model.h"

static inline double now_ms(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static inline void *must(void *p)
{
    if (p == NULL) {
        fputs("benchmark: no memory\n", stderr);
        exit(3);
    }
    return p;
}

/* Pairs of a pixel and a Gaussian in a forward pass that kept its state: blended pairs, and
 * computed pairs. */
typedef struct {
    size_t blended, computed;
} pair_count;

static inline pair_count count_pairs(const struct ted4_raster *r, const ted4_view *v)
{
    const uint32_t *first = r->tile_first.data, *owner = r->owner.data;
    const ted4_reach *reach = r->reach.data;
    const ted4_splat2d *splat = r->splat2d.data;
    pair_count count = { 0, 0 };

    for (uint32_t tile = 0; tile < r->tiles_x * r->tiles_y; tile++)
        for (int k = 0; k < TED4_TILE_BLOCKS * TED4_VECS; k++) {
            const int block = k / TED4_VECS;
            ted4_vf px, py, alpha, w;

            ted4_block_pixels(tile % r->tiles_x, tile / r->tiles_x, block, k % TED4_VECS, &px, &py);
            ted4_vf t =
                ted4_vf_keep((px < (float)v->width) & (py < (float)v->height), ted4_vf_all(1.0f));
            for (uint32_t i = 0; i < first[tile + 1] - first[tile]; i++) {
                const size_t group = ted4_group_first(tile, first[tile]) + i / TED4_GROUP;

                if (reach[group].block[block] >> i % TED4_GROUP & 1) {
                    ted4_blend_step(&splat[owner[first[tile] + i]], px, py, &t, &alpha, &w);
                    count.blended += (size_t)__builtin_popcount(ted4_vi_bits(w > 0.0f));
                    count.computed += TED4_VEC;
                }
            }
        }
    return count;
}

/* Writes the "model name" of /proc/cpuinfo, or "unknown". */
static inline void machine_name(char *name, size_t size)
{
    FILE *f = fopen("/proc/cpuinfo", "r");
    char line[256];

    snprintf(name, size, "unknown");
    while (f != NULL && fgets(line, sizeof line, f) != NULL)
        if (strncmp(line, "model name", 10) == 0 && strchr(line, ':') != NULL) {
            line[strcspn(line, "\n")] = 0;
            snprintf(name, size, "%s", strchr(line, ':') + 2);
            break;
        }
    if (f != NULL)
        fclose(f);
}

#endif
