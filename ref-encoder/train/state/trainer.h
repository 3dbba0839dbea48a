/* trainer.h - training of one scene: state, one step, stages. Source: paper; annex D.
 * Depends on everything in train/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAINER_H
#define TED4_TRAINER_H

#include "train/model/anchors.h"
#include "base/parallel.h"
#include "train/loss/camera_colour.h"
#include "data/dataset.h"
#include "train/model/weight_grid.h"
#include "train/model/header_from_options.h"
#include "train/loss/loss.h"
#include "train/model/options.h"
#include "train/step/monitor.h"

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

/* Buffers of one step, by slot (visible block). */
typedef struct {
    size_t n, capacity;
    uint32_t *block;              /* [n] */
    uint32_t *lanes;              /* [n] */
    uint32_t *drawn;              /* [n] place of its Gaussians among those drawn: its own, until
                                     ted4_update_rate puts slots in another order */
    const float **position;       /* [n] */
    const float **raw, **used;    /* [n] values as stored, as rendered (quantised in stage 2) */
    float **gradient;             /* [n] blocks of n_channels */
    float **steps;                /* [n] */
    float *quantised, *gradients; /* storage behind used and gradient */
    float *squares;               /* [n][TED4_SLOT_TERMS + 1]: grad_norm.h */
} ted4_slots;

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

/* Nothing yet; how much model there is; how coarse its weights are in the end; which anchors pay,
 * too. */
enum { TED4_DECIDED_NOTHING, TED4_DECIDED_MODEL, TED4_DECIDED_BITS, TED4_DECIDED_ALL };

typedef struct {
    ted4_train_options opt;
    ted4_dataset *data;            /* borrowed */
    const ted4_parallel *parallel; /* borrowed */
    ted4_layout layout;
    ted4_anchors anchors;
    float *net, *net_m, *net_v, *net_gradient; /* owned, [n_net] */
    uint8_t *shift;     /* owned, [n_units]; set when the integer stage starts, else NULL */
    double cell;        /* voxel of growth, normalised space */
    uint64_t iteration; /* steps done */
    double seconds; /* that they took, over all runs that shared checkpoints: kept for the program,
                       decides nothing */
    int stage2, integer;
    int probed; /* it is settled whether the scene needs time at all (static_test.c) */
    double
        probe_loss[2]; /* mean losses that settled it: with time, without; 0: nothing was tried */
    int clock_stopped; /* draw everything at time 0 and without activation */
    uint64_t stage2_start; /* Adam's count restarts there */
    ted4_header charged;   /* the first header, in stage 2 that at its start: a bit and a mask go on
                              weighing what they weighed in that model */
    int bits[TED4_GRIDS];  /* of weights in the file: weight_grid.h */
    int decided;           /* how much of what model_search.h settles has been: TED4_DECIDED_... */
    struct ted4_trial *trial; /* owned: what settled it */
    size_t n_trials;
    ted4_order order;
    ted4_progress progress;
    ted4_watch watch;

    ted4_generator *generator;
    ted4_rate *rate;
    ted4_raster *raster;
    ted4_loss_workspace *loss;
    ted4_colour colour; /* no cameras when switched off */
    ted4_slots slots;
    float *image, *d_image; /* planar, of the largest picture */
    float *splat_storage;   /* gradients of splats */
    uint8_t *splat_visible;
    size_t splat_capacity;
    ted4_splat_grads splat_gradient;
    ted4_onlooker onlooker;
    ted4_message message; /* why the last call failed */
} ted4_trainer;

/* Start from the initial points. 0, or -1 with t->message. d and p are borrowed until
 * ted4_trainer_finish. */
int ted4_trainer_init(ted4_trainer *t, const ted4_train_options *o, ted4_dataset *d,
                      const ted4_parallel *p);
void ted4_trainer_finish(ted4_trainer *t);
/* The same from the first step on, in the layout of h, and without a probe; h is none of t's own.
 * 0, or -1 with t->message. */
int ted4_trainer_restart(ted4_trainer *t, const ted4_header *h);

/* What steps are for from here on, and how many there will be at most. */
void ted4_trainer_busy(ted4_trainer *t, ted4_busy busy, double budget);
/* The onlooker's turn; so many steps were spent. 0, or -1 with t->message: it wants the work to
 * end. */
