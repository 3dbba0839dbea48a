/* snap.h - float weights of Tier E onto the integer grid; positions into file order.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SNAP_H
#define TED4_SNAP_H

#include "norm/half.h"
#include "norm/syntax.h"

/* Chooses for every output unit the finest shift with which R-NET-003 to R-NET-006 hold, and moves
 * its weights and bias to the values that this shift represents exactly. Values that not even the
 * coarsest shift can hold are pulled in until it does; one that is not finite becomes 0.
 * ted4_prior_load accepts the result. nete: [n_nete], shift: [n_units]. */
void ted4_snap(const ted4_header *h, const ted4_shape *s, float *nete, uint8_t *shift);
/* The same with no shift above finest (0 .. 20), as far as the rules allow: coarser weights, which
 * deflate better. */
void ted4_snap_coarse(const ted4_header *h, const ted4_shape *s, int finest, float *nete,
                      uint8_t *shift);

/* order[i]: which of n anchors comes i-th in a file. position: [n][3] binary16 patterns. Of equal
 * anchors all but the first are left out. Gives how many remain, or SIZE_MAX: no memory. */
size_t ted4_positions_sort(const uint16_t *position, size_t n, uint32_t *order);

#endif
