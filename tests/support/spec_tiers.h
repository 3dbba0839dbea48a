/* spec_tiers.h - the byte strings of annex J, made by what the specification prints (spec_model.h):
 * T0 from a valid file, T1 to T4 from what was decoded, T5 from queries. Element numbers come from
 * the table of J.2.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPEC_TIERS_H
#define TED4_SPEC_TIERS_H

#include "spec_model.h"

enum {
#define ID(name, number) ID_##name = number,
#include "spec/elements.inc"
#undef ID
    N_TIERS = 5
};

/* A byte string that grows. */
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

/* T0 to T4 of one file. */
typedef struct {
    spec_model model;
    spec_bytes tier[N_TIERS];
} spec_tiers;

static inline uint32_t spec_load(const uint8_t *p, int width)
{
    return width == 1 ? p[0] : width == 2 ? load16(p) : load32(p);
}

/* The next n numbers of a file, each a record. */
static inline const uint8_t *spec_t0_numbers(spec_bytes *b, int id, const uint8_t *p, int width,
                                             size_t n)
{
    for (size_t i = 0; i < n; i++, p += width) {
        spec_put(b, (uint64_t)id, 2);
        spec_put(b, spec_load(p, width), 4);
    }
    return p;
}

static inline const uint8_t *spec_t0_bytes(spec_bytes *b, int id, const uint8_t *p, size_t n)
{
    spec_put(b, (uint64_t)id, 2);
    spec_put(b, n, 4);
    for (size_t i = 0; i < n; i++)
        spec_put(b, p[i], 1);
    return p + n;
}

