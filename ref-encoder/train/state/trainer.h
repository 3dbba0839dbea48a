/* trainer.h - the state of the training of one scene, and its upkeep. Source: paper; annex D.
 * Depends on model/, splat/, raster/, loss/, rate/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAINER_H
#define TED4_TRAINER_H

#include "base/parallel.h"
#include "data/dataset.h"
#include "monitor_state.h"
#include "search_state.h"
#include "train/loss/camera_colour.h"
#include "train/loss/loss.h"
#include "train/model/anchors.h"
#include "train/model/options.h"
#include "train/model/weight_grid.h"
#include "train/raster/raster_bwd.h"
#include "train/rate/rate.h"
#include "train/splat/generator.h"

/* Pictures in random order without replacement, then reshuffled. */
typedef struct {
    uint32_t *item; /* owned: picture numbers */
    uint32_t n, next;
    uint64_t key, round;
} ted4_order;

/* What one step measured; running means over about 100 steps. */
typedef struct {
    double loss, l1, ssim;
    double last_loss;        /* of the last step alone */
    double bits[TED4_TYPES]; /* per anchor, over the anchors whose rate was evaluated */
    double splats;           /* Gaussians that reached the screen */
    double splat_pixels;     /* times the pixels of the picture */
} ted4_progress;

/* Buffers of one step, by visible block. */
typedef struct {
    size_t n, capacity;
    uint32_t *block;              /* [n] */
    uint32_t *lanes;              /* [n] */
    uint32_t *drawn;              /* [n] place of its Gaussians among those drawn: its own, until
                                     ted4_update_rate puts visible blocks in another order */
    const float **position;       /* [n] */
    const float **raw, **used;    /* [n] values as stored, as rendered (quantised in stage 2) */
    float **gradient;             /* [n] blocks of n_channels */
    float **steps;                /* [n] */
    float *quantised, *gradients; /* storage behind used and gradient */
    float *squares;               /* [n][TED4_BLOCK_TERMS + 1]: grad_norm.h */
} ted4_visible_blocks;

/* What steps are for: training, or finding something out. */
typedef enum { TED4_BUSY_TRAINING, TED4_BUSY_PROBE, TED4_BUSY_TRIALS } ted4_busy;

/* A program that watches: look is called after every step, those of probes and trials, too, and
 * after every file that a trial makes. It decides nothing, but that what probes and trials do ends
 * at once where it is not 0: the step at hand then fails, and stopped says why. */
typedef struct {
    int (*look)(void *user); /* NULL: nobody watches */
    void *user;              /* borrowed */
    int stopped;
    ted4_busy busy;
    double spent, budget; /* of a probe, or of trials: training steps, so far and at most */
} ted4_onlooker;

/* The networks, and Adam's moments of them. */
typedef struct {
    float *value, *m, *v, *gradient; /* owned, [n_net] */
    int bits[TED4_WEIGHT_GRIDS];     /* of weights in the file: weight_grid.h */
    uint8_t *shift; /* owned, [n_units]; set when the integer stage starts, else NULL */
} ted4_networks;

/* Where in the recipe training stands. */
typedef struct {
    int stage2, integer;
    int clock_stopped;            /* draw everything at time 0 and without activation */
    uint64_t stage2_start;        /* Adam's count restarts there */
    ted4_header rate_norm_header; /* the first header, in stage 2 that at its start: a bit and a
                            mask go on weighing what they weighed in that model */
} ted4_phase;

/* Workspaces and pictures of a step. */
typedef struct {
    ted4_generator *generator;
    ted4_rate *rate;
    ted4_raster *raster;
    ted4_adjoint *adjoint;
    ted4_loss_workspace *loss;
    float *image, *d_image; /* owned: planar, of the largest picture */
    float *splat_storage;   /* owned: gradients of splats */
    uint8_t *splat_visible; /* owned */
    size_t splat_capacity;
    ted4_splat_grads splat_gradient; /* borrows from these */
} ted4_step_work;

/* Everything. Each part says which folder writes it; those above read it. */
typedef struct {
    /* Given: step/trainer_init.h. */
    ted4_train_options opt;
    ted4_dataset *data;            /* borrowed */
    const ted4_parallel *parallel; /* borrowed */

    /* What is learnt: by step/; densify/ adds and removes anchors, resize/ and search/ change the
     * layout. */
    ted4_layout layout;
    ted4_anchors anchors;
    ted4_networks net;
    ted4_colour colour; /* no cameras when switched off */
    double voxel;       /* voxel of growth, normalised space */

    /* How far training has come: step/. */
    uint64_t iteration; /* steps done */
    double seconds; /* that they took, over all runs that shared checkpoints: kept for the program,
                       decides nothing */
    ted4_phase phase;
    ted4_order order;
    ted4_progress progress;
    ted4_monitor monitor;

    /* What has been found out about the size of the model: search/. */
    ted4_search search;

    /* Buffers, of no meaning between steps: state/. */
    ted4_visible_blocks visible_blocks;
    ted4_step_work work;

    ted4_onlooker onlooker;
    ted4_message message; /* why the last call failed */
} ted4_trainer;

/* ---- memory.c ---- */

/* Fresh workspaces and network arrays after t->layout changed; the arrays are zero. 0, or -1 with
 * t->message. */
int ted4_trainer_rebuild(ted4_trainer *t);
/* Frees all that t owns, and clears it. */
void ted4_trainer_finish(ted4_trainer *t);

/* ---- trainer.c ---- */

/* Writes t->message, as printf does. Returns -1. */
int ted4_trainer_fail(ted4_trainer *t, const char *format, ...);
/* Are all network weights, all colour maps and, if wanted, all values and positions of anchors
 * finite? The rasteriser passes over Gaussians that are not, so the loss alone does not tell. 0, or
 * -1 with t->message. */
int ted4_trainer_check(ted4_trainer *t, int anchors);

/* What steps are for from here on, and how many there will be at most. */
void ted4_trainer_busy(ted4_trainer *t, ted4_busy busy, double budget);
/* The onlooker's turn; so many steps were spent. 0, or -1 with t->message: it wants the work to
 * end. */
int ted4_trainer_report(ted4_trainer *t, double spent);

/* Values an anchor that a bit's weight is spread over: of the model at the start of stage 2. */
double ted4_rate_norm(const ted4_trainer *t);
/* Total steps of both stages. */
uint64_t ted4_trainer_total(const ted4_trainer *t);

#endif
