/* monitor.c - detects anomalies of training (monitor.h). The limits that are relative to a usual
 * size are so wide that no training that went well ever came near them (doc/training.md). Values
 * that are not finite are found at once.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "monitor.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "grad_norm.h"
#include "scale.h"
#include "train/densify/densify.h"

/* A good state is kept every KEEP_EVERY steps, halfway between events of the schedule, which come
 * at multiples of 100. If an event fails, there are steps before it that can be repeated with
 * smaller learning rates. */
enum { KEEP_EVERY = 500, KEEP_AT = 250 };

/* A gradient has exploded if it is so many times its usual size. Measured: in trainings that go
 * well, single steps reach 2,300 times (activations, whose edges may be as narrow as spec 11.4
 * allows; column peak of bench/stability.csv). Adam limits what one such step changes. */
#define EXPLODED  1e5
/* The loss diverges if it is DIVERGED times its usual size, and larger than HIGH_LOSS, in ROW
 * consecutive steps. Pictures come in random order, so that a few unusual pictures do not cause
 * this. */
#define DIVERGED  3.0
#define HIGH_LOSS 0.1
enum { ROW = 32 };
/* The screen is nearly empty if it shows less than this share of the usual number of Gaussians.
 * That alone is no failure, because it is right to remove anchors in empty space, however many.
 * They have collapsed if the pictures get worse: if the mean loss over ROW such steps is LOST
 * times the usual loss before them. */
#define NEARLY_EMPTY (1.0 / 8.0)
#define LOST         1.25

static const char *const names[TED4_TERMS] = {
    "feature", "scaling", "offset", "phi",   "tau",   "masks",  "centres",
    "heads",   "motion",  "bank",   "prior", "steps", "colour", "pose",
};

const char *ted4_term_name(int term)
{
    return names[term];
}

int ted4_monitor_anomaly(ted4_trainer *t, const char *cause, int64_t anchor, const char *what,
                         const char *term, const char *format, ...)
{
    ted4_anomaly *f = &t->monitor.anomaly;
    char where[64] = "", how[128];
    va_list arguments;

    f->cause = cause;
    f->anchor = anchor;
    f->step = t->iteration;
    t->monitor.found = 1;
    snprintf(f->term, sizeof f->term, "%s%s", what, term);
    if (anchor >= 0)
        snprintf(where, sizeof where, " of anchor %lld", (long long)anchor);
    va_start(arguments, format);
    vsnprintf(how, sizeof how, format, arguments);
    va_end(arguments);
    return ted4_trainer_fail(t, "%s%s %s at step %llu", f->term, where, how,
                             (unsigned long long)t->iteration);
}

static int bad_value(ted4_trainer *t, int64_t anchor, int term)
{
    return ted4_monitor_anomaly(t, "not finite", anchor, "value of ",
                                term == TED4_TERM_CENTRE ? "position" : names[term],
                                "is not finite");
}

static int bad_gradient(ted4_trainer *t, int term, double times)
{
    int finite;
    const int64_t anchor = ted4_gradients_anchor(t, term, &finite);

    if (!finite || !isfinite(times))
        return ted4_monitor_anomaly(t, finite ? "exploded" : "not finite", anchor, "gradient of ",
                                    names[term],
                                    finite ? "is beyond all numbers" : "is not finite");
    return ted4_monitor_anomaly(t, "exploded", anchor, "gradient of ", names[term],
                                "is %.3g times what is usual", times);
}

static int is_calm(const ted4_monitor_state *w)
{
    return w->bad_loss == 0 && w->bad_screen == 0;
}

int ted4_monitor_due(const ted4_trainer *t)
{
    const uint64_t i = t->iteration;

    return !t->monitor.pinned && is_calm(&t->monitor.state) &&
           (i % KEEP_EVERY == KEEP_AT || ted4_at_stage1_end(t) || i == ted4_trainer_total(t));
}

void ted4_monitor_forget(ted4_trainer *t)
{
    ted4_snapshot_free(&t->monitor.good);
}

int ted4_monitor_values(ted4_trainer *t, int anchors)
{
    int term;

    if (ted4_trainer_check(t, anchors) == 0)
        return 0;
    if (!ted4_colour_finite(&t->colour))
        return ted4_monitor_anomaly(t, "not finite", -1, "map of ", "colour", "is not finite");
    if (!ted4_poses_finite(&t->poses))
        return ted4_monitor_anomaly(t, "not finite", -1, "motion of ", "pose", "is not finite");

    const int64_t anchor = ted4_gradients_bad_value(t, &term);

    return anchor >= 0
               ? bad_value(t, anchor, term)
               : ted4_monitor_anomaly(t, "not finite", -1, "weight of ",
                                      names[ted4_gradients_bad_network(t)], "is not finite");
}

int ted4_monitor_loss(ted4_trainer *t, double loss)
{
    return isfinite(loss) ? 0
                          : ted4_monitor_anomaly(t, "not finite", -1, "loss", "", "is not finite");
}

/* The reasons why an anchor is hidden: its activation at this time, no extent, or no opacity. -1
 * means that it is not hidden. */
enum { BY_ACTIVATION, BY_SCALE, BY_OPACITY, REASONS };

