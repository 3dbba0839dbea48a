/* events.c - see events.h. Source: paper, "Progressive 3D-to-4D Anchor Transformation"; annex D.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "events.h"

#include "pose_step.h"
#include "schedule.h"
#include "stages.h"
#include "train/densify/densify.h"
#include "train/densify/mv_seed.h"
#include "train/densify/still_anchors.h"

/* Share of stage 1 before the first adjustment of anchors. Statistics are gathered from step 0. */
#define GROW_FROM 0.05

/* Multi-view seeding takes place once static content is rendered well enough for everything else to
 * stand out, and before activation is learnt. With alternating cameras nothing else finds moving
 * things, so it precedes the probe. */
#define MV_SEED_AT             0.3
#define MV_SEED_AT_ALTERNATING 0.2

/* Share of stage 1 before still anchors are closed: most growth is over, and what is left of the
 * stage repairs what closing changed. */
#define CLOSE_AT 0.65

static uint64_t mv_seed_step(const ted4_trainer *t, int reach)
{
    return (uint64_t)((reach > 0 ? MV_SEED_AT_ALTERNATING : MV_SEED_AT) * (double)t->opt.stage1);
}

/* Returns whether multi-view seeding is still to come, so that anchors are reserved for it. */
static int mv_seed_ahead(const ted4_trainer *t)
{
    if (t->phase.stage2 || t->opt.sprouts <= 0 || t->iteration >= mv_seed_step(t, 0))
        return 0;

    const int reach = ted4_mv_seed_reach(t);

    return reach >= 0 && t->iteration < mv_seed_step(t, reach);
}

static int mv_seed_due(const ted4_trainer *t)
{
    if (t->phase.stage2 || t->opt.sprouts <= 0 ||
        (t->iteration != mv_seed_step(t, 0) && t->iteration != mv_seed_step(t, 1)))
        return 0;

    const int reach = ted4_mv_seed_reach(t);

    return reach >= 0 && t->iteration == mv_seed_step(t, reach);
}

void ted4_schedule_growth(const ted4_trainer *t, double *from, double *mv_seed_at,
                          double *mv_seed_share)
{
    const int reach = ted4_mv_seed_reach(t);

    *from = GROW_FROM;
    *mv_seed_at = reach > 0 ? MV_SEED_AT_ALTERNATING : MV_SEED_AT;
    *mv_seed_share = reach >= 0 ? t->opt.sprouts : 0.0;
}

size_t ted4_growth_allowance(const ted4_trainer *t)
{
    const size_t most =
        (size_t)((mv_seed_ahead(t) ? 1.0 - t->opt.sprouts : 1.0) * (double)t->opt.max_anchors);

    return t->anchors.n < most ? most - t->anchors.n : 0;
}

int ted4_integer_due(const ted4_trainer *t)
{
    const double first = (1.0 - t->opt.integer_share) * (double)t->opt.stage2;

    return t->phase.stage2 && !t->phase.integer &&
           t->iteration >= (uint64_t)t->opt.stage1 + (uint64_t)first;
}

int ted4_schedule_event(ted4_trainer *t)
{
    const ted4_train_options *o = &t->opt;
    const uint64_t i = t->iteration, stage1 = (uint64_t)o->stage1;

    ted4_poses_decide(t);
    if (t->layout.first[TED4_TAU] >= 0 && !t->phase.stage2 && i == ted4_activation_step(o) &&
        ted4_activation_begin(t) != 0)
        return -1;
    if (mv_seed_due(t) && ted4_mv_seed(t) != 0)
        return -1;
    if (!t->phase.stage2 && i > (uint64_t)(GROW_FROM * (double)stage1) &&
        i <= (uint64_t)(o->grow_until * (double)stage1) && i % (uint64_t)o->grow_every == 0 &&
        ted4_densify_adjust(t, ted4_growth_allowance(t)) != 0)
        return -1;
    if (!t->phase.stage2 && i == (uint64_t)(CLOSE_AT * (double)stage1) &&
        ted4_close_still_anchors(t) != 0)
        return -1;
    if (i == stage1 && !t->phase.stage2 && o->stage2 > 0 && ted4_stage2_begin(t) != 0)
        return -1;
    if (ted4_integer_due(t) && ted4_integer_begin(t) != 0)
        return -1;
    return 0;
}
