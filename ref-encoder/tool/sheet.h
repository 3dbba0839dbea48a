/* sheet.h - pictures for visual comparison: ground truth, rendered picture, and their difference,
 * as separate pictures or on one sheet.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SHEET_H
#define TED4_SHEET_H

#include <stddef.h>
#include <stdint.h>

#include "data/dataset.h"

enum { TED4_SHEET_COLUMNS = 3, TED4_ERROR_GAIN = 5 };

/* Computes out = min(5 |a - b|, 255) for n bytes. */
void ted4_sheet_error(const uint8_t *a, const uint8_t *b, size_t n, uint8_t *out);

/* A sheet. Each row shows truth, rendered picture and error; all pictures have the same size. */
typedef struct {
    int width, height, rows; /* size of one picture; number of rows */
    uint8_t *rgb;            /* owned: [rows height][3 width][3], black at first */
} ted4_sheet;

/* Chooses up to most pictures of a split for a sheet: evenly spread over the cameras, and over the
 * frames of each camera. All have the size of the first picture of the split. test: 1 for the test
 * split, 0 for training. Writes indices of d->pictures to item, [most]. Returns their number; 0:
 * the split is empty. */
size_t ted4_sheet_choose(const ted4_dataset *d, int test, size_t most, size_t *item);

/* Returns 0, or -1 if out of memory. */
int ted4_sheet_init(ted4_sheet *s, int width, int height, int rows);
void ted4_sheet_finish(ted4_sheet *s);
/* Fills a row. truth, ours: [height][width][3]. */
void ted4_sheet_put(ted4_sheet *s, int row, const uint8_t *truth, const uint8_t *ours);

#endif
