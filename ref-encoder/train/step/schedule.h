/* schedule.h - learning rates over time. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCHEDULE_H
#define TED4_SCHEDULE_H

#include "train/state/trainer.h"

/* Computes the learning rate of each channel of anchors at the next step, channel_rate[n_channels];
 * 0 if the channel is not trained. */
void ted4_schedule_rates(const ted4_trainer *t, float *channel_rate);

/* A range of the network array, and its learning rate. */
typedef struct {
    size_t first, n;
    float rate; /* 0: not trained */
} ted4_net_range;
enum { TED4_NET_RANGES = TED4_NETS_R + 2 };
/* Fills range with the ranges at the next step, and returns their number, at most TED4_NET_RANGES.
 */
int ted4_schedule_network(const ted4_trainer *t, ted4_net_range *range);

/* Returns the step from which on activation is learnt: the end of the static phase, if there is
 * one.
 */
uint64_t ted4_activation_step(const ted4_train_options *o);

#endif