int ted4_trainer_told(ted4_trainer *t, double spent);
/* How many steps of each of its two branches the probe will have; 0: there will be none. */
int ted4_probe_steps(const ted4_trainer *t);

/* Values an anchor that a bit's weight is spread over: of the model at the start of stage 2. */
double ted4_trainer_charged(const ted4_trainer *t);
/* Total steps of both stages. */
uint64_t ted4_trainer_total(const ted4_trainer *t);
/* One step, with whatever the schedule wants done around it (growth, activation, change of stage,
 * integer networks). Or, where the watch finds that training goes wrong, the way back to the last
 * good state: iteration is then smaller or the same, watch.state.rollbacks larger, and watch.find
 * and message say why. 0, or -1 with t->message; watch.found then tells whether it is a find that
 * nothing more was done about. */
int ted4_trainer_step(ted4_trainer *t);
/* Will the next step take as long as many, to find something out? */
int ted4_trainer_long_step(const ted4_trainer *t);
/* Mean PSNR of the current model on up to n held-out pictures (training pictures when there are
 * none), spread evenly over them, from its own floats: for the progress line only. Negative:
 * failure, with t->message. */
double ted4_trainer_preview(ted4_trainer *t, int n);

/* ---- between the trainer's files ---- */

/* Learning-rate rows and schedule: schedule.c */
void ted4_schedule_rates(const ted4_trainer *t, float *channel_rate);
/* The stretches of the network array that are learnt, and their rates: how many; at most
 * TED4_NET_RANGES. */
typedef struct {
    size_t first, n;
    float rate; /* 0: it stands still */
} ted4_net_range;
enum { TED4_NET_RANGES = TED4_NETS_R + 2 };
int ted4_schedule_network(const ted4_trainer *t, ted4_net_range *range);
int ted4_schedule_event(ted4_trainer *t);
/* Does the integer stage begin with this step? schedule.c */
int ted4_integer_due(const ted4_trainer *t);
/* Shares of stage 1 at which growth begins and sprouts come, and the share of anchors that is kept
 * for these; 0: none will come. For estimates of time. */
void ted4_schedule_growth(const ted4_trainer *t, double *from, double *sprout_at, double *sprouts);
/* By how many anchors growth may still add. */
size_t ted4_schedule_room(const ted4_trainer *t);

/* After the picture's gradients: apply_gradients.c.
 * Volume: weight times the mean of the product of scales over the Gaussians on screen; returns
 * how many there are, and tells the watch, with the norm of the gradients of their centres: not
 * finite where one is not. Bank: mean squared second difference of its rows. Rate of a random
 * share of the visible blocks: gradients of bits on values, masks and NETE, and of the
 * distortion on step sizes. Parameters: mask losses and Adam. */
size_t ted4_update_volume(ted4_trainer *t, const ted4_splats *s);
void ted4_update_bank(ted4_trainer *t);
int ted4_update_rate(ted4_trainer *t, uint64_t key);
void ted4_update_parameters(ted4_trainer *t);

/* Draws the model as it is now into t->image, planar, and tells view and camera centre in
 * normalised space. 0, or -1 with t->message. step.c */
int ted4_trainer_draw(ted4_trainer *t, const ted4_picture *pic, ted4_view *v, float centre[3]);

/* Distortion of training picture item, drawn from the model as it is now; nothing is learnt from
 * it. Negative: failed, with t->message. step.c */
double ted4_trainer_distortion(ted4_trainer *t, size_t item);
/* The same picture's gradients of the distortion on Gaussians, in t->splat_gradient; *s and
 * t->slots: which Gaussians. 0, or -1 with t->message. step.c */
int ted4_trainer_blame(ted4_trainer *t, size_t item, ted4_splats *s);

/* The true picture number item, interleaved bytes, in the scene's colours; valid until
 * ted4_dataset_release of it, or the next call. NULL, with t->message. step.c */
const uint8_t *ted4_trainer_seen(ted4_trainer *t, size_t item);

/* Visible blocks of a view: visible_blocks.c */
int ted4_slots_fill(ted4_trainer *t, const ted4_view *v);
void ted4_slots_finish(ted4_slots *s);
/* In stage 2: fills slots.used, from values and steps as they are now. In stage 1 that is raw. */
void ted4_slots_quantise(ted4_trainer *t, ted4_quant quant);
/* Bit j: anchor j of the block can be seen. */
uint32_t ted4_block_visible(const ted4_trainer *t, size_t block, const ted4_view *v);

