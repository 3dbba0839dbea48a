/* cloud_case.h - a dataset in memory with points and one camera, without pictures on disc, and a
 * small trainer on it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CLOUD_CASE_H
#define TED4_CLOUD_CASE_H

#include <math.h>
#include <string.h>

#include "test.h"
#include "train/math/random.h"
#include "train/state/trainer.h"
#include "train/step/trainer_init.h"

enum { CLOUD_SIDE = 6, CLOUD_POINTS = CLOUD_SIDE * CLOUD_SIDE * CLOUD_SIDE };

/* Distance between neighbours on the lattice, in world units. */
#define CLOUD_STEP 0.5

typedef struct {
    ted4_dataset data;
    ted4_picture picture;
    float point[CLOUD_POINTS][3];
    ted4_train_options options;
} cloud_case;

/* Fills a lattice around (10, -4, 2), in scrambled order. */
static inline void cloud_make(cloud_case *c, uint32_t frames)
{
    memset(c, 0, sizeof *c);
    for (uint32_t i = 0; i < CLOUD_POINTS; i++) {
        const uint32_t k = i * 5 % CLOUD_POINTS; /* 5 and 216 have no common factor */
        const uint32_t at[3] = { k % CLOUD_SIDE, k / CLOUD_SIDE % CLOUD_SIDE,
                                 k / CLOUD_SIDE / CLOUD_SIDE };
        static const double middle[3] = { 10, -4, 2 };

        for (int j = 0; j < 3; j++)
            c->point[i][j] = (float)(middle[j] + CLOUD_STEP * ((double)at[j] - 0.5 * CLOUD_SIDE));
    }
    c->picture.camera =
        (ted4_camera) { 32, 24, 30, 30, 16, 12, { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { -10, 4, 5 } };
    c->data = (ted4_dataset) { .pictures = &c->picture,
                               .n_pictures = 1,
                               .n_frames = frames,
                               .n_cameras = 1,
                               .points = c->point[0],
                               .n_points = CLOUD_POINTS };
    (void)ted4_options_preset(&c->options, "draft");
    c->options.offsets = 3;
    c->options.feature = 8;
    c->options.phi = 4;
    c->options.bank_dim = c->options.deform_width = c->options.head_width = 8;
    c->options.grow_every = 10;
}

/* Makes a trainer on what cloud_make left in c, whose options may have been changed since. */
static inline void cloud_begin(cloud_case *c, ted4_trainer *t)
{
    if (ted4_trainer_init(t, &c->options, &c->data, NULL) != 0)
        fail_msg("%s", t->message.text);
}

#endif
