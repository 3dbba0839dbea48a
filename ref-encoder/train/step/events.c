/* events.c - see events.h. Source: paper, "Progressive 3D-to-4D Anchor Transformation"; annex D.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "events.h"

#include "pose_step.h"
#include "schedule.h"
#include "stages.h"
#include "train/densify/densify.h"
#include "train/densify/mv_seed.h"
#include "train/densify/still_anchors.h"
#include "train/densify/sv_seed.h"
#include "train/state/arrangement.h"

/* Share of stage 1 before the first adjustment of anchors. Statistics are gathered from step 0. */
#define GROW_FROM 0.05

/* Seeding takes place once static content is rendered well enough for everything else to stand out,
 * and before activation is learnt. If no frame has enough cameras, nothing else finds moving
 * things: then it precedes the probe, and comes early, because anchors that stand still learn to
 * imitate what moves, as a blur that new anchors do not undo. */
#define SEED_AT             0.3
#define SEED_AT_SINGLE_VIEW 0.1

/* Share of stage 1 before still anchors are closed: most growth is over, and what is left of the
 * stage repairs what closing changed. */
#define CLOSE_AT 0.65

/* Lives and masks change slowly, so that the order of anchors is renewed now and then only. */
enum { ARRANGE_EVERY = 500 };

static double seed_at(const ted4_trainer *t)
{
    return ted4_sv_seed_applies(t) ? SEED_AT_SINGLE_VIEW : SEED_AT;
}

/* Returns a step of stage 1. */
static uint64_t stage1_step(const ted4_trainer *t, double at)
{
    return (uint64_t)(at * (double)t->opt.stage1);
}

/* Returns the step of stage 2 with which the integer stage begins. */
static uint64_t integer_step(const ted4_trainer *t)
{
    return (uint64_t)((1.0 - t->opt.integer_share) * (double)t->opt.stage2);
}

/* Returns whether the scene gets new anchors by one of the two kinds of seeding. */
static int has_seeding(const ted4_trainer *t)
{
    return t->opt.sprouts > 0 && (ted4_mv_seed_applies(t) || ted4_sv_seed_applies(t));
}

/* Returns whether seeding is still to come, so that anchors are reserved for it. */
static int seeding_ahead(const ted4_trainer *t)
{
    return !t->phase.stage2 && ted4_stage_position(t) < stage1_step(t, SEED_AT) && has_seeding(t) &&
           ted4_stage_position(t) < stage1_step(t, seed_at(t));
}

static int seeding_due(const ted4_trainer *t)
{
    const uint64_t now = ted4_stage_position(t);

    if (t->phase.stage2 ||
        (now != stage1_step(t, SEED_AT) && now != stage1_step(t, SEED_AT_SINGLE_VIEW)))
        return 0;
    return has_seeding(t) && now == stage1_step(t, seed_at(t));
}

ted4_growth ted4_schedule_growth(const ted4_trainer *t)
{
    const ted4_growth g = { .from = GROW_FROM,
                            .seed_at = seed_at(t),
                            .seed_share = has_seeding(t) ? t->opt.sprouts : 0.0 };

    return g;
}

/* Returns by how many anchors the model may grow, up to a share of max_anchors. */
static size_t allowance(const ted4_trainer *t, double share)
{
    const size_t most = (size_t)(share * (double)t->opt.max_anchors);

    return t->anchors.n < most ? most - t->anchors.n : 0;
}

size_t ted4_growth_allowance(const ted4_trainer *t)
{
    return allowance(t, seeding_ahead(t) ? 1.0 - t->opt.sprouts : 1.0);
}

static int seed(ted4_trainer *t)
{
    return ted4_mv_seed_applies(t) ? ted4_mv_seed(t) : ted4_sv_seed(t, allowance(t, 1.0));
}

int ted4_integer_due(const ted4_trainer *t)
{
    return t->phase.stage2 && !t->phase.integer && ted4_stage_position(t) >= integer_step(t);
}

int ted4_schedule_event(ted4_trainer *t)
{
    const ted4_train_options *o = &t->opt;
    const uint64_t i = ted4_stage_position(t), stage1 = (uint64_t)o->stage1;

    ted4_poses_decide(t);
    if (t->layout.first[TED4_TAU] >= 0 && !t->phase.stage2 && i == ted4_activation_step(o) &&
        ted4_activation_begin(t) != 0)
        return -1;
    if (seeding_due(t) && seed(t) != 0)
        return -1;
    if (!t->phase.stage2 && i > (uint64_t)(GROW_FROM * (double)stage1) &&
        i <= (uint64_t)(o->grow_until * (double)stage1) && i % (uint64_t)o->grow_every == 0 &&
        ted4_densify_adjust(t, ted4_growth_allowance(t)) != 0)
        return -1;
    if (!t->phase.stage2 && i == (uint64_t)(CLOSE_AT * (double)stage1) &&
        (ted4_close_still_anchors(t) != 0 || ted4_arrange_anchors(t) != 0))
        return -1;
    if (ted4_at_stage1_end(t) && o->stage2 > 0 && ted4_stage2_begin(t) != 0)
        return -1;
    if (ted4_integer_due(t) && ted4_integer_begin(t) != 0)
        return -1;
    return i % ARRANGE_EVERY == 0 ? ted4_arrange_anchors(t) : 0;
}
