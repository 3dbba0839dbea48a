/* anchors.c - allocates, resizes, selects and sorts anchors (anchors.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "anchors.h"

#include <stdlib.h>
#include <string.h>

#include "norm/half.h"

static size_t row_floats(const ted4_anchors *a, int k)
{
    return (size_t)a->rows[k] * TED4_LANES;
}

/* The memory is not cleared here: a block is cleared when it comes into use, and most blocks never
 * do. */
static float *new_blocks(size_t floats)
{
    /* aligned_alloc requires a multiple of the alignment; a row of a block has 128 bytes. */
    return aligned_alloc(64, floats * sizeof(float));
}

int ted4_anchors_init(ted4_anchors *a, const ted4_layout *l)
{
    memset(a, 0, sizeof *a);
    a->rows[TED4_ROW_VALUE] = l->n_channels;
    a->rows[TED4_ROW_M] = l->n_channels;
    a->rows[TED4_ROW_V] = l->n_channels;
    a->rows[TED4_ROW_POSITION] = 3;
    a->rows[TED4_ROW_STEP] = TED4_TYPES;
    a->rows[TED4_ROW_OPACITY] = 3;
    a->rows[TED4_ROW_GRADIENT] = 2 * l->head.n_offsets;
    return ted4_anchors_resize(a, 0);
}

void ted4_anchors_finish(ted4_anchors *a)
{
    for (int k = 0; k < TED4_ROWS; k++)
        free(a->data[k]);
    memset(a, 0, sizeof *a);
}

static int reserve(ted4_anchors *a, size_t blocks)
{
    if (blocks <= a->capacity && a->data[0] != NULL)
        return 0;

    const size_t capacity = blocks + blocks / 2 + 8;

    for (int k = 0; k < TED4_ROWS; k++) {
        float *p = new_blocks(capacity * row_floats(a, k));

        if (p == NULL)
            return -1;
        if (a->data[k] != NULL)
            memcpy(p, a->data[k], a->n_blocks * row_floats(a, k) * sizeof *p);
        free(a->data[k]);
        a->data[k] = p;
    }
    a->capacity = capacity;
    return 0;
}

static void clear_anchor(ted4_anchors *a, size_t i)
{
    for (int k = 0; k < TED4_ROWS; k++)
        for (int r = 0; r < a->rows[k]; r++)
            *ted4_anchor_value(a, (ted4_row)k, i, r) = 0.0f;
}

int ted4_anchors_resize(ted4_anchors *a, size_t n)
{
    const size_t blocks = (n + TED4_LANES - 1) / TED4_LANES;

    if (reserve(a, blocks) != 0)
        return -1;
    for (int k = 0; k < TED4_ROWS; k++)
        if (blocks > a->n_blocks)
            memset(ted4_block(a, (ted4_row)k, a->n_blocks), 0,
                   (blocks - a->n_blocks) * row_floats(a, k) * sizeof(float));
    a->n_blocks = blocks;
    for (size_t i = n; i < a->n && i < blocks * TED4_LANES; i++)
        clear_anchor(a, i);
    a->n = n;
    return 0;
}

int ted4_anchors_select(ted4_anchors *a, const uint32_t *order, size_t n)
{
    const size_t blocks = (n + TED4_LANES - 1) / TED4_LANES;

    for (int k = 0; k < TED4_ROWS; k++) {
        float *p = new_blocks(a->capacity * row_floats(a, k));

        if (p == NULL)
            return -1;
        if (blocks > 0)
            memset(p + (blocks - 1) * row_floats(a, k), 0, row_floats(a, k) * sizeof *p);
        for (size_t i = 0; i < n; i++) {
            const float *from = ted4_anchor_value(a, (ted4_row)k, order[i], 0);
            float *to = p + i / TED4_LANES * row_floats(a, k) + i % TED4_LANES;

            for (int r = 0; r < a->rows[k]; r++)
                to[(size_t)r * TED4_LANES] = from[(size_t)r * TED4_LANES];
        }
        free(a->data[k]);
        a->data[k] = p;
    }
    a->n = n;
    a->n_blocks = blocks;
    return 0;
}

typedef struct {
    uint64_t code;
    uint32_t index;
} keyed;

static int compare_keyed(const void *x, const void *y)
{
    const keyed *a = x, *b = y;

    if (a->code != b->code)
        return a->code < b->code ? -1 : 1;
    return a->index < b->index ? -1 : a->index > b->index;
}

uint64_t ted4_anchor_morton(const ted4_anchors *a, size_t i)
{
    uint16_t p[3];

    for (int j = 0; j < 3; j++)
        p[j] = ted4_float_to_half(*ted4_anchor_value(a, TED4_ROW_POSITION, i, j));
    return ted4_morton(p);
}

int ted4_anchors_sort(ted4_anchors *a, const uint16_t *group)
{
    keyed *key = malloc((a->n + 1) * sizeof *key);
    uint32_t *order = malloc((a->n + 1) * sizeof *order);
    int bad = key == NULL || order == NULL;

    for (size_t i = 0; !bad && i < a->n; i++)
        key[i] =
            (keyed) { (uint64_t)(group == NULL ? 0 : group[i]) << 48 | ted4_anchor_morton(a, i),
                      (uint32_t)i };
    if (!bad) {
        qsort(key, a->n, sizeof *key, compare_keyed);
        for (size_t i = 0; i < a->n; i++)
            order[i] = key[i].index;
        bad = ted4_anchors_select(a, order, a->n) != 0;
    }
    free(key);
    free(order);
    return bad ? -1 : 0;
}
