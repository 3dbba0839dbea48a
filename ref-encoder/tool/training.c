/* training.c - see training.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "training.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "data/frame_rate.h"
#include "describe_trained.h"
#include "stop.h"
#include "tool/clock.h"
#include "tool/json_string.h"
#include "tool/output.h"
#include "train/monitor/checkpoint.h"
#include "train/step/export_scene.h"
#include "train/monitor/monitor.h"
#include "train/step/stages.h"
#include "train/train.h"
#include "search_report.h"
#include "write/encode.h"

/* Steps between reports; number of pictures of a preview, and of the last preview. */
enum { REPORT_EVERY = 250, PREVIEW_PICTURES = 16, LAST_PICTURES = 256 };

/* Copies the trainer's message to t->why. Returns -1. */
static int fail(ted4_training *t)
{
    snprintf(t->why, sizeof t->why, "%s", t->trainer->message.text);
    return -1;
}

/* Returns whether this process writes files. */
static int leads(const ted4_training *t)
{
    return t->trainer->exchange == NULL || t->trainer->exchange->rank == 0;
}

static int exists(const char *path)
{
    return path != NULL && access(path, F_OK) == 0;
}

/* Restores the state at which training begins: a checkpoint, the end of stage 1, or step 0. */
static int find_start(ted4_training *t)
{
    const ted4_request *r = t->request;
    ted4_trainer *trainer = t->trainer;

    if (r->resume && exists(r->checkpoint)) {
        if (ted4_checkpoint_load(trainer, r->checkpoint) != 0)
            return fail(t);
        t->saved = (int64_t)trainer->iteration;
        ted4_teller_say(t->teller, "%s: going on from step %llu of %llu", r->checkpoint,
                        (unsigned long long)trainer->iteration,
                        (unsigned long long)ted4_trainer_total(trainer));
        if (r->stage1 != NULL && !exists(r->stage1) && trainer->phase.stage2 && leads(t))
            ted4_teller_error(t->teller, "warning: %s is not written: stage 1 is over in %s",
                              r->stage1, r->checkpoint);
    } else if (exists(r->stage1)) {
        if (ted4_checkpoint_load(trainer, r->stage1) != 0)
            return fail(t);
        if (!ted4_at_stage1_end(trainer)) {
            snprintf(t->why, sizeof t->why, "%s: not the end of stage 1", r->stage1);
            return -1;
        }
        ted4_teller_say(t->teller, "%s: going on from step %llu of %llu, the end of stage 1",
                        r->stage1, (unsigned long long)trainer->iteration,
                        (unsigned long long)ted4_trainer_total(trainer));
    } else if (r->resume) {
        ted4_teller_say(t->teller, "%s: not there yet; beginning at step 0", r->checkpoint);
    }
    return 0;
}

static void tell_exposures(ted4_training *t)
{
    const ted4_colour *c = &t->trainer->colour;

    if (c->exposure.n_knots > 0)
        ted4_teller_say(t->teller, "exposures of cameras change by %.1f %%, and are corrected",
                        100 * c->exposure_change);
}

int ted4_training_begin(ted4_training *t, const ted4_request *r, ted4_trainer *trainer,
                        ted4_teller *teller)
{
    memset(t, 0, sizeof *t);
    t->request = r;
    t->trainer = trainer;
    t->teller = teller;
    t->log.file = -1;
    t->checkpoint = r->checkpoint;
    t->growth.seed_share = -1;
    t->saved = -1;
    t->facts.psnr = t->facts.bytes = -1;
    ted4_estimate_begin(&t->estimate);
    if (find_start(t) != 0)
        return -1;
    /* Files are rank 0's, from when all have read what they begin with. */
    (void)ted4_exchange_first(trainer->exchange, 0);
    if (!leads(t))
        t->checkpoint = NULL;
    if (leads(t))
        tell_exposures(t);
    ted4_stop_keep();
    trainer->onlooker.look = ted4_training_look;
    trainer->onlooker.user = t;
    return ted4_run_log_open(&t->log, r->log, trainer, r->resume, r->verbose ? teller : NULL,
                             t->why, sizeof t->why);
}

int ted4_training_end(ted4_training *t, int bad)
{
    char why[sizeof t->why];
    const int closed = ted4_run_log_close(&t->log, why, sizeof why) == 0;

    if (!bad && !closed)
        memcpy(t->why, why, sizeof why);
    return bad || !closed;
}

