/* resize_nets.h - the networks' part of resize.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RESIZE_NETS_H
#define TED4_RESIZE_NETS_H

#include "resize.h"

/* Parameters, then both moments of Adam, each [n_net]. */
enum { TED4_RESIZE_ARRAYS = 3 };

typedef struct {
    const ted4_resize *resize;
    const ted4_layout *from, *to;
    const float *context; /* [feature_dim before]: mean context of each feature, spec 10.3 */
    const float *old[TED4_RESIZE_ARRAYS];
    float *new[TED4_RESIZE_ARRAYS];
} ted4_resize_nets;

/* Fills new, which is zero. 0, or -1: no memory. */
int ted4_resize_networks(const ted4_resize_nets *n);

#endif
