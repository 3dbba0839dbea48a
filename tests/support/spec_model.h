/* spec_model.h - a complete decoder built from the code that the specification prints, its tables
 * of elements (6.1) and of levels (13.1), and its rules that are stated in words. Shares nothing
 * with ref-decoder except the tables of annex A. Slow and simple; for tests and for the generator
 * of annex B. spec/code.h, spec/head.inc and spec/levels.inc are extracted from spec/ by
 * tests/spec/ (see spec.mk).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPEC_MODEL_H
#define TED4_SPEC_MODEL_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "tests/spec/names.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "spec/code.h"
#pragma GCC diagnostic pop

enum {
    BOUND_NONE,
    BOUND_n_anchors,
    BOUND_n_offsets,
    BOUND_frames,
    BOUND_values,
    BOUND_products,
    BOUND_file_bytes,
    BOUND_symbols,
    N_BOUNDS
};

typedef struct {
    struct scene s;
    struct verdict v;
    uint64_t bound[N_BOUNDS];
    size_t n_nete, n_units, n_netr, n_bank, n_tiles, tiles_seen;
    struct net net_e[16], net_r[NETS_R];
    int32_t *model; /* of the tile decoded last: [its anchors][P] */
    int bank_seen;
    void *block[32]; /* owned */
    int n_blocks;
    void (*tile_done)(void *user,
                      uint32_t number); /* NULL, or called when a tile has been decoded */
    void *user;
} spec_model;

/* A part of a file that is being read. */
typedef struct {
    const uint8_t *file;
    uint64_t pos, end; /* offsets in the file */
    struct verdict *v;
} spec_reader;

static inline void *spec_take(spec_model *m, size_t n, size_t size)
{
    void *p = calloc(n + 1, size);

    if (p == NULL)
        abort();
    return m->block[m->n_blocks++] = p;
}

static inline void spec_model_free(spec_model *m)
{
    while (m->n_blocks > 0)
        free(m->block[--m->n_blocks]);
}

/* R-CON-011 */
static inline uint32_t spec_number(spec_reader *r, int width)
{
    const uint8_t *p = r->file + r->pos;

    if (r->v->id != NULL || r->end - r->pos < (uint64_t)width) {
        fail(r->v, "con.payload-size", r->pos);
        return 0;
    }
    r->pos += (uint64_t)width;
    return width == 1 ? p[0] : width == 2 ? load16(p) : load32(p);
}

static inline void spec_all_read(spec_reader *r)
{
    if (r->pos < r->end)
        fail(r->v, "con.payload-size", r->pos);
}

static inline int64_t spec_signed(uint32_t x, int width)
{
    return x >= (uint32_t)1 << (8 * width - 1) ? (int64_t)x - ((int64_t)1 << 8 * width)
                                               : (int64_t)x;
}

/* R-HDR-001 to R-HDR-003, for an element read at offset at. */
static inline void spec_judge(spec_model *m, uint64_t at, int64_t x, int64_t low, int64_t high,
                              int conditional, int holds, int bound)
{
    const int64_t lowest = conditional && low > 0 ? 0 : low;

    if (x < lowest || x > high)
        fail(&m->v, "hdr.range", at);
    if (conditional && (holds ? x < low : x != 0))
        fail(&m->v, "hdr.combination", at);
    if (bound != BOUND_NONE && (uint64_t)x > m->bound[bound])
        fail(&m->v, "lvl.exceeded", at);
}

static inline void spec_set_level(spec_model *m, int level)
{
#define LEVEL(number, ...)                                          \
    if (level == (number)) {                                        \
        const uint64_t row[N_BOUNDS] = { UINT64_MAX, __VA_ARGS__ }; \
        memcpy(m->bound, row, sizeof row);                          \
    }
#include "spec/levels.inc"
#undef LEVEL
}

