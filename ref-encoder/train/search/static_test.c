/* static_test.c - finds out whether the scene needs time: see static_test.h. Early in stage 1, the
 * trainer continues for a while unchanged, and then again from the same state, on the same
 * pictures, with the clock stopped: the networks keep their sizes, but every picture is rendered at
 * time 0, and everything is always active. If that is as good, motion and activation would only fit
 * noise. Training then starts again without them, so that the file is that of an encoder without
 * time, because anchors that grew while things could move are not those that a static scene needs.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "static_test.h"

#include "branch.h"
#include "train/model/header_from_options.h"
#include "train/monitor/checkpoint.h"
#include "train/step/trainer_init.h"

/* Time is kept if it lowers the mean loss by at least this share. Measured with 600 steps per
 * branch: -0.7 % on a static room with pictures of eight times, 10 to 17 % on moving scenes. */
#define WORTH 0.01
/* Minimum steps of a branch. Fewer would tell nothing, as the first half only lets the branches
 * settle. */
enum { FEWEST = 200 };

/* Share of stage 1 before the test: by then, the first anchors are in place. */
#define PROBE_FROM 0.25

int ted4_probe_due(const ted4_trainer *t)
{
    return !t->search.probed &&
           ted4_stage_position(t) == (uint64_t)(PROBE_FROM * (double)t->opt.stage1);
}

static int has_time(const ted4_trainer *t)
{
    return t->layout.head.motion != TED4_MOTION_NONE || t->layout.head.activation;
}

int ted4_probe_steps(const ted4_trainer *t)
{
    const int n = (int)(t->opt.probe * (double)t->opt.stage1);

    return t->search.probed || n < FEWEST || !has_time(t) ? 0 : n;
}

int ted4_static_test(ted4_trainer *t)
{
    const int n = ted4_probe_steps(t);
    ted4_snapshot start = { 0 }, with = { 0 };
    ted4_header h = t->layout.head;
    double timed = 0, still = 0;

    t->search.probed = 1;
    if (n == 0)
        return 0;
    ted4_header_without_motion(&h);
    h.activation = 0;

    int bad = ted4_snapshot_take(t, &start) != 0 || ted4_branch_run(t, n, &timed) != 0 ||
              ted4_snapshot_take(t, &with) != 0 || ted4_snapshot_restore(t, &start) != 0;

    t->phase.clock_stopped = 1;
    bad = bad || ted4_branch_run(t, n, &still) != 0;
    t->phase.clock_stopped = 0;
    if (!bad && timed < (1.0 - WORTH) * still)
        bad = ted4_snapshot_restore(t, &with) != 0;
    else if (!bad)
        bad = ted4_trainer_restart(t, &h) != 0;
    t->search.probe_loss[0] = timed;
    t->search.probe_loss[1] = still;
    ted4_snapshot_free(&start);
    ted4_snapshot_free(&with);
    return bad ? -1 : 0;
}
