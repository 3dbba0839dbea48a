/* capacity_refine.c - bits of the prior's weights that are given back: see capacity.h. Trials coarsen weights when stage 2 is young, and it trains fine ones to its
 * last stage. What the prior has learnt by then, of the spans of anchors above all, takes more bits than what it knew when they were counted: a file of kitchen is a
 * tenth smaller with two to four bits more. Finer weights of the networks that draw were worth a ten-thousandth of the cost, less than it takes to look at them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "capacity.h"

/* Weights are made finer as long as each look lowers the cost, so many times at most; not at all where the budget of all trials is not ROOM times what this takes. */
enum { MOST_LOOKS = 4 };
#define ROOM 3.0

double ted4_capacity_refine_steps(const ted4_trainer *t)
{
    const double steps = (1 + MOST_LOOKS) * ted4_capacity_cost_steps(t);

    return ROOM * steps <= ted4_capacity_budget(t) ? steps : 0;
}

int ted4_capacity_refine(ted4_trainer *t)
{
    const ted4_move m = TED4_MOVE_PRIOR_BITS;
    ted4_cost       now;
    int             bad, on = ted4_capacity_refine_steps(t) > 0 && ted4_move_finer(t, m) > 0;

    t->decided = TED4_DECIDED_BITS;
    bad = on && ted4_capacity_cost(t, &now) != 0;
    for (int i = 0; !bad && on && i < MOST_LOOKS && ted4_move_finer(t, m) > 0; i++) {
        struct ted4_trial x = { .move = m, .from = ted4_move_now(t, m), .to = ted4_move_finer(t, m), .before = now };

        bad = ted4_move_make(t, m, (int)x.to) != 0 || ted4_capacity_cost(t, &x.after) != 0;
        on = !bad && x.after.cost < now.cost;
        x.taken = on;
        now = on ? x.after : now;
        if (!on)
            bad = bad || ted4_move_make(t, m, (int)x.from) != 0;
        bad = bad || ted4_capacity_note(t, &x) != 0;
    }
    return bad ? -1 : 0;
}
