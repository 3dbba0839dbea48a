/* preview.h - what the file would be if training ended now: its size, really coded, and its
 * quality. For the progress line and the log only.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PREVIEW_H
#define TED4_PREVIEW_H

#include "train/state/trainer.h"

/* Bytes are 0 before stage 2. */
typedef struct {
    double psnr;  /* mean over pictures, dB */
    int train;    /* of training pictures: none is held out */
    double bytes; /* of the file */
    /* Of which; frame: tiles, header, container. */
    double positions, masks, type[TED4_TYPES], networks, frame;
} ted4_preview;

/* Of the model as it is, on up to n pictures of the held-out split; the trainer is the same
 * afterwards. A model that cannot be coded as it is keeps the bytes that *p has. 0, or -1 with
 * t->message. */
int ted4_preview_make(ted4_trainer *t, int n, ted4_preview *p);

#endif
