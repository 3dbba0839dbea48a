/* query_hash.c - computes the hash of a query's records (spec 15.3).
 * SPDX-License-Identifier: BSD-2-Clause */
#define XXH_STATIC_LINKING_ONLY /* state on the stack */
#include <xxhash.h>
#include "base/bytes.h"
#include "ted4.h"

enum { VALUES = 14, BATCH = 64 }; /* values per record; records hashed at a time */

void ted4_gaussians_hash(const ted4_gaussians *g, uint8_t hash[16])
{
    const float *const channel[VALUES] = { g->mean[0],   g->mean[1],  g->mean[2], g->scale[0],
                                           g->scale[1],  g->scale[2], g->rot[0],  g->rot[1],
                                           g->rot[2],    g->rot[3],   g->opacity, g->colour[0],
                                           g->colour[1], g->colour[2] };
    uint8_t bytes[BATCH * VALUES * 4];
    XXH128_canonical_t canonical;
    XXH3_state_t state;

    XXH3_INITSTATE(&state);
    (void)XXH3_128bits_reset(&state);
    for (size_t i = 0; i < g->n; i += BATCH) {
        const size_t n = g->n - i < BATCH ? g->n - i : BATCH;

        for (size_t j = 0; j < n; j++)
            for (size_t c = 0; c < VALUES; c++)
                ted4_store32(bytes + 4 * (j * VALUES + c), ted4_float_bits(channel[c][i + j]));
        (void)XXH3_128bits_update(&state, bytes, n * VALUES * 4);
    }
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(&state));
    memcpy(hash, canonical.digest, sizeof canonical.digest);
}
