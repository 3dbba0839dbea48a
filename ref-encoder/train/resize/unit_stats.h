/* unit_stats.h - statistics for prune_units.h: second moments of the units of the model's networks
 * over anchors and training pictures, and the weights that read the units. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_UNIT_STATS_H
#define TED4_UNIT_STATS_H

#include "train/state/trainer.h"

/* Sites: places in the networks whose units can be pruned. */
typedef enum {
    TED4_SITE_FEATURE,  /* features, both as stored and as deformed by F_deform */
    TED4_SITE_PHI,      /* temporal features of moving anchors */
    TED4_SITE_BANK,     /* units of the bank times those of F_project, which F_deform reads; moving
                           anchors only */
    TED4_SITE_INPUT,    /* inputs of head net: feature and view direction */
    TED4_SITE_HIDDEN,   /* hidden layer of network net (for TED4_NET_DEFORM: moving anchors only) */
    TED4_SITE_POSITION, /* inputs of the hyperprior: encoded positions */
    TED4_SITE_HYPER,    /* hidden layer of the hyperprior */
    TED4_SITE_SLICE     /* hidden layer of the network of slice number layer */
} ted4_site_kind;

typedef struct {
    ted4_site_kind kind;
    int net;   /* TED4_NET_...; for INPUT and HIDDEN */
    int layer; /* layer 1 .. number of hidden layers, for HIDDEN and HYPER; slice 1 .. n_slices - 1,
                  for SLICE */
} ted4_site;

/* Returns the number of units at a site, or 0 if the model has no such site. The motion type inr
 * has no PHI, no BANK, and no HIDDEN of F_deform. */
int ted4_site_width(const ted4_layout *l, ted4_site site);
/* Fills moment[width + 1][width + 1]: means of products of units over a sample of anchors that are
 * in view in training pictures. The last unit is the constant 1. If no anchor counts, all entries
 * except that of the constant are zero. In stage 2, values are quantised as in the file. Returns 0,
 * or -1 with t->message filled. */
int ted4_site_moment(ted4_trainer *t, ted4_site site, double *moment);
/* Collects the weights of the layers that read the units into rows[count][width], to be freed by
 * the caller. Returns count, or -1 if memory ran out. */
int ted4_site_readers(const ted4_trainer *t, ted4_site site, float **rows);

#endif