static inline void spec_t0_head(spec_bytes *b, const struct header *h, const uint8_t *p)
{
#define ELEMENT(name, count, width, is_signed, low, high, conditional, condition, level) \
    p = spec_t0_numbers(b, ID_##name, p, width, (size_t)(count));
#define REAL(name, count, bounded) p = spec_t0_numbers(b, ID_##name, p, 4, (size_t)(count));
#include "spec/head.inc"
#undef ELEMENT
#undef REAL
    (void)p;
}

/* units: how many exponents come before the substream of mode 2 (7.6) */
static inline void spec_t0_blob(spec_bytes *b, int id, const uint8_t *p, size_t n, size_t left,
                                size_t units)
{
    const int mode = p[0];

    p = spec_t0_numbers(b, ID_mode, p, 1, 1);
    if (mode == 0)
        spec_t0_numbers(b, id, p, 4, n);
    else if (mode == 1)
        spec_t0_bytes(b, id + 1, p, left - 1); /* nete_deflated follows nete, and so on: J.2 */
    else {
        p = spec_t0_numbers(b, ID_unit_exponent, p, 1, units);
        spec_t0_bytes(b, ID_weights_substream, p, left - 1 - units);
    }
}

static inline size_t spec_units_r(const spec_model *m)
{
    size_t n = 0;

    for (int i = 0; i < NETS_R; i++)
        for (int j = 0; j < m->p.net_r[i].n_layers; j++)
            n += (size_t)m->p.net_r[i].dim[j + 1] + 1;
    return n;
}

/* 8.1, 8.2 */
static inline void spec_t0_positions(spec_bytes *b, const spec_model *m, const uint8_t *p, size_t n)
{
    if (m->p.file[10] == 0) {
        spec_t0_numbers(b, ID_position, p, 2, 3 * (size_t)m->p.s.h.n_anchors);
    } else {
        p = spec_t0_numbers(b, ID_grid, p, 1, 1);
        spec_t0_bytes(b, ID_tree_substream, p, n - 1);
    }
}

static inline int spec_n_substreams(const struct header *h)
{
    int n = (h->temporal_mask || h->offset_mask) + (int)h->n_slices;

    for (int type = SCALING; type < TYPES; type++)
        n += type_dim(h, type) > 0;
    return n;
}

static inline void spec_t0_tile(spec_bytes *b, const struct header *h, const uint8_t *p)
{
    static const int id[TYPES] = { ID_feature_substream, ID_scaling_substream, ID_offset_substream,
                                   ID_phi_substream, ID_tau_substream };
    const int n = spec_n_substreams(h);
    const uint8_t *size;

    p = spec_t0_numbers(b, ID_tile_index, p, 4, 1);
    p = spec_t0_numbers(b, ID_dynamic_prob, p, 2, h->temporal_mask ? 1 : 0);
    p = spec_t0_numbers(b, ID_offset_prob, p, 2, h->offset_mask ? 6 : 0);
    size = p;
    p = spec_t0_numbers(b, ID_size, p, 4, (size_t)n);
    if (h->temporal_mask || h->offset_mask) {
        p = spec_t0_bytes(b, ID_mask_substream, p, load32(size));
        size += 4;
    }
    for (int type = 0; type < TYPES; type++)
        for (int i = 0; type_dim(h, type) > 0 && i < (type == FEATURE ? h->n_slices : 1);
             i++, size += 4)
            p = spec_t0_bytes(b, id[type], p, load32(size));
}

static inline void spec_t0_payload(spec_bytes *b, const spec_model *m, int kind, const uint8_t *p,
                                   size_t n)
{
    switch (kind) {
    case 0: spec_t0_head(b, &m->p.s.h, p); break;
    case 1:
        spec_t0_numbers(b, ID_shift, p, 1, m->p.n_units);
        spec_t0_blob(b, ID_nete, p + m->p.n_units, m->p.n_nete, n - m->p.n_units, 0);
        break;
    case 2: spec_t0_blob(b, ID_netr, p, m->p.n_netr, n, spec_units_r(m)); break;
    case 3: spec_t0_blob(b, ID_bank, p, m->p.n_bank, n, 1); break;
    case 4: spec_t0_positions(b, m, p, n); break;
    case 5: spec_t0_tile(b, &m->p.s.h, p); break;
    case 6: spec_t0_bytes(b, ID_ends_hash, p, n); break;
    default: spec_t0_bytes(b, ID_ancillary, p, n); break;
    }
}

/* J.2, of a file that m found valid */
static inline void spec_t0(spec_bytes *b, const spec_model *m, const uint8_t *file, size_t size)
{
    size_t at = 12;

    spec_t0_bytes(b, ID_magic, file, 8);
    for (int i = 0; i < 4; i++)
        spec_t0_numbers(b, ID_major + i, file + 8 + i, 1, 1);
    while (at < size) {
        const size_t n = load32(file + at + 8);

        spec_t0_numbers(b, ID_chunk_type, file + at, 4, 1);
        spec_t0_numbers(b, ID_chunk_flags, file + at + 4, 4, 1);
        spec_t0_numbers(b, ID_chunk_size, file + at + 8, 4, 1);
        spec_t0_payload(b, m, kind_of(file + at), file + at + 12, n);
        spec_t0_bytes(b, ID_chunk_hash, file + at + 12 + n, 8);
        at += 20 + n;
    }
}

/* J.3 */
static inline void spec_t1(spec_bytes *b, const struct scene *s)
{
    for (size_t i = 0; i < 3 * (size_t)s->h.n_anchors; i++)
        spec_put(b, (uint32_t)q24(s->position[i]), 4);
    for (size_t i = 0; i < (size_t)s->h.n_anchors; i++) {
        spec_put(b, s->dynamic[i], 1);
        spec_put(b, s->offset_bits[i], 2);
    }
}

/* mu of a component of an anchor of the tile decoded last; s follows dim later. */
static inline const int32_t *spec_mu(const spec_model *m, int type, int comp, size_t i)
{
    return m->p.model + i * (size_t)n_outputs(&m->p.s.h) + first_output(&m->p.s.h, type) + comp;
}

static inline int16_t spec_k(const struct scene *s, int type, int comp, size_t anchor)
{
    return s->symbol[type][(size_t)comp * (size_t)s->h.n_anchors + anchor];
}

/* J.5, one substream: components comp .. comp + n_comps - 1 */
static inline void spec_t3_substream(spec_bytes *b, const struct scene *s, int type, int comp,
                                     int n_comps, size_t first, size_t end)
{
    uint32_t n = 0;

    for (int c = comp; c < comp + n_comps; c++)
        for (size_t a = first; a < end; a++)
            n += (uint32_t)has(s, type, c, a);
    spec_put(b, n, 4);
    for (int c = comp; c < comp + n_comps; c++)
        for (size_t a = first; a < end; a++)
            if (has(s, type, c, a))
                spec_put(b, (uint16_t)spec_k(s, type, c, a), 2);
    spec_put(b, n > 0 ? lanes_of(n) : 0, 4);
    for (unsigned i = 0; n > 0 && i < lanes_of(n); i++)
        spec_put(b, 65536, 4);
}

static inline void spec_t3_masks(spec_bytes *b, const struct scene *s, size_t first, size_t end)
{
    const int t = (int)s->h.temporal_mask, o = (int)s->h.offset_mask;
    const uint32_t n = (uint32_t)(end - first) * (uint32_t)(t + (o ? s->h.n_offsets : 0));

    if (n == 0)
        return;
    spec_put(b, n, 4);
    for (size_t a = first; a < end; a++) {
        if (t)
            spec_put(b, s->dynamic[a], 1);
        for (int k = 0; o && k < s->h.n_offsets; k++)
            spec_put(b, s->offset_bits[a] >> k & 1, 1);
    }
    spec_put(b, lanes_of(n), 4);
    for (unsigned i = 0; i < lanes_of(n); i++)
        spec_put(b, 65536, 4);
}

/* J.4 to J.6 of a tile, while its model is there */
static inline void spec_tile_done(void *user, uint32_t number)
{
    spec_tiers *t = user;
    const spec_model *m = &t->model;
    const struct scene *s = &m->p.s;
    const size_t first = (size_t)number * (size_t)s->h.tile_size, end = spec_tile_end(&s->h, first);
    int comp = 0;

    for (int type = 0; type < TYPES; type++)
        for (size_t a = first; type_dim(&s->h, type) > 0 && a < end; a++)
            spec_put(&t->tier[2], s->step_index[type][a], 1);
    for (int type = 0; type < TYPES; type++)
        for (int c = 0; c < type_dim(&s->h, type); c++)
            for (size_t a = first; a < end; a++)
                if (has(s, type, c, a)) {
                    const int32_t *mu = spec_mu(m, type, c, a - first);
                    const float x = value_of(s, type, c, a);
                    uint32_t pattern;

                    memcpy(&pattern, &x, 4);
                    spec_put(&t->tier[2], (uint64_t)sigma_index(mu[type_dim(&s->h, type)]), 1);
                    spec_put(&t->tier[2], (uint32_t)mu[0], 4);
                    spec_put(&t->tier[4], (uint16_t)spec_k(s, type, c, a), 2);
                    spec_put(&t->tier[4], pattern, 4);
                }
    spec_t3_masks(&t->tier[3], s, first, end);
    for (int i = 0; i < s->h.n_slices; comp += (int)s->h.slice[i++])
        spec_t3_substream(&t->tier[3], s, FEATURE, comp, (int)s->h.slice[i], first, end);
    for (int type = SCALING; type < TYPES; type++)
        if (type_dim(&s->h, type) > 0)
            spec_t3_substream(&t->tier[3], s, type, 0, type_dim(&s->h, type), first, end);
}

/* J.7 */
static inline void spec_t5(spec_bytes *b, const spec_model *m, uint32_t num, uint32_t den,
                           const float *camera)
{
    float record[16][14];

    for (size_t a = 0; a < (size_t)m->p.s.h.n_anchors; a++) {
        const int n = anchor_records(&m->p.s, m->p.net_r, a, num, den, camera, record);

        for (int i = 0; i < 14 * n; i++) {
            uint32_t pattern;

            memcpy(&pattern, &record[0][0] + i, 4);
            spec_put(b, pattern, 4);
        }
    }
}

/* t: zeroed. t->model.p.v says whether there are tiers. */
static inline void spec_tiers_make(spec_tiers *t, const uint8_t *file, size_t size)
{
    t->model.tile_done = spec_tile_done;
    t->model.user = t;
    spec_model_decode(&t->model, file, size);
    if (t->model.p.v.id != NULL)
        return;
    spec_t0(&t->tier[0], &t->model, file, size);
    spec_t1(&t->tier[1], &t->model.p.s);
}

static inline void spec_tiers_free(spec_tiers *t)
{
    for (int i = 0; i < N_TIERS; i++)
        free(t->tier[i].data);
    spec_model_free(&t->model);
}

#endif
