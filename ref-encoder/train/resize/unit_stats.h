/* unit_stats.h - how the units of the model's networks move over anchors and training pictures:
 * means of products, and who reads them. For prune_units.h. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_UNIT_STATS_H
#define TED4_UNIT_STATS_H

#include "train/state/trainer.h"

/* Places in the networks whose units may become fewer. */
typedef enum {
    TED4_SITE_FEATURE, /* features, as they stand and as F_deform changes them */
    TED4_SITE_PHI,     /* temporal features of anchors that move */
    TED4_SITE_BANK,    /* units of the bank times those of F_project: what F_deform reads; of the
                          anchors that move */
    TED4_SITE_INPUT,   /* inputs of head net: feature and view direction */
    TED4_SITE_HIDDEN,  /* hidden layer of network net (TED4_NET_DEFORM: of the anchors that move) */
    TED4_SITE_POSITION, /* inputs of the hyperprior: encoded positions */
    TED4_SITE_HYPER,    /* hidden layer of the hyperprior */
    TED4_SITE_SLICE     /* hidden layer of the network of slice number layer */
} ted4_site_kind;

typedef struct {
    ted4_site_kind kind;
    int net;   /* TED4_NET_...: of INPUT and HIDDEN */
    int layer; /* 1 .. hidden layers: of HIDDEN and HYPER; the slice, 1 .. n_slices - 1: of SLICE */
} ted4_site;

/* Units at a site; 0: the model has no such site. Motion inr has neither PHI, nor BANK, nor HIDDEN
 * of F_deform. */
int ted4_site_width(const ted4_layout *l, ted4_site site);
/* moment[width + 1][width + 1]: means of products over a sample of anchors in view of training
 * pictures, the last unit being the constant 1; all zero but the constant where no anchor counts.
 * In stage 2 values are quantised as the file will have them. 0, or -1 with t->message. */
int ted4_site_moment(ted4_trainer *t, ted4_site site, double *moment);
/* Weights of the layers that read the units: rows[count][width], to be freed; count is the result,
 * or -1: no memory. */
int ted4_site_readers(const ted4_trainer *t, ted4_site site, float **rows);

#endif
