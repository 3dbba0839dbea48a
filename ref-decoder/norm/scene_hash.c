/* scene_hash.c - spec 15.2: computes the hash of the decoded integers.
 * SPDX-License-Identifier: BSD-2-Clause */
#define XXH_STATIC_LINKING_ONLY /* allows the hash state to be on the stack */
#include <xxhash.h>

#include "base/bytes.h"
#include "norm/scene.h"

enum { BUFFER = 4096 };

/* Hashes the byte string of spec 15.2 piece by piece; bytes[0 .. n) are not hashed yet. */
typedef struct {
    XXH3_state_t state;
    size_t n;
    uint8_t bytes[BUFFER];
} hasher;

static void flush(hasher *h)
{
    (void)XXH3_128bits_update(&h->state, h->bytes, h->n);
    h->n = 0;
}

static void put_bytes(hasher *h, const uint8_t *v, size_t n)
{
    flush(h);
    (void)XXH3_128bits_update(&h->state, v, n);
}

/* Hashes n 16-bit numbers, converting as many to bytes at a time as fit the buffer. */
static void put_numbers(hasher *h, const uint16_t *v, size_t n)
{
    const size_t per_batch = BUFFER / 2;

    flush(h);
    for (size_t from = 0; from < n; from += per_batch) {
        const size_t m = n - from < per_batch ? n - from : per_batch;

        for (size_t i = 0; i < m; i++)
            ted4_store16(h->bytes + 2 * i, v[from + i]);
        h->n = 2 * m;
        flush(h);
    }
}

/* Writes the symbols of those of n anchors that move. Returns the number of bytes written. The last
 * write of two bytes may lie beyond them. */
static size_t put_moving(uint8_t *to, const int16_t *k, const uint8_t *dynamic, size_t n)
{
    size_t at = 0;

    for (size_t a = 0; a < n; a++) {
        ted4_store16(to + at, (uint16_t)k[a]);
        at += dynamic[a] != 0 ? 2 : 0;
    }
    return at;
}

/* Does the same for the symbols of anchors that keep the given offset. */
static size_t put_kept(uint8_t *to, const int16_t *k, const uint16_t *offset_bits, unsigned offset,
                       size_t n)
{
    size_t at = 0;

    for (size_t a = 0; a < n; a++) {
        ted4_store16(to + at, (uint16_t)k[a]);
        at += (offset_bits[a] >> offset & 1) != 0 ? 2 : 0;
    }
    return at;
}

/* Hashes the symbols of component comp of a type, for those of the anchors first .. end - 1 that
 * have this component. */
static void put_component(hasher *h, const ted4_scene *s, int type, unsigned comp, size_t first,
                          size_t end)
{
    const int16_t *k = s->symbol[type] + (size_t)comp * s->head.n_anchors;

    if (type != TED4_PHI && type != TED4_OFFSET) {
        put_numbers(h, (const uint16_t *)(k + first), end - first);
        return;
    }
    for (size_t a = first; a < end; a += BUFFER / 2) {
        const size_t n = end - a < BUFFER / 2 ? end - a : BUFFER / 2;

        flush(h);
        h->n = type == TED4_PHI ? put_moving(h->bytes, k + a, s->dynamic + a, n)
                                : put_kept(h->bytes, k + a, s->offset_bits + a, comp / 3, n);
    }
}

static void put_tile(hasher *h, const ted4_scene *s, size_t first, size_t end)
{
    for (size_t a = first; a < end; a++) {
        if (h->n > BUFFER - 3)
            flush(h);
        h->bytes[h->n] = s->dynamic[a];
        ted4_store16(h->bytes + h->n + 1, s->offset_bits[a]);
        h->n += 3;
    }
    for (int t = 0; t < TED4_TYPES; t++)
        if (s->shape.dim[t] > 0)
            put_bytes(h, s->step_index[t] + first, end - first);
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
    put_numbers(&h, s->position, 3 * n);
    for (size_t first = 0; first < n; first += step)
        put_tile(&h, s, first, n - first < step ? n : first + step);
    flush(&h);
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(&h.state));
    memcpy(hash, canonical.digest, sizeof canonical.digest);
}
