/* static_test.c - does the scene need time at all? Early in stage 1 the trainer goes on for a while
 * as it is, then from the same point and through the same pictures with the clock stopped: all
 * networks keep their room, but every picture is drawn at time 0 and everything is always there. If
 * that is as good, motion and activation would only fit noise, and training begins again without
 * them, so that the file is the one of an encoder that knows no time: what grew while things could
 * move is not what a still scene needs. See static_test.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "static_test.h"

#include "branch.h"
#include "train/model/header_from_options.h"
#include "train/monitor/checkpoint.h"
#include "train/step/trainer_init.h"

/* Time stays when it lowers the mean loss by at least this share. Measured with 600 steps a branch:
 * a still room with pictures of eight times -0.7 %, moving scenes 10 to 17 %. */
#define WORTH 0.01
/* Fewer steps tell nothing; the first half of them lets both branches settle. */
enum { FEWEST = 200 };

/* It begins when the first anchors stand. */
#define PROBE_FROM 0.25

int ted4_probe_due(const ted4_trainer *t)
{
    return !t->search.probed && t->iteration == (uint64_t)(PROBE_FROM * (double)t->opt.stage1);
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
