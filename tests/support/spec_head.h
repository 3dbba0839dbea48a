/* spec_head.h - the tables of 6.1 and 13.1, read out of the text (spec/head.inc and
 * spec/levels.inc, made by tests/spec/), as a judge of the elements of HEAD. Shares nothing with
 * the printed code of annex M, which it is held against, but the names of elements.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPEC_HEAD_H
#define TED4_SPEC_HEAD_H

#include "spec_model.h"

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

/* The row of 13.1; zeros when there is no such level. */
static inline void spec_bounds(int level, uint64_t bound[N_BOUNDS])
{
    memset(bound, 0, N_BOUNDS * sizeof *bound);
#define LEVEL(number, ...)                                          \
    if (level == (number)) {                                        \
        const uint64_t row[N_BOUNDS] = { UINT64_MAX, __VA_ARGS__ }; \
        memcpy(bound, row, sizeof row);                             \
    }
#include "spec/levels.inc"
#undef LEVEL
}

/* HEAD under way. */
typedef struct {
    const uint8_t *payload;
    uint64_t size, pos;
    struct header h;
    struct verdict v; /* offset: in the payload */
} spec_head;

static inline uint32_t spec_head_number(spec_head *r, uint64_t width)
{
    const uint8_t *p = r->payload + r->pos;

    if (r->size - r->pos < width)
        fail(&r->v, "con.payload-size", r->pos);
    if (r->v.id != NULL)
        return 0;
    r->pos += width;
    return width == 1 ? p[0] : width == 2 ? load16(p) : load32(p);
}

static inline int64_t spec_signed(uint32_t x, int width)
{
    return x >= (uint32_t)1 << (8 * width - 1) ? (int64_t)x - ((int64_t)1 << (8 * width))
                                               : (int64_t)x;
}

/* R-HDR-001 to R-HDR-003 for an element read at offset at. */
static inline void spec_head_rules(spec_head *r, uint64_t at, int64_t x, int64_t low, int64_t high,
                                   int conditional, int holds, uint64_t bound)
{
    const int64_t lowest = conditional && low > 0 ? 0 : low;

    if (x < lowest || x > high)
        fail(&r->v, "hdr.range", at);
    if (conditional && (holds ? x < low : x != 0))
        fail(&r->v, "hdr.combination", at);
    if (x > 0 && (uint64_t)x > bound)
        fail(&r->v, "lvl.exceeded", at);
}

/* r: payload and size set, the rest zero. Rules that no single element breaks are left out. */
static inline void spec_head_judge(spec_head *r, int level)
{
    struct header *h = &r->h;
    uint64_t bound[N_BOUNDS], at;
    int64_t sum = 0;

    spec_bounds(level, bound);
    bound[BOUND_NONE] = UINT64_MAX;
#define ELEMENT(name, count, width, is_signed, low, high, conditional, condition, level_bound) \
    for (int64_t i = 0; i < (count) && r->v.id == NULL; i++) {                                 \
        int64_t *x = &((int64_t *)&h->name)[i];                                                \
        at = r->pos;                                                                           \
        *x = spec_head_number(r, width);                                                       \
        if (is_signed)                                                                         \
            *x = spec_signed((uint32_t)*x, width);                                             \
        if (r->v.id == NULL)                                                                   \
            spec_head_rules(r, at, *x, low, high, conditional, condition,                      \
                            bound[BOUND_##level_bound]);                                       \
        sum += x == h->slice + i ? *x : 0;                                                     \
        if (x == h->slice + i && i == h->n_slices - 1 && sum != h->feature_dim)                \
            fail(&r->v, "hdr.combination", at);                                                \
    }
#define REAL(name, count, bounded)                                                         \
    for (int64_t i = 0; i < (count) && r->v.id == NULL; i++) {                             \
        at = r->pos;                                                                       \
        h->name[i] = spec_head_number(r, 4);                                               \
        if (!f32_legal(h->name[i]) || ((bounded) && !(from_bits(h->name[i]) >= 0x1p-20f && \
                                                      from_bits(h->name[i]) <= 0x1p10f)))  \
            fail(&r->v, "hdr.range", at);                                                  \
    }
#include "spec/head.inc"
#undef ELEMENT
#undef REAL
}

#endif
