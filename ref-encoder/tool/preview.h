/* preview.h - size and quality of the file if training ended now; the size is that of an actually
 * coded file. Used for the progress line and the log only.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PREVIEW_H
#define TED4_PREVIEW_H

#include "train/state/trainer.h"

/* All sizes are 0 before stage 2. */
typedef struct {
    double psnr;  /* mean over pictures, dB */
    int train;    /* 1: psnr is that of training pictures, because no picture is held out */
    double bytes; /* size of the file */
    /* The parts of bytes. frame: tiles, header and container. */
    double positions, masks, type[TED4_TYPES], networks, frame;
} ted4_preview;

/* Previews the current model on up to n pictures of the held-out split, or of the training pictures
 * if none is held out. Leaves the trainer unchanged. If the model cannot be coded in its current
 * state, the sizes in *p are kept. Returns 0, or -1 with t->message filled. */
int ted4_preview_make(ted4_trainer *t, int n, ted4_preview *p);

#endif
