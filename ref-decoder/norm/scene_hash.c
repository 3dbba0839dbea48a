/* scene_hash.c - spec 15.2: the hash of everything Tier E decodes.
 * SPDX-License-Identifier: BSD-2-Clause */
#define XXH_STATIC_LINKING_ONLY             /* the hash state may lie on the stack */
#include <xxhash.h>

#include "base/bytes.h"
#include "norm/scene.h"

enum { BUFFER = 4096 };

/* Gathers the byte string of 15.2 piece by piece. */
typedef struct {
    XXH3_state_t state;
    size_t       n;
    uint8_t      bytes[BUFFER];
} hasher;

static void flush(hasher *h)
{
    (void)XXH3_128bits_update(&h->state, h->bytes, h->n);
    h->n = 0;
}

static void put8(hasher *h, uint8_t v)
{
    if (h->n == BUFFER)
        flush(h);
    h->bytes[h->n++] = v;
}

static void put16(hasher *h, uint16_t v)
{
    if (h->n > BUFFER - 2)
        flush(h);
    ted4_store16(h->bytes + h->n, v);
    h->n += 2;
}

/* Symbols of component comp of a type for anchors first .. end - 1: those that have it. */
static void put_component(hasher *h, const ted4_scene *s, int type,
                          unsigned comp, size_t first, size_t end)
{
    const int16_t *k = s->symbol[type] + (size_t)comp * s->head.n_anchors;

    for (size_t a = first; a < end; a++) {
        const int has = type == TED4_PHI ? s->dynamic[a]
                      : type == TED4_OFFSET ? s->offset_bits[a] >> comp / 3 & 1
                      : 1;

        if (has)
            put16(h, (uint16_t)k[a]);
    }
}

static void put_tile(hasher *h, const ted4_scene *s, size_t first, size_t end)
{
    for (size_t a = first; a < end; a++) {
        put8(h, s->dynamic[a]);
        put16(h, s->offset_bits[a]);
    }
    for (int t = 0; t < TED4_TYPES; t++)
        for (size_t a = first; s->shape.dim[t] > 0 && a < end; a++)
            put8(h, s->step_index[t][a]);
    for (int t = 0; t < TED4_TYPES; t++)
        for (unsigned c = 0; c < s->shape.dim[t]; c++)
            put_component(h, s, t, c, first, end);
}

/* spec 15.2 */
void ted4_scene_hash(const ted4_scene *s, uint8_t hash[16])
{
    const size_t n = s->head.n_anchors, step = s->head.tile_size;
    XXH128_canonical_t canonical;
    hasher h;

    XXH3_INITSTATE(&h.state);
    (void)XXH3_128bits_reset(&h.state);
    h.n = 0;
    for (size_t i = 0; i < 3 * n; i++)
        put16(&h, s->position[i]);
    for (size_t first = 0; first < n; first += step)
        put_tile(&h, s, first, n - first < step ? n : first + step);
    flush(&h);
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(&h.state));
    memcpy(hash, canonical.digest, sizeof canonical.digest);
}
