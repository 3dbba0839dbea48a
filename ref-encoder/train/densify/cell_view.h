/* cell_view.h - a training picture in cells, squares of a few pixels: colour, error and rendered
 * depth of each, for single-view seeding (sv_seed.h). Depends on error_view.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CELL_VIEW_H
#define TED4_CELL_VIEW_H

#include "error_view.h"

typedef struct {
    ted4_view view;
    int step, columns, rows; /* edge of a cell in pixels; cells */
    float nearest;           /* depth before which nothing is expected, normalised space */
    uint8_t *rgb, *error;    /* owned: [rows][columns][3]; [rows][columns], mean of the pixels */
    float *depth; /* owned: [rows][columns], rendered at the middle of each cell, normalised space,
                     more than 0; NULL if it is not wanted */
} ted4_cell_view;

/* Loads training picture item and renders the model's view of it, and again for the depths if they
 * are wanted. Returns 0, or -1 with t->message filled; close it in either case. *v must be zero. */
int ted4_cell_view_open(ted4_trainer *t, size_t item, int with_depth, ted4_cell_view *v);
void ted4_cell_view_close(ted4_cell_view *v);

/* Finds the cell at which the picture sees p, normalised space. Returns 0 if it does not, else 1.
 */
int ted4_cell_of(const ted4_cell_view *v, const float p[3], int *column, int *row);
/* Computes the point p at depth z on the ray through the middle of a cell. */
void ted4_cell_point(const ted4_cell_view *v, int column, int row, float z, float p[3]);

#endif