/* Makes a preview and writes a line of the log. The time for these is not training time. */
static int log_step(ted4_training *t)
{
    ted4_trainer *tr = t->trainer;
    ted4_preview *p = &t->log.preview;

    ted4_run_log_tick(&t->log, tr);
    if (leads(t) &&
        ted4_preview_make(
            tr, tr->iteration == ted4_trainer_total(tr) ? LAST_PICTURES : PREVIEW_PICTURES, p) != 0)
        return fail(t);
    ted4_run_log_skip(&t->log);

    const int bad = ted4_run_log_step(&t->log, tr, t->why, sizeof t->why);

    t->facts.psnr = p->psnr;
    t->facts.train_psnr = p->train;
    t->facts.bytes = p->bytes > 0 ? p->bytes : -1;
    t->facts.ms = t->log.ms;
    ted4_teller_now(t->teller, &t->facts);
    if (t->request->verbose && !t->teller->terminal)
        ted4_teller_show(t->teller);
    ted4_monitor_line(tr);
    return bad;
}

/* Writes the trainer's state into a file, which keeps what it holds if that fails. */
static int write_state(ted4_training *t, const char *path)
{
    ted4_output o;
    int bad = ted4_output_open(&o, path) != 0;

    if (!bad && ted4_checkpoint_write(t->trainer, o.file, path) != 0) {
        ted4_output_cancel(&o);
        return fail(t);
    }
    bad = bad || ted4_output_keep(&o) != 0;
    if (bad)
        snprintf(t->why, sizeof t->why, "%s: %s", path, strerror(errno));
    return bad ? -1 : 0;
}

static int save(ted4_training *t)
{
    if (t->checkpoint == NULL)
        return 0;
    ted4_run_log_tick(&t->log, t->trainer);
    if (write_state(t, t->checkpoint) != 0)
        return -1;
    t->saved = (int64_t)t->trainer->iteration;
    return 0;
}

/* Ends training after a signal. between: the last step is complete, so that the state may be saved.
 * Always returns -1, with t->why filled: it says how to continue. */
static int stop(ted4_training *t, int between)
{
    const unsigned long long now = t->trainer->iteration;
    const char *way = "nothing of it is kept (--checkpoint FILE would)";
    char text[600];

    if (between && t->checkpoint != NULL && ted4_monitor_calm(t->trainer) && save(t) != 0)
        return -1;
    if (t->saved >= 0) {
        snprintf(text, sizeof text,
                 "%.*s holds step %lld; the same command with --resume goes on from there",
                 ted4_whole_letters(t->request->checkpoint, 400), t->request->checkpoint,
                 (long long)t->saved);
        way = text;
    } else if (exists(t->request->stage1)) {
        snprintf(text, sizeof text,
                 "%.*s holds the end of stage 1; the same command goes on from there",
                 ted4_whole_letters(t->request->stage1, 400), t->request->stage1);
        way = text;
    }
    t->stopped = t->asked;
    snprintf(t->why, sizeof t->why, "stopped at step %llu of %llu; %s", now,
             (unsigned long long)ted4_trainer_total(t->trainer), way);
    return -1;
}

/* Writes the end of stage 1 once, so that later runs can begin there. */
static int keep_stage1(ted4_training *t)
{
    ted4_trainer *tr = t->trainer;
    const char *path = t->request->stage1;

    if (path == NULL || !leads(t) || !ted4_at_stage1_end(tr) || exists(path))
        return 0;
    ted4_run_log_tick(&t->log, tr);
    return write_state(t, path);
}

/* Adapts the log and the estimate after the trainer has restarted or has gone back. */
static int start_over(ted4_training *t)
{
    ted4_run_log_tick(&t->log, t->trainer);
    ted4_training_rewound(t);
    return ted4_run_log_cut(&t->log, t->trainer, t->why, sizeof t->why);
}

/* Reports that the monitor has restored an earlier state of the trainer. */
static int tell_rollback(ted4_training *t)
{
    const ted4_monitor *w = &t->trainer->monitor;

    ted4_teller_say(t->teller, "warning: %s; back to step %llu with learning rates times %g",
                    t->trainer->message.text, (unsigned long long)t->trainer->iteration,
                    w->state.factor);
    return ted4_run_log_event(&t->log, t->trainer, t->why, sizeof t->why);
}

/* Reports whether the poses of training cameras are refined from now on. */
static int tell_poses(ted4_training *t)
{
    const ted4_poses *p = &t->trainer->poses;

    ted4_teller_say(t->teller,
                    p->decision == TED4_POSES_REFINED
                        ? "poses: refinement moves what is seen by %.2f pixels, and goes on"
                        : "poses: refinement moves what is seen by %.2f pixels only; as given",
                    p->moved);
    return ted4_run_log_poses(&t->log, t->trainer, t->why, sizeof t->why);
}

/* Handles a failed step. If the cause is an anomaly, it becomes the last line of the log. */
static int fail_step(ted4_training *t)
{
    if (t->trainer->onlooker.stopped)
        return stop(t, 0);
    if (t->trainer->monitor.found)
        (void)ted4_run_log_event(&t->log, t->trainer, t->why, sizeof t->why);
    return fail(t);
}