static int hidden_reason(const ted4_visible_blocks *visible_blocks, const ted4_generate_input *in,
                         const ted4_splats *s, size_t visible, size_t lane)
{
    const size_t K = in->layout->head.n_offsets;
    float opacity = 0, extent = 0;

    if (visible_blocks->drawn[visible] >= visible_blocks->awake)
        return BY_ACTIVATION;
    for (size_t k = 0; k < K; k++) {
        const size_t at = (visible_blocks->drawn[visible] * K + k) * TED4_LANES + lane;

        opacity = fmaxf(opacity, s->opacity[at]);
        for (int c = 0; c < 3; c++)
            extent = fmaxf(extent, s->scale[c][at]);
    }
    if (!(ted4_lanes_there(in, visible) >> lane & 1))
        return BY_ACTIVATION;
    return extent < TED4_NO_EXTENT ? BY_SCALE : opacity <= 0 ? BY_OPACITY : -1;
}

/* Reports a collapse: the reason that hides most of the anchors in the view, and the first anchor
 * that it hides. */
static int collapsed(ted4_trainer *t, const ted4_generate_input *in, const ted4_splats *s)
{
    static const char *const reasons[REASONS] = { "activation", "scale", "opacity" };
    size_t count[REASONS] = { 0 }, n = 0;
    int64_t first[REASONS] = { -1, -1, -1 };
    int most = BY_OPACITY;

    for (size_t i = 0; i < t->visible_blocks.n; i++)
        for (size_t j = 0; j < TED4_LANES; j++) {
            const int why = in->lanes[i] >> j & 1 ? hidden_reason(&t->visible_blocks, in, s, i, j)
                                                  : -1;

            n += in->lanes[i] >> j & 1;
            if (why >= 0 && count[why]++ == 0)
                first[why] = (int64_t)(t->visible_blocks.block[i] * (size_t)TED4_LANES + j);
        }
    for (int k = 0; k < REASONS; k++)
        most = count[k] > count[most] ? k : most;
    return ted4_monitor_anomaly(t, "collapsed", first[most], "", reasons[most],
                                "is nothing, as that of %zu of %zu anchors in view", count[most],
                                n);
}

/* Resets the usual sizes when the phase changes (rate, rounding, clock stopped), because gradients
 * then change, too. */
static void note_phase(ted4_trainer *t)
{
    ted4_monitor_state *w = &t->monitor.state;
    const uint64_t phase = (uint64_t)t->phase.stage2 | (uint64_t)t->phase.integer << 1 |
                           (uint64_t)t->phase.clock_stopped << 2;

    if (phase == w->phase)
        return;
    memset(w->gradient, 0, sizeof w->gradient);
    memset(&w->loss, 0, sizeof w->loss);
    memset(&w->screen, 0, sizeof w->screen);
    w->bad_loss = w->bad_screen = 0;
    w->phase = phase;
}

static int look_at_gradients(ted4_trainer *t)
{
    ted4_monitor *w = &t->monitor;
    double times[TED4_TERMS];
    int worst = 0, term;

    const int64_t anchor = ted4_gradients_bad_seen(t, &term);

    if (anchor >= 0)
        return bad_value(t, anchor, term);
    ted4_gradients_gather(t, w->norm);
    for (int k = 0; k < TED4_TERMS; k++)
        if (!isfinite(w->norm[k]))
            return bad_gradient(t, k, w->norm[k]);
    for (int k = 0; k < TED4_TERMS; k++) {
        times[k] = ted4_scale_take(&w->state.gradient[k], w->norm[k]);
        worst = times[k] > times[worst] ? k : worst;
    }
    return times[worst] > EXPLODED ? bad_gradient(t, worst, times[worst]) : 0;
}

/* Returns whether the screen has been nearly empty for ROW steps and the pictures got worse. If
 * they did not, the present number of Gaussians becomes the usual one. */
static int is_lost(ted4_monitor_state *w, double drawn, double usual, double loss)
{
    const double share = ted4_scale_take(&w->screen, drawn + 1.0);

    if (!(share > 0 && share < NEARLY_EMPTY)) {
        w->bad_screen = 0;
        return 0;
    }
    if (w->bad_screen++ == 0) {
        w->usual_loss = usual;
        w->lost = 0;
    }
    w->lost += loss / ROW;
    if (w->bad_screen < ROW)
        return 0;
    if (w->lost > LOST * w->usual_loss)
        return 1;
    memset(&w->screen, 0, sizeof w->screen);
    w->bad_screen = 0;
    return 0;
}

int ted4_monitor_look(ted4_trainer *t, double loss, const ted4_generate_input *in,
                      const ted4_splats *s)
{
    ted4_monitor_state *w = &t->monitor.state;

    note_phase(t);
    if (look_at_gradients(t) != 0)
        return -1;

    const double usual = ted4_scale_usual(&w->loss), high = ted4_scale_take(&w->loss, loss);

    w->bad_loss = high > DIVERGED && loss > HIGH_LOSS ? w->bad_loss + 1 : 0;
    if (is_lost(w, t->monitor.drawn, usual, loss))
        return collapsed(t, in, s);
    return w->bad_loss == ROW ? ted4_monitor_anomaly(t, "diverged", -1, "loss", "",
                                                     "is %.3g times what is usual", high)
                              : 0;
}

int ted4_monitor_calm(const ted4_trainer *t)
{
    return is_calm(&t->monitor.state);
}

void ted4_monitor_line(ted4_trainer *t)
{
    for (int k = 0; k < TED4_TERMS; k++)
        t->monitor.state.gradient[k].peak = 0;
}
