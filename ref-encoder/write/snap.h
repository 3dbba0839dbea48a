/* snap.h - snaps the float weights of Tier E to the integer grid, and sorts positions into file
 * order.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SNAP_H
#define TED4_SNAP_H

#include "norm/half.h"
#include "norm/syntax.h"

/* Chooses, for every output unit, the finest shift with which R-NET-003 to R-NET-006 hold, and
 * rounds its weights and bias to values that this shift represents exactly. Values that are too
 * large even for the coarsest shift are reduced until they fit; a value that is not finite becomes
 * 0. ted4_prior_load accepts the result. nete: [n_nete], shift: [n_units]. */
void ted4_snap(const ted4_header *h, const ted4_shape *s, float *nete, uint8_t *shift);
/* Like ted4_snap, but uses no shift above finest (0 .. 20), as far as the rules allow. Coarser
 * weights deflate better. */
void ted4_snap_coarse(const ted4_header *h, const ted4_shape *s, int finest, float *nete,
                      uint8_t *shift);

/* Sets order[i] to the index of the anchor that comes i-th in a file. position: [n][3] binary16
 * patterns of n anchors. Of anchors at equal positions, all but the first are left out. Returns the
 * number of anchors that remain, or SIZE_MAX if there is no memory. */
size_t ted4_positions_sort(const uint16_t *position, size_t n, uint32_t *order);

#endif
