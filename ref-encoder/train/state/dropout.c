/* dropout.c - see dropout.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "dropout.h"

#include <math.h>

#include "train/math/random.h"

/* Dropout is whole where at most FEW cameras see a time, and ends where MANY do. Measured on scenes
 * of the stability lab and on fair: with one to six cameras it gains up to 1.6 dB on held-out
 * pictures, with twelve it costs up to 0.3 dB. */
#define FEW  6.0
#define MANY 12.0

/* Anchors of a group. */
enum { GROUP = TED4_LANES / 2 };

/* Distinguishes the random numbers of this file from others of the same seed and step: "drop". */
#define DROPOUT_STREAM 0x64726f70u

double ted4_dropout_most(const ted4_trainer *t)
{
    return t->opt.dropout * fmin(fmax((MANY - t->order.cameras) / (MANY - FEW), 0.0), 1.0);
}

double ted4_dropout_share(const ted4_trainer *t)
{
    const double done = (double)ted4_stage_position(t) / fmax(1.0, (double)t->opt.stage1);

    return t->phase.stage2 ? 0.0 : ted4_dropout_most(t) * done;
}

/* The lanes of a block that are kept: bit j for anchor j. */
static uint32_t kept_lanes(uint64_t key, uint32_t block, double share)
{
    const uint32_t group = ((uint32_t)1 << GROUP) - 1;
    uint32_t kept = 0;

    for (uint32_t i = 0; i < TED4_LANES / GROUP; i++)
        if ((double)ted4_uniform(key, block * (uint64_t)(TED4_LANES / GROUP) + i) >= share)
            kept |= group << i * GROUP;
    return kept;
}

void ted4_dropout(ted4_trainer *t)
{
    ted4_visible_blocks *s = &t->visible_blocks;
    const double share = ted4_dropout_share(t);
    const uint64_t key = ted4_random(t->opt.seed ^ DROPOUT_STREAM, t->iteration);
    size_t n = 0;

    /* Buffers of gradients belong to places in the list, and values are used as they are stored:
     * there is no dropout in stage 2. */
    for (size_t i = 0; share > 0 && i < s->n; i++) {
        const uint32_t lanes = s->lanes[i] & kept_lanes(key, s->block[i], share);

        if (lanes == 0)
            continue;
        s->block[n] = s->block[i];
        s->lanes[n] = lanes;
        s->position[n] = s->position[i];
        s->raw[n] = s->raw[i];
        s->used[n] = s->raw[i];
        s->steps[n] = s->steps[i];
        n++;
    }
    if (share > 0)
        s->n = n;
}
