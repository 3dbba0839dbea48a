/* compact.h - declarations shared by compact.c, which prints bench/compact.md's tables, and the
 * files that measure one means of a smaller file each. All rates are in bits over the whole file.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COMPACT_H
#define TED4_COMPACT_H

#include "norm/syntax.h"

/* Ends the program with a line if there is no memory; otherwise returns n zeroed elements. */
void *compact_need(size_t n, size_t size);

/* ---- compact_models.c: the integer models of all symbols (spec 10) ---- */

typedef struct {
    const ted4_scene *s;        /* borrowed */
    size_t n;                   /* anchors */
    int32_t *mu[TED4_TYPES];    /* each [dim][n], Q8; owned, as all below */
    uint8_t *sigma[TED4_TYPES]; /* each [dim][n] indices */
} compact_models;

void compact_models_make(compact_models *m, const ted4_scene *s);
void compact_models_free(compact_models *m);
/* Whether anchor a has component comp of a type. */
int compact_coded(const ted4_scene *s, int type, unsigned comp, size_t a);
/* The real numbers behind an index and a mean: sigma and mu in steps, and the step itself. */
double compact_sigma(unsigned index);
double compact_step(const ted4_scene *s, int type, size_t a);
/* -log2 of a probability, at least 2^-16: no symbol of the coder has less. */
double compact_bits(double probability);
/* Probability of symbol k under a Gaussian with mean mu and deviation sigma, in steps. */
double compact_mass(double k, double mu, double sigma);

/* ---- compact_near.c: anchors whose symbols are decoded earlier ---- */

enum { COMPACT_NEAR = 3, COMPACT_NONE = -1 };

/* Coarse to fine: of every four anchors of a tile, in order of the file, the first is of level 0,
 * the third of level 1, the others of level 2. Anchors of one level do not depend on each other, so
 * a level is decoded in parallel, as a tile is today. near: [n][COMPACT_NEAR], the nearest anchors
 * of lower levels in the same tile, COMPACT_NONE behind the last. The caller frees it. */
int32_t *compact_near_levels(const ted4_scene *s);
/* The same where all anchors before it in its tile are known: one anchor after the other. */
int32_t *compact_near_before(const ted4_scene *s);
/* Where anchor a of a type's component has any of its near ones: returns their number, and the mean
 * of what their models missed, and the mean of its magnitude, in steps of a. */
unsigned compact_missed(const compact_models *m, const int32_t *near, int type, unsigned comp,
                        size_t a, double *mean, double *magnitude);

/* ---- the means ---- */

/* compact_positions.c: bits of positions as an octree of cells, by the adaptive coder. depth: 16
 * for the order-preserving images of the coordinates (spec 8), which lose nothing; otherwise
 * 2^depth cells on each axis of [-1, 1]. shared: anchors that share a cell with another, which are
 * left out. */
double compact_octree(const ted4_scene *s, unsigned depth, size_t *shared);
/* Moves the positions of s to the nearest corner of such a grid, 6 <= depth <= 12: each of its
 * coordinates is an exact binary16. */
void compact_move_to_grid(ted4_scene *s, unsigned depth);

/* compact_fit.c: bits of a type today, and with neighbours as further inputs of the networks: mean
 * and deviation get what the best weights for each component can give them. blind: the same fit
 * without neighbours. */
typedef struct {
    double today, blind, near_levels, near_before;
} compact_fitted;

void compact_fit(const compact_models *m, int type, const int32_t *levels, const int32_t *before,
                 compact_fitted *f);

/* compact_mixing.c: bits of a type with the integer model's probabilities mixed with adaptive ones,
 * whose contexts are component and deviation, and with neighbours also what they missed. masks:
 * bits of dynamic and offset bits, today's contexts with adaptive probabilities, and mixed with
 * contexts of neighbours. */
double compact_mixed(const compact_models *m, int type, const int32_t *near);
void compact_masks(const ted4_scene *s, const int32_t *near, double *adaptive, double *mixed);

/* compact_weights.c: bits of NETE, NETR and BANK as integers on the grids of their units, with
 * adaptive probabilities; and of a blob's values as spec 7.2 deflates them. */
double compact_nete(const ted4_scene *s);
double compact_netr(const ted4_scene *s);
double compact_bank(const ted4_scene *s);
double compact_deflated(const ted4_blob *b);

#endif
