/* anchor_checks.h - the invariants of a trainer's anchors, which hold after every change of them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANCHOR_CHECKS_H
#define TED4_ANCHOR_CHECKS_H

#include "norm/half.h"
#include "test.h"
#include "train/model/anchors.h"

/* Sizes agree, rows are aligned, and unused lanes are zero. */
static inline void anchors_check(const ted4_anchors *a)
{
    assert_int_equal(a->n_blocks, (a->n + TED4_LANES - 1) / TED4_LANES);
    assert_true(a->n_blocks <= a->capacity);
    for (int k = 0; k < TED4_ROWS; k++) {
        assert_int_equal((uintptr_t)a->data[k] % 64, 0);
        for (size_t i = a->n; i < a->n_blocks * TED4_LANES; i++)
            for (int r = 0; r < a->rows[k]; r++)
                assert_true(*ted4_anchor_value(a, (ted4_row)k, i, r) == 0.0f);
    }
    for (size_t b = 0; b < a->n_blocks; b++) {
        uint32_t want = 0;

        for (size_t j = 0; j < TED4_LANES; j++)
            want |= (uint32_t)(b * TED4_LANES + j < a->n) << j;
        assert_int_equal(ted4_block_lanes(a, b), want);
    }
}

/* The Morton code of anchor i's position. Files sort anchors by it (spec 8). */
static inline uint64_t anchors_morton(const ted4_anchors *a, size_t i)
{
    uint16_t p[3];

    for (int j = 0; j < 3; j++)
        p[j] = ted4_float_to_half(*ted4_anchor_value(a, TED4_ROW_POSITION, i, j));
    return ted4_morton(p);
}

#endif
