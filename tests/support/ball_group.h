/* ball_group.h - a group of tests that share the moving scene of balls: the scene, set-up and
 * tear-down. The scene has BALL_FRAMES frames, five by default; some tests set it up differently.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BALL_GROUP_H
#define TED4_BALL_GROUP_H

#include "ball_trainer.h"

#ifndef BALL_FRAMES
#define BALL_FRAMES 5
#endif
enum { FRAMES = BALL_FRAMES };

static tiny_folder folder;
static ted4_dataset balls;

static inline int set_up(void **state)
{
    (void)state;
    ball_load(&folder, &balls, FRAMES, 1);
    return 0;
}

static inline int tear_down(void **state)
{
    (void)state;
    ted4_dataset_free(&balls);
    tiny_free(&folder);
    return 0;
}

#endif
