/* estimate.c - see estimate.h. Measured on the project's scenes with draft and fast, one thread and
 * two: a step takes as long as its anchors are many, and a quarter of the most that there may be on
 * top; a step of stage 2 takes a little longer. Trials count in steps, and take about what they
 * say.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "estimate.h"

#include <math.h>
#include <string.h>

#define FIXED       0.25 /* of the most anchors: what a step takes without any */
#define STAGE2      1.06
#define TRIALS      0.9  /* of a step of stage 2, what trials count as one */
#define LONGER      0.05 /* of what trials were believed to take, once they have taken it */
#define CODING      8.0  /* steps */
/* What is learnt of trials counts against this share of all of them, as first believed. */
#define BELIEF      0.1
/* Growth has filled what it may soon after it began; before, it is believed to fill it, and then
 * what there is tells. */
#define GROWN       0.04
#define STILL_GROWS 1.1
/* Units that the latest speed is averaged over; steps after which the first estimate is said, and
 * of which the first few do not count. */
#define MEMORY      300.0
/* A step that takes so many times its share was something else, too: multi-view seeding, say,
 * which does not come again. */
#define UNUSUAL     15.0
enum { READY = 100, WARMING = 5 };

void ted4_estimate_begin(ted4_estimate *e)
{
    memset(e, 0, sizeof *e);
    e->when = -1;
}

static double weight(const ted4_work *w, double anchors)
{
    return (anchors / fmax(w->most_anchors, 1.0) + FIXED) / (1.0 + FIXED);
}

/* Anchors once growth is done, before multi-view seeding. */
static double grown(const ted4_work *w)
{
    const double cap = (1.0 - w->mv_seed_share) * w->most_anchors;

    if (w->step > w->mv_seed_at * w->stage1)
        return w->anchors;
    if (w->step < (w->first_growth + GROWN) * w->stage1)
        return fmax(w->anchors, cap);
    return fmax(w->anchors, fmin(cap, STILL_GROWS * w->anchors));
}

/* Anchors from multi-view seeding on. */
static double after_mv_seed(const ted4_work *w)
{
    return w->step > w->mv_seed_at * w->stage1
               ? w->anchors
               : fmin(w->most_anchors, grown(w) / (1.0 - w->mv_seed_share));
}

/* Steps from one to another, from where training stands on. */
static double steps(const ted4_work *w, double from, double to)
{
    return fmax(to - fmax(from, w->step), 0.0);
}

/* Units of plain steps that are left. */
static double units_left(const ted4_work *w)
{
    const double grows = w->first_growth * w->stage1,
                 mv_seed_begin = fmax(w->mv_seed_at * w->stage1, grows);
    /* Of the probe's two branches one counts as training. */
    const double probe = w->probing && w->spent >= w->probe ? 0.0 : w->probe;

    return steps(w, 0, grows) * weight(w, w->anchors) +
           steps(w, grows, mv_seed_begin) * weight(w, grown(w)) +
           steps(w, mv_seed_begin, w->stage1) * weight(w, after_mv_seed(w)) +
           probe * weight(w, grown(w)) +
           (STAGE2 * steps(w, w->stage1, w->stage1 + w->stage2) + CODING) *
               weight(w, after_mv_seed(w));
}

/* Units of steps between two looks. */
static double units_between(const ted4_work *a, const ted4_work *b)
{
    const double n = b->probing && a->probing ? b->spent - a->spent : b->step - a->step;

    return n * weight(b, b->anchors) * (b->step > b->stage1 ? STAGE2 : 1.0);
}

static int in_trials(const ted4_work *w)
{
    return w->budget > 0 && !w->probing;
}

static void learn(ted4_estimate *e, double units, double seconds)
{
    const double left = exp(-units / MEMORY),
                 most = e->units > 0 ? UNUSUAL * units * e->clock / e->units : seconds;

    e->clock = left * e->clock + fmin(seconds, most);
    e->units = left * e->units + units;
}

void ted4_estimate_see(ted4_estimate *e, const ted4_work *w, double clock)
{
    const double seconds = clock - e->when;

    if (e->when < 0) {
        e->first = clock;
    } else if (in_trials(w) && in_trials(&e->last) && w->spent > e->last.spent) {
        e->trial_clock += seconds;
        e->trial_units += w->spent - e->last.spent;
    } else if (in_trials(w) == in_trials(&e->last) && units_between(&e->last, w) > 0 &&
               ++e->seen > WARMING) {
        learn(e, units_between(&e->last, w), seconds);
    }
    e->when = clock;
    e->last = *w;
}

void ted4_estimate_rewind(ted4_estimate *e, double clock)
{
    if (e->when >= 0)
        e->when = clock;
}

/* Seconds of what trials count as a step. */
static double trial_pace(const ted4_estimate *e, double pace)
{
    const double believed = BELIEF * (e->last.trials + e->last.budget) + 1.0;
    const double step = TRIALS * STAGE2 * pace * weight(&e->last, after_mv_seed(&e->last));

    return (step * believed + e->trial_clock) / (believed + e->trial_units);
}

double ted4_estimate_left(const ted4_estimate *e)
{
    const ted4_work *w = &e->last;

    if (!(e->units > 0))
        return -1;

    const double pace = e->clock / e->units;
    const double trials = w->trials +
                          (in_trials(w) ? fmax(w->budget - w->spent, LONGER * w->budget) : 0.0);

    return pace * units_left(w) + trial_pace(e, pace) * trials;
}

int ted4_estimate_ready(const ted4_estimate *e)
{
    return e->seen >= READY && e->units > 0;
}
