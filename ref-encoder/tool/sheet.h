/* sheet.h - pictures that show quality: truth, ours, and their difference, apart or on one sheet.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SHEET_H
#define TED4_SHEET_H

#include <stddef.h>
#include <stdint.h>

#include "data/dataset.h"

enum { TED4_SHEET_COLUMNS = 3, TED4_ERROR_GAIN = 5 };

/* out = 5 |a - b|, at most 255; n bytes. */
void ted4_sheet_error(const uint8_t *a, const uint8_t *b, size_t n, uint8_t *out);

/* Rows of truth, ours, error in tiles of one size. */
typedef struct {
    int width, height, rows; /* of one picture; number of rows */
    uint8_t *rgb;            /* owned: [rows height][3 width][3], black at first */
} ted4_sheet;

/* Up to most pictures of a split that a sheet shows: of cameras spread over all of them, at times
 * spread over theirs; all of the size of the split's first. How many; 0: the split is empty. */
size_t ted4_sheet_choose(const ted4_dataset *d, int test, size_t most, size_t *item);

/* 0, or -1: no memory. */
int ted4_sheet_init(ted4_sheet *s, int width, int height, int rows);
void ted4_sheet_finish(ted4_sheet *s);
void ted4_sheet_put(ted4_sheet *s, int row, const uint8_t *truth, const uint8_t *ours);

#endif
