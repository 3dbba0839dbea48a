/* trainer.h - the state of the training of one scene, and its upkeep. Source: paper; annex D.
 * Depends on model/, splat/, raster/, loss/, rate/, pose/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAINER_H
#define TED4_TRAINER_H

#include "base/parallel.h"
#include "data/dataset.h"
#include "exchange.h"
#include "monitor_state.h"
#include "search_state.h"
#include "train/loss/camera_colour.h"
#include "train/loss/loss.h"
#include "train/model/anchors.h"
#include "train/model/options.h"
#include "train/model/weight_grid.h"
#include "train/pose/pose.h"
#include "train/raster/raster_bwd.h"
#include "train/rate/rate.h"
#include "train/splat/generator.h"
#include "view_sums.h"

/* The order of the training pictures: random without replacement, then reshuffled
 * (step/picture_order.h). */
typedef struct {
    uint32_t *item; /* owned: picture numbers */
    uint32_t n, next;
    uint32_t end; /* where those begin that wait for a later round; 0: not known yet */
    uint64_t key, round;
    double cameras; /* pictures per time, over the times that have any */
} ted4_order;

/* Measurements of the steps: running means over about 100 steps. */
typedef struct {
    double loss, l1, ssim;
    double last_loss;        /* of the last step alone */
    double bits[TED4_TYPES]; /* bits per anchor, over the anchors whose rate was evaluated */
    double splats;           /* Gaussians that reached the screen */
    double splat_pixels;     /* Gaussians on screen times pixels of the picture */
} ted4_progress;

/* Buffers of one step, indexed by visible block. The first awake blocks are rendered. No anchor of
 * the others is there at the time of the picture (ted4_visible_blocks_wake). */
typedef struct {
    size_t n, awake, capacity;
    uint32_t *block; /* [n] */
    uint32_t *lanes; /* [n] */
    uint32_t *seen;  /* [n] of several views of one time, the lanes of the latest */
    uint8_t *sleeps; /* [n] of the order before ted4_visible_blocks_wake: no anchor is there */
    /* [n] Index of its Gaussians among those rendered: the block's own index, until
     * ted4_update_rate reorders the visible blocks. */
    uint32_t *drawn;
    const float **position;       /* [n] */
    const float **raw, **used;    /* [n] values as stored; as rendered (quantised in stage 2) */
    float **gradient;             /* [n] blocks of n_channels */
    float **steps;                /* [n] */
    float *quantised, *gradients; /* memory behind used and gradient */
    float *squares;               /* [n][TED4_BLOCK_TERMS + 1]: see grad_norm.h */
} ted4_visible_blocks;

/* The purpose of the current steps: training, the static test, or trials of the searches. */
typedef enum { TED4_BUSY_TRAINING, TED4_BUSY_PROBE, TED4_BUSY_TRIALS } ted4_busy;

/* The program that watches the training. look is called after every step, including those of probes
 * and trials, and after every file that a trial writes. Its return value matters only during probes
 * and trials: if it is not 0, they end at once. The current step then fails, and stopped is set. */
typedef struct {
    int (*look)(void *user); /* NULL: no onlooker */
    void *user;              /* borrowed */
    int stopped;
    ted4_busy busy;
    double spent, budget; /* training steps of the probe or of the trials: so far; upper bound */
} ted4_onlooker;

/* Network parameters with their Adam moments. */
typedef struct {
    float *value, *m, *v, *gradient; /* owned, [n_net] */
    int bits[TED4_WEIGHT_GRIDS];     /* bits per weight in the file, for each grid: weight_grid.h */
    /* Owned, [n_units]. Allocated when the integer stage begins, NULL before. */
    uint8_t *shift;
} ted4_networks;

/* The current phase of the recipe. */
typedef struct {
    int stage2, integer;
    int clock_stopped;     /* render everything at time 0 and without activation */
    uint64_t stage2_start; /* Adam's step count restarts there */
    int grid; /* bits a coordinate of positions (spec 8.2); 0: binary16, as before stage 2 */
    /* The initial header; from the start of stage 2 on, the header at that start. The weights of a
     * bit and of a mask refer to this model, whatever becomes of it later. */
    ted4_header rate_norm_header;
} ted4_phase;

/* What closing still anchors found; 0 before. */
typedef struct {
    uint64_t anchors, moving, closed; /* of moving, before */
} ted4_closing;

