/* view_sums.h - sums over the views of a step, in a fixed order: a binary tree over the views,
 * whose inner nodes cover views 2^k i to 2^k (i + 1). So a process that has such a range of the
 * views can compute its node alone, and the sum does not depend on who computed what. Depends on
 * base/parallel.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_SUMS_H
#define TED4_VIEW_SUMS_H

#include <stddef.h>

#include "base/parallel.h"

enum {
    TED4_MAX_VIEWS = 16, /* in a step */
    TED4_VIEW_LEVELS = 5 /* nodes that wait for their neighbour, and the newest view */
};

/* Nodes of the tree whose parent is not complete yet, from left to right, each half as large as the
 * one before or smaller. */
typedef struct {
    float *node[TED4_VIEW_LEVELS]; /* owned, [capacity] */
    size_t size, capacity;         /* floats of a node */
    size_t n_views;                /* added so far */
    float *received; /* owned, [received_capacity]: of view_exchange.h; NULL: nothing yet */
    size_t received_capacity;
} ted4_view_sums;

/* Begins a sum of arrays of size floats over n views, 1 to TED4_MAX_VIEWS. Returns 0, or -1 if
 * memory ran out. */
int ted4_view_sums_begin(ted4_view_sums *s, size_t size, size_t n);
/* Returns the array [size] of the next view, to be filled before ted4_view_sums_add. */
float *ted4_view_sums_next(ted4_view_sums *s);
void ted4_view_sums_add(ted4_view_sums *s, const ted4_parallel *p);
/* Ends the sum. Returns it, valid until the next one begins; without any view, an array of
 * unknown values. */
float *ted4_view_sums_total(ted4_view_sums *s, const ted4_parallel *p);
/* Adds node[n][size], the nodes of neighbouring ranges of 2^k views each, of which the last may
 * have fewer, as in the tree of all these views. node[0] receives the sum; the others change. */
void ted4_view_sums_join(float *node, size_t size, size_t n, const ted4_parallel *p);
/* Multiplies x[n]. */
void ted4_view_sums_scale(float *x, size_t n, float factor, const ted4_parallel *p);
void ted4_view_sums_finish(ted4_view_sums *s);

#endif