/* Makes one step, and logs restarts, rollbacks, decisions, trials and the closing of anchors that
 * happened in it. */
static int step(ted4_training *t)
{
    ted4_trainer *tr = t->trainer;
    const uint64_t before = tr->iteration, rollbacks = tr->monitor.state.rollbacks;
    const size_t trials = tr->search.n_trials;
    const int on_trial = ted4_poses_on_trial(&tr->poses);
    const int closed = tr->closing.moving > 0;

    if (ted4_trainer_step(tr) != 0)
        return fail_step(t);
    /* One call may advance by many steps, since those of a probe count. It may also restart at an
     * earlier step (after a probe) or go back (a rollback). */
    if (tr->iteration <= before && start_over(t) != 0)
        return -1;
    if (on_trial && !ted4_poses_on_trial(&tr->poses) && tell_poses(t) != 0)
        return -1;
    if (!closed && tr->closing.moving > 0 &&
        ted4_run_log_closing(&t->log, tr, t->why, sizeof t->why) != 0)
        return -1;
    if (tr->search.n_trials > trials &&
        ted4_run_log_trials(&t->log, tr, trials, t->why, sizeof t->why) != 0)
        return -1;
    return tr->monitor.state.rollbacks > rollbacks ? tell_rollback(t) : 0;
}

/* Writes a checkpoint before probes and trials: inside them none can be written, so their work is
 * lost when they are stopped. */
static int before_long_step(ted4_training *t)
{
    return ted4_trainer_long_step(t->trainer) && t->saved != (int64_t)t->trainer->iteration &&
                   ted4_monitor_calm(t->trainer)
               ? save(t)
               : 0;
}

/* Returns whether so many stages are complete. */
static int is_done(const ted4_trainer *t, int stages)
{
    return t->iteration == ted4_trainer_total(t) || (stages == 1 && ted4_at_stage1_end(t));
}

int ted4_training_go(ted4_training *t, int stages)
{
    ted4_trainer *tr = t->trainer;
    double saved = ted4_clock();

    ted4_run_log_skip(&t->log);
    while (!is_done(tr, stages)) {
        const uint64_t before = tr->iteration;

        if (ted4_training_asked(t))
            return stop(t, 1);
        if (keep_stage1(t) != 0 || before_long_step(t) != 0)
            return -1;
        if (step(t) != 0)
            return -1;
        if ((tr->iteration / REPORT_EVERY > before / REPORT_EVERY || is_done(tr, stages)) &&
            log_step(t) != 0)
            return -1;
        if (ted4_clock() - saved >= t->request->checkpoint_every && ted4_monitor_calm(tr)) {
            if (save(t) != 0)
                return -1;
            saved = ted4_clock();
        }
    }
    ted4_run_log_tick(&t->log, tr);
    return keep_stage1(t) != 0 || save(t) != 0 ? -1 : 0;
}

int ted4_training_code(ted4_training *t, ted4_coded *c)
{
    ted4_trainer *tr = t->trainer;
    ted4_scene *scene;
    double bits[TED4_TYPES];
    ted4_error e = { TED4_OK, 0 };
    int bad;

    t->facts.kind = TED4_TELL_CODING;
    ted4_teller_now(t->teller, &t->facts);
    memset(c, 0, sizeof *c);
    c->lambda = tr->opt.lambda;
    if (ted4_export_scene(tr, &scene) != 0 || ted4_integer_rate(tr, bits) != 0) {
        ted4_scene_free(scene);
        return fail(t);
    }
    for (int y = 0; y < TED4_TYPES; y++)
        c->verified.estimated_bits += bits[y];
    if (t->request->rate > 0)
        ted4_frame_rate(t->request->rate, &scene->head.rate_num, &scene->head.rate_den);
    char *text = t->request->search_report ? ted4_search_report(tr) : NULL;

    bad = t->request->search_report && text == NULL;
    if (bad)
        snprintf(t->why, sizeof t->why, "no memory to say why");
    else if ((bad = ted4_encode_with_text(scene, 0, text, tr->parallel, &c->bytes, &c->size, &e) !=
                    TED4_OK))
        snprintf(t->why, sizeof t->why, "encoder refused its own scene: %s",
                 ted4_status_id(e.code));
    else
        bad = ted4_verify(scene, c->bytes, c->size, tr->parallel, &c->verified, t->why,
                          sizeof t->why) != 0 ||
              ted4_describe_trained(t->request, tr->data, tr->parallel, &c->bytes, &c->size, t->why,
                                    sizeof t->why) != 0;
    free(text);
    ted4_scene_free(scene);
    if (bad)
        ted4_coded_free(c);
    return bad ? -1 : 0;
}

void ted4_coded_free(ted4_coded *c)
{
    free(c->bytes);
    c->bytes = NULL;
    c->size = 0;
}
