/* schedule.h - learning rates over time. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCHEDULE_H
#define TED4_SCHEDULE_H

#include "train/state/trainer.h"

/* Rate of each channel of anchors at the next step: channel_rate[n_channels]; 0: it stands still.
 */
void ted4_schedule_rates(const ted4_trainer *t, float *channel_rate);

/* The stretches of the network array that are learnt, and their rates: how many; at most
 * TED4_NET_RANGES. */
typedef struct {
    size_t first, n;
    float rate; /* 0: it stands still */
} ted4_net_range;
enum { TED4_NET_RANGES = TED4_NETS_R + 2 };
int ted4_schedule_network(const ted4_trainer *t, ted4_net_range *range);

/* The step from which activation is learnt: the end of the static phase, if there is one. */
uint64_t ted4_activation_step(const ted4_train_options *o);

#endif
