/* estimate.c - see estimate.h. The model of the cost was fitted on the project's scenes with the
 * presets draft and fast, on one thread and on two: the time of a step is proportional to the
 * number of its anchors plus a quarter of the permitted maximum, and steps of stage 2 take a little
 * longer. Trials count their work in steps, and take about the time of as many steps of training.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "estimate.h"

#include <math.h>
#include <string.h>

#define FIXED       0.25 /* fixed cost of a step, in shares of most_anchors */
#define STAGE2      1.06 /* cost of a step of stage 2, relative to stage 1 */
#define TRIALS      0.9  /* cost of one counted step of trials, relative to a step of stage 2 */
#define LONGER      0.05 /* least remaining share of the trials' budget, also after it is spent */
#define CODING      8.0  /* cost of coding the file, in steps */
/* The cost of trials is a weighted mean of the expected and the measured one. The weight of the
 * expected cost is this share of the steps of all trials. */
#define BELIEF      0.1
/* Growth reaches its limit soon after it begins. Until GROWN (a share of stage 1) after its begin,
 * the number of anchors is expected to reach the limit; later it is expected to grow at most by the
 * factor STILL_GROWS. */
#define GROWN       0.04
#define STILL_GROWS 1.1
/* The recent speed is an exponential average over about this many units: long enough that a second
 * or two of other work on the machine hardly changes it. */
#define MEMORY      1000.0
/* The time of a step counts at most as this multiple of its expected time: the rest was spent on
 * work that does not recur, such as seeding. */
#define UNUSUAL     15.0
/* Observations before the first estimate is printed; number of those that are ignored at first. */
enum { READY = 100, WARMING = 5 };

void ted4_estimate_begin(ted4_estimate *e)
{
    memset(e, 0, sizeof *e);
    e->when = -1;
}

/* Units of work of one step. */
static double weight(const ted4_work *w, double anchors)
{
    return (anchors / fmax(w->most_anchors, 1.0) + FIXED) / (1.0 + FIXED);
}

/* Expected number of anchors after growth and before seeding. */
static double grown(const ted4_work *w)
{
    const double cap = (1.0 - w->mv_seed_share) * w->most_anchors;

    if (w->step > w->mv_seed_at * w->stage1)
        return w->anchors;
    if (w->step < (w->first_growth + GROWN) * w->stage1)
        return fmax(w->anchors, cap);
    return fmax(w->anchors, fmin(cap, STILL_GROWS * w->anchors));
}

/* Expected number of anchors from seeding on. */
static double after_mv_seed(const ted4_work *w)
{
    return w->step > w->mv_seed_at * w->stage1
               ? w->anchors
               : fmin(w->most_anchors, grown(w) / (1.0 - w->mv_seed_share));
}

/* Steps of the range [from, to) that are not done yet. */
static double steps(const ted4_work *w, double from, double to)
{
    return fmax(to - fmax(from, w->step), 0.0);
}

/* Remaining units of plain steps and of coding. */
static double units_left(const ted4_work *w)
{
    const double grows = w->first_growth * w->stage1,
                 mv_seed_begin = fmax(w->mv_seed_at * w->stage1, grows);
    /* One of the probe's two branches counts as training, so only the other one is extra work. */
    const double probe = w->probing && w->spent >= w->probe ? 0.0 : w->probe;

    return steps(w, 0, grows) * weight(w, w->anchors) +
           steps(w, grows, mv_seed_begin) * weight(w, grown(w)) +
           steps(w, mv_seed_begin, w->stage1) * weight(w, after_mv_seed(w)) +
           probe * weight(w, grown(w)) +
           (STAGE2 * steps(w, w->stage1, w->stage1 + w->stage2) + CODING) *
               weight(w, after_mv_seed(w));
}

/* Units of steps between two observations. */
static double units_between(const ted4_work *a, const ted4_work *b)
{
    const double n = b->probing && a->probing ? b->spent - a->spent : b->step - a->step;

    return n * weight(b, b->anchors) * (b->step > b->stage1 ? STAGE2 : 1.0);
}

/* 1 if trials of the model search are under way. */
static int in_trials(const ted4_work *w)
{
    return w->budget > 0 && !w->probing;
}

/* Updates the recent speed. */
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

/* Seconds per counted step of trials. pace: seconds per unit. */
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