static inline void spec_read_elements(spec_model *m, spec_reader *r)
{
    struct header *h = &m->s.h;
    int64_t sum = 0;
    uint64_t at;

#define ELEMENT(name, count, width, is_signed, low, high, conditional, condition, level) \
    for (int64_t i = 0; i < (count) && m->v.id == NULL; i++) {                           \
        int64_t *x = &((int64_t *)&h->name)[i];                                          \
        at = r->pos;                                                                     \
        *x = spec_number(r, width);                                                      \
        if (is_signed)                                                                   \
            *x = spec_signed((uint32_t)*x, width);                                       \
        if (m->v.id == NULL)                                                             \
            spec_judge(m, at, *x, low, high, conditional, condition, BOUND_##level);     \
        sum += x == h->slice + i ? *x : 0;                                               \
        if (x == h->slice + i && i == h->n_slices - 1 && sum != h->feature_dim)          \
            fail(&m->v, "hdr.combination", at);                                          \
    }
#define REAL(name, count, bounded)                                                         \
    for (int64_t i = 0; i < (count) && m->v.id == NULL; i++) {                             \
        at = r->pos;                                                                       \
        h->name[i] = spec_number(r, 4);                                                    \
        if (!f32_legal(h->name[i]) || ((bounded) && !(from_bits(h->name[i]) >= 0x1p-20f && \
                                                      from_bits(h->name[i]) <= 0x1p10f)))  \
            fail(&m->v, "hdr.range", at);                                                  \
    }
#include "spec/head.inc"
#undef ELEMENT
#undef REAL
}

/* Sum of inputs x outputs over the layers of one network. */
static inline uint64_t spec_products(const struct net *n)
{
    uint64_t sum = 0;

    for (int i = 0; i < n->n_layers; i++)
        sum += (uint64_t)n->dim[i] * (uint64_t)n->dim[i + 1];
    return sum;
}

static inline void spec_read_head(spec_model *m, spec_reader *r, uint64_t file_bytes)
{
    const struct header *h = &m->s.h;
    uint64_t products = 0;

    spec_read_elements(m, r);
    if (m->v.id != NULL)
        return;
    m->n_nete = nets_e(h, m->net_e, &m->n_units);
    m->n_netr = nets_r(h, m->net_r);
    m->n_bank = h->phi_dim > 0 ? (size_t)h->bank_rows * (size_t)h->bank_dim : 0;
    m->n_tiles = (size_t)((h->n_anchors + h->tile_size - 1) / h->tile_size);
    for (int i = 0; i < h->n_slices; i++)
        products += spec_products(&m->net_e[i]);
    if (m->n_nete + m->n_netr + m->n_bank > m->bound[BOUND_values] ||
        products > m->bound[BOUND_products] ||
        (m->bound[BOUND_symbols] != UINT64_MAX &&
         (uint64_t)h->n_anchors * components(h) > m->bound[BOUND_symbols] * file_bytes))
        fail(&m->v, "lvl.exceeded", r->pos - 1);
    spec_all_read(r);
}

/* spec 7.2. at, step: where errors place the values. Returns NULL after an error. */
static inline uint32_t *spec_read_blob(spec_model *m, spec_reader *r, size_t n, uint64_t *at,
                                       int *step)
{
    const uint64_t before = r->pos;
    const uint32_t mode = spec_number(r, 1);
    const uint64_t left = r->end - r->pos;
    uint32_t *values;
    uint8_t *bytes;

    *at = r->pos;
    *step = mode == 0 ? 4 : 0;
    if (mode > 1)
        fail(&m->v, "net.mode", before);
    else if (mode == 0 && left / 4 < n)
        fail(&m->v, "con.payload-size", r->pos);
    else if (mode == 1 && (left >= 4 * n || 4 * n > 1032 * left))
        fail(&m->v, "net.deflate", r->pos);
    if (m->v.id != NULL)
        return NULL;
    values = spec_take(m, n, 4);
    for (size_t i = 0; mode == 0 && i < n; i++)
        values[i] = load32(r->file + r->pos + 4 * i);
    r->pos += mode == 0 ? 4 * n : left;
    if (mode == 0)
        return values;
    bytes = spec_take(m, n, 4);
    if (!inflate_exactly(r->file + *at, (size_t)left, bytes, 4 * n))
        fail(&m->v, "net.deflate", *at);
    for (size_t i = 0; i < n; i++)
        values[i] = unshuffled(bytes, n, i);
    return values;
}

static inline void spec_read_shifts(spec_model *m, spec_reader *r, uint8_t *shift)
{
    size_t unit = 0;

    for (int k = 0; k < m->s.h.n_slices; k++) {
        const struct net *n = &m->net_e[k];

        for (int i = 0; i < n->n_layers; i++)
            for (int o = 0; o < n->dim[i + 1] && m->v.id == NULL; o++, unit++) {
                const uint64_t at = r->pos;

                shift[unit] = (uint8_t)spec_number(r, 1);
                if (shift[unit] > 20 || shift[unit] + bits_in(&m->s.h, k, i) - bits_out(n, i) < 0)
                    fail(&m->v, "net.shift", at);
            }
    }
}

static inline void spec_read_nete(spec_model *m, spec_reader *r)
{
    uint8_t *shift = spec_take(m, m->n_units, 1);
    uint64_t at = 0;
    int step = 0;
    uint32_t *values;

    spec_read_shifts(m, r, shift);
    values = m->v.id == NULL ? spec_read_blob(m, r, m->n_nete, &at, &step) : NULL;
    m->s.shift = shift;
    m->s.nete = values;
    for (int k = 0; k < m->s.h.n_slices && m->v.id == NULL; k++) {
        const struct net *n = &m->net_e[k];
        size_t v = n->first_value, unit = n->first_unit;

        for (int i = 0; i < n->n_layers && m->v.id == NULL; i++) {
            judge_layer(&m->s.h, n, k, i, values + v, shift + unit, at + (uint64_t)step * v, step,
                        &m->v);
            v += (size_t)(n->dim[i] + 1) * (size_t)n->dim[i + 1];
            unit += (size_t)n->dim[i + 1];
        }
    }
    spec_all_read(r);
}

static inline const uint32_t *spec_read_values(spec_model *m, spec_reader *r, size_t n)
{
    uint64_t at = 0;
    int step = 0;
    uint32_t *values = spec_read_blob(m, r, n, &at, &step);

    for (size_t i = 0; m->v.id == NULL && i < n; i++)
        if (!f32_legal(values[i]))
            fail(&m->v, "net.value", at + (uint64_t)step * i);
    spec_all_read(r);
    return values;
}

static inline void spec_read_positions(spec_model *m, spec_reader *r)
{
    const size_t n = (size_t)m->s.h.n_anchors, tile = (size_t)m->s.h.tile_size;
    uint16_t *p;

    if ((r->end - r->pos) / 6 < n) {
        fail(&m->v, "con.payload-size", r->pos);
        return;
    }
    p = spec_take(m, 3 * n, 2);
    for (size_t i = 0; i < 3 * n; i++)
        p[i] = (uint16_t)load16(r->file + r->pos + 2 * i);
    judge_positions(p, n, r->pos, &m->v);
    m->s.position = p;
    m->s.dynamic = spec_take(m, n, 1);
    m->s.offset_bits = spec_take(m, n, 2);
    for (int type = 0; type < TYPES; type++) {
        m->s.step_index[type] = spec_take(m, n, 1);
        m->s.symbol[type] = spec_take(m, n * (size_t)type_dim(&m->s.h, type), 2);
    }
    m->model = spec_take(m, (n < tile ? n : tile) * (size_t)n_outputs(&m->s.h), sizeof *m->model);
    r->pos += 6 * n;
    spec_all_read(r);
}

/* A growing byte string. */
typedef struct {
    uint8_t *data;
    size_t size, capacity;
} spec_bytes;

static inline void spec_put(spec_bytes *b, uint64_t x, int width)
{
    if (b->capacity - b->size < 8) {
        b->capacity = 2 * b->capacity + 64;
        b->data = realloc(b->data, b->capacity);
        if (b->data == NULL)
            abort();
    }
    for (int i = 0; i < width; i++)
        b->data[b->size++] = (uint8_t)(x >> 8 * i);
}

static inline size_t spec_tile_end(const struct header *h, size_t first)
{
    return (size_t)(h->n_anchors - (int64_t)first < h->tile_size ? h->n_anchors
                                                                 : (int64_t)first + h->tile_size);
}

/* R-INT-002 */
static inline void spec_integers_hash(const struct scene *s, uint8_t hash[16])
{
    const struct header *h = &s->h;
    const size_t n = (size_t)h->n_anchors;
    spec_bytes b = { NULL, 0, 0 };

    for (size_t i = 0; i < 3 * n; i++)
        spec_put(&b, s->position[i], 2);
    for (size_t first = 0; first < n; first = spec_tile_end(h, first)) {
        const size_t end = spec_tile_end(h, first);

        for (size_t a = first; a < end; a++) {
            spec_put(&b, s->dynamic[a], 1);
            spec_put(&b, s->offset_bits[a], 2);
        }
        for (int type = 0; type < TYPES; type++)
            for (size_t a = first; type_dim(h, type) > 0 && a < end; a++)
                spec_put(&b, s->step_index[type][a], 1);
        for (int type = 0; type < TYPES; type++)
            for (int c = 0; c < type_dim(h, type); c++)
                for (size_t a = first; a < end; a++)
                    if (has(s, type, c, a))
                        spec_put(&b, (uint16_t)s->symbol[type][(size_t)c * n + a], 2);
    }
    canonical(xxh3_128(b.data, b.size), hash);
    free(b.data);
}

static inline void spec_read_ends(spec_model *m, spec_reader *r)
{
    uint8_t hash[16];

    spec_integers_hash(&m->s, hash);
    if (r->end - r->pos < 16)
        fail(&m->v, "con.payload-size", r->pos);
    else if (memcmp(hash, r->file + r->pos, 16) != 0)
        fail(&m->v, "syn.hash", r->pos);
    r->pos += 16;
    spec_all_read(r);
}

/* R-CON-003, the part that belongs to pass 2 */
static inline int spec_in_order(const spec_model *m, int kind)
{
    switch (kind) {
    case 3: return m->n_bank > 0;
    case 4: return m->n_bank == 0 || m->bank_seen;
    case 5: return m->tiles_seen < m->n_tiles;
    case 6: return m->tiles_seen == m->n_tiles;
    default: return 1;
    }
}

static inline void spec_read_chunk(spec_model *m, spec_reader *r, uint64_t at, int kind,
                                   uint64_t file_bytes)
{
    if (!spec_in_order(m, kind)) {
        fail(&m->v, "con.chunk-order", at);
        return;
    }
    switch (kind) {
    case 0: spec_read_head(m, r, file_bytes); break;
    case 1: spec_read_nete(m, r); break;
    case 2: m->s.netr = spec_read_values(m, r, m->n_netr); break;
    case 3:
        m->s.bank = spec_read_values(m, r, m->n_bank);
        m->bank_seen = 1;
        break;
    case 4: spec_read_positions(m, r); break;
    case 5:
        decode_tile(&m->s, (uint32_t)m->tiles_seen, m->model, r->file + r->pos, r->end - r->pos,
                    r->pos, &m->v);
        if (m->v.id == NULL && m->tile_done != NULL)
            m->tile_done(m->user, (uint32_t)m->tiles_seen);
        m->tiles_seen++;
        break;
    case 6: spec_read_ends(m, r); break;
    }
}

/* m->v is the verdict. If m->v.id is NULL, the file is valid and m->s is filled. m: zeroed except
 * for tile_done and user; free it in any case. */
static inline void spec_model_decode(spec_model *m, const uint8_t *file, uint64_t size)
{
    uint64_t at = 12;

    m->v = pass_1(file, size);
    if (m->v.id == NULL)
        spec_set_level(m, file[11]);
    while (m->v.id == NULL && at < size) {
        const uint64_t n = load32(file + at + 8);
        spec_reader r = { file, at + 12, at + 12 + n, &m->v };

        spec_read_chunk(m, &r, at, kind_of(file + at), size);
        at += 20 + n;
    }
}

#endif