/* Of each anchor, in stage 2 as the file will hold it, at time 0 and without activation, from the
 * camera of the next training picture, or, where opacity depends on the direction, from that of
 * several at which it is most opaque: summed opacity of its offsets [n], and their mean colour by
 * opacity [n][3] (NULL: not wanted; 0 where nothing is opaque). 0, or -1 with t->message.
 * anchor_appearance.c
 */
int ted4_trainer_looks(ted4_trainer *t, float *opacity, float *rgb);

/* Densification: densify.c. gather adds the statistics of a step; adjust grows and prunes.
 * lanes_there: lanes of a slot whose activation is at least a half now. */
void ted4_densify_gather(ted4_trainer *t, const ted4_generate_input *in, const ted4_splats *s);
int ted4_densify_adjust(ted4_trainer *t);
uint32_t ted4_lanes_there(const ted4_generate_input *in, size_t slot);

/* Stage changes: stages.c */
int ted4_activation_begin(ted4_trainer *t);
int ted4_stage2_begin(ted4_trainer *t);
int ted4_integer_begin(ted4_trainer *t);
/* Anchors that rise: the numbers of those that are not idle, rising[n], in order. The opacity of an
 * idle one is below prune_opacity even when it is there most, so that no picture would miss it.
 * And: idle anchors are dropped, before stage 2, which would pay for them; it is an error if all
 * are. 0, or -1 with t->message. stages.c */
int ted4_stage_rising(ted4_trainer *t, uint32_t *rising, size_t *n);
int ted4_stage_drop_idle(ted4_trainer *t);
/* Once the integer stage has begun: steps of all anchors, and their bits [TED4_TYPES] by the float
 * formula on rounded symbols (NULL: steps only). */
int ted4_integer_rate(ted4_trainer *t, double *bits);
/* The model in the layout of h, which has the same heads and the same or fewer types of values;
 * optimiser and statistics go along. Prior networks are zero afterwards. */
int ted4_stage_relayout(ted4_trainer *t, const ted4_header *h);
/* Does the scene need time? Trains a while with and without; then it goes on where it was worth it,
 * and else begins again without time, at step 0: static_test.c */
int ted4_probe_time(ted4_trainer *t);
/* n steps from where t stands, which a rollback goes back to; *loss: mean loss of the second half.
 * 0, or -1 with t->message. static_test.c */
int ted4_branch_run(ted4_trainer *t, int n, double *loss);
/* Fresh workspaces and network arrays after t->layout changed. */
int ted4_trainer_rebuild(ted4_trainer *t);

/* Are all network weights, and if wanted all values and positions of anchors, finite? The
 * rasteriser passes over Gaussians that are not, so the loss alone does not tell. 0, or -1 with
 * t->message. trainer.c */
int ted4_trainer_check(ted4_trainer *t, int anchors);

int ted4_trainer_fail(ted4_trainer *t, const char *format, ...);

/* The watch: monitor.c. All that return int return 0, or -1 with t->message, and with watch.found
 * when it is a find. begin: before a step; looks at what is learnt, from time to time at all
 * anchors, and then keeps the state. loss: of the picture. look: after the update; gradients,
 * values, loss, and how much was drawn of in and s. */
int ted4_watch_begin(ted4_trainer *t);
int ted4_watch_loss(ted4_trainer *t, double loss);
int ted4_watch_look(ted4_trainer *t, double loss, const ted4_generate_input *in,
                    const ted4_splats *s);
/* After a step that failed: back to the last good state with smaller learning rates, if it was a
 * find, there is such a state and this was not done three times. */
int ted4_watch_recover(ted4_trainer *t);
/* A find: its message is what, term, the anchor and what has happened to it (format). Returns -1.
 */
int ted4_watch_find(ted4_trainer *t, const char *cause, int64_t anchor, const char *what,
                    const char *term, const char *format, ...);
/* Will the next step begin with keeping the state? Then the last good state matters no more. */
int ted4_watch_due(const ted4_trainer *t);
/* No good state is kept: the next step keeps its own beginning. */
void ted4_watch_forget(ted4_trainer *t);
/* Nothing looks suspicious: this state may replace an older one on the disk. */
int ted4_watch_calm(const ted4_trainer *t);
/* A line of the log was written: peaks begin anew. */
void ted4_watch_line(ted4_trainer *t);

#endif
