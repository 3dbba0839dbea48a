/* anchors.h - the trained anchors: values, optimiser moments and densification statistics in blocks
 * of 32. Depends on model.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANCHORS_H
#define TED4_ANCHORS_H

#include <stddef.h>
#include <stdint.h>

#include "model.h"

/* Arrays are [n_blocks][rows][32]; unused lanes of the last block are zero. The kinds of rows: */
typedef enum {
    TED4_ROW_VALUE, /* n_channels: the parameters (model.h) */
    TED4_ROW_M,
    TED4_ROW_V,        /* n_channels: Adam's moments */
    TED4_ROW_POSITION, /* 3, normalised space */
    TED4_ROW_STEP,     /* TED4_TYPES: the most recent step sizes (stage 2) */
    TED4_ROW_OPACITY,  /* 3: summed opacity after activation, visits, and visits with an activation
                          of at least a half */
    TED4_ROW_GRADIENT, /* 2K: per offset, summed screen-space gradient, then per offset, its count
                        */
    TED4_ROWS
} ted4_row;

typedef struct {
    size_t n;                  /* anchors */
    size_t n_blocks, capacity; /* blocks */
    int rows[TED4_ROWS];
    float *data[TED4_ROWS]; /* owned, 64-byte aligned */
} ted4_anchors;

/* Returns 0, or -1 if memory ran out. */
int ted4_anchors_init(ted4_anchors *a, const ted4_layout *l);
void ted4_anchors_finish(ted4_anchors *a);
/* Makes room for n anchors; new ones are zero. Returns 0, or -1 if memory ran out. */
int ted4_anchors_resize(ted4_anchors *a, size_t n);
/* Keeps the anchors order[0 .. n), in that order; indices must not repeat. Returns 0, or -1 if
 * memory ran out. */
int ted4_anchors_select(ted4_anchors *a, const uint32_t *order, size_t n);
/* Sorts by the numbers of groups, group[n] (NULL: all anchors are one group), within a group by the
 * Morton code of spec 8 (of positions rounded to binary16); ties by index. Returns 0, or -1 if
 * memory ran out. */
int ted4_anchors_sort(ted4_anchors *a, const uint16_t *group);
/* The Morton code of anchor i: 48 bits. */
uint64_t ted4_anchor_morton(const ted4_anchors *a, size_t i);

static inline float *ted4_block(const ted4_anchors *a, ted4_row k, size_t block)
{
    return a->data[k] + block * (size_t)a->rows[k] * TED4_LANES;
}

/* The value of row r of anchor i. */
static inline float *ted4_anchor_value(const ted4_anchors *a, ted4_row k, size_t i, int r)
{
    return ted4_block(a, k, i / TED4_LANES) + (size_t)r * TED4_LANES + i % TED4_LANES;
}

/* Returns a mask of the lanes of a block that hold anchors. */
static inline uint32_t ted4_block_lanes(const ted4_anchors *a, size_t block)
{
    const size_t left = a->n - block * TED4_LANES;

    return left >= TED4_LANES ? 0xffffffffu : ((uint32_t)1 << left) - 1;
}

#endif
