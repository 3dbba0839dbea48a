/* resize_nets.h - the part of resize.h that adapts the networks.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RESIZE_NETS_H
#define TED4_RESIZE_NETS_H

#include "resize.h"

/* The arrays to resize: parameters, then both moments of Adam, each [n_net]. */
enum { TED4_RESIZE_ARRAYS = 3 };

typedef struct {
    const ted4_resize *resize;
    const ted4_layout *from, *to;
    const float *context; /* [old feature_dim] mean context of each feature, spec 10.3 */
    const float *old[TED4_RESIZE_ARRAYS];
    float *new[TED4_RESIZE_ARRAYS];
} ted4_resize_nets;

/* Fills new, which must be zero. Returns 0, or -1 if memory ran out. */
int ted4_resize_networks(const ted4_resize_nets *n);

#endif