/* Workspaces and images of a step. */
typedef struct {
    ted4_generator *generator;
    ted4_rate *rate;
    ted4_raster *raster;
    ted4_adjoint *adjoint;
    ted4_loss_workspace *loss;
    float *image, *d_image; /* owned: planar, sized for the largest picture */
    float *splat_storage;   /* owned: gradients of splats */
    uint8_t *splat_visible; /* owned */
    size_t splat_capacity;
    ted4_splat_grads splat_gradient; /* borrows from splat_storage and splat_visible */
    ted4_view_sums view_sums;        /* of a step with several views */
} ted4_step_work;

/* The whole state. Each part names the folder that writes it; the folders above that one read
 * it. */
typedef struct {
    /* Inputs: set by step/trainer_init.h. */
    ted4_train_options opt;
    ted4_dataset *data;            /* borrowed */
    const ted4_parallel *parallel; /* borrowed */
    /* Borrowed, set by the program after that; NULL: this process trains alone. */
    ted4_exchange *exchange;

    /* Learnt parameters: updated by step/; densify/ adds and removes anchors, resize/ and search/
     * change the layout. */
    ted4_layout layout;
    ted4_anchors anchors;
    ted4_networks net;
    ted4_colour colour; /* no cameras if colour correction is off */
    ted4_poses poses;   /* none if poses are not refined */
    double voxel;       /* voxel size for growth, in normalised space */

    /* Progress of the training: step/. */
    uint64_t iteration; /* steps done */
    /* Seconds spent on these steps, over all runs that shared checkpoints. Kept for the program
     * only; no decision depends on them. */
    double seconds;
    ted4_phase phase;
    ted4_order order;
    ted4_progress progress;
    ted4_monitor monitor;

    /* Results about motion: densify/still_anchors.h. */
    ted4_closing closing;

    /* Results about the size of the model: search/. */
    ted4_search search;

    /* Buffers whose contents have no meaning between steps: state/. */
    ted4_visible_blocks visible_blocks;
    ted4_step_work work;

    ted4_onlooker onlooker;
    ted4_message message; /* why the last call failed */
    /* 1: the last ted4_export_scene failed because rate had removed every Gaussian */
    int is_empty;
} ted4_trainer;

/* ---- memory.c ---- */

/* Allocates new workspaces and network arrays after t->layout has changed; the arrays are zero.
 * Returns 0, or -1 with t->message. */
int ted4_trainer_rebuild(ted4_trainer *t);
/* Frees everything that t owns, and clears it. */
void ted4_trainer_finish(ted4_trainer *t);

/* ---- trainer.c ---- */

/* Writes t->message, formatted as by printf. Returns -1. */
int ted4_trainer_fail(ted4_trainer *t, const char *format, ...);
/* Checks that all network weights, colour maps and poses and, if anchors is not 0, all values and
 * positions of anchors are finite. The rasteriser skips Gaussians that are not finite, so the loss
 * alone does not reveal them. Returns 0, or -1 with t->message. */
int ted4_trainer_check(ted4_trainer *t, int anchors);

/* Declares the purpose of the steps that follow, and an upper bound of their number. */
void ted4_trainer_busy(ted4_trainer *t, ted4_busy busy, double budget);
/* Reports to the onlooker that so many steps were spent. Returns 0, or -1 with t->message if the
 * onlooker ends the work. */
int ted4_trainer_report(ted4_trainer *t, double spent);

/* Computes the view and the centre of the camera of a picture, in normalised space and at its
 * refined pose. pic: one of t->data. */
void ted4_trainer_view(const ted4_trainer *t, const ted4_picture *pic, ted4_view *v,
                       float centre[3]);

/* The rate norm: the number of values per anchor over which the weight of a bit is spread, in the
 * model at the start of stage 2 (before stage 2: in the initial model). */
double ted4_rate_norm(const ted4_trainer *t);
/* Total number of steps in both stages. */
uint64_t ted4_trainer_total(const ted4_trainer *t);
/* Returns the number of steps done in the present stage. */
uint64_t ted4_stage_position(const ted4_trainer *t);
/* Returns whether the last step was that of stage 1, and stage 2 has not begun. */
int ted4_at_stage1_end(const ted4_trainer *t);

#endif
