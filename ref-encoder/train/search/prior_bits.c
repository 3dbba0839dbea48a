/* prior_bits.c - gives back bits of the prior's weights: see prior_bits.h. Trials choose coarse
 * weights early in stage 2, but up to the integer stage training uses fine ones. What the prior has
 * learnt by then, mainly about the spans of anchors, needs more bits than what it knew at the time
 * of the trials: refinement makes files of kitchen 5 to 11 % smaller. Finer weights of the
 * reconstruction networks gained one or two ten-thousandths of the cost, less than their trials
 * cost.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "prior_bits.h"

#include "candidates.h"
#include "file_cost.h"

/* Number of finer grids to try. Trials do not stop at the first failure, as a grid may be worse
 * than the one before it, and the next one better than both. */
enum { MOST_TRIALS = 4 };

double ted4_refine_prior_bits_steps(const ted4_trainer *t)
{
    return ted4_search_afford(t, (1 + MOST_TRIALS) * ted4_file_cost_steps(t));
}

int ted4_refine_prior_bits(ted4_trainer *t)
{
    const ted4_candidate m = TED4_CANDIDATE_PRIOR_BITS;
    int best = ted4_candidate_now(t, m), to = ted4_candidate_finer(t, m), bad;
    ted4_cost least = { 0 };

    t->search.decided = TED4_DECIDED_BITS;
    if (to < 0 || !(ted4_refine_prior_bits_steps(t) > 0))
        return 0;
    bad = ted4_file_cost(t, &least) != 0;
    for (int i = 0; !bad && i < MOST_TRIALS && to > 0; i++) {
        struct ted4_trial x = { .candidate = m, .from = best, .to = to, .before = least };

        bad = ted4_candidate_make(t, m, to) != 0 || ted4_file_cost(t, &x.after) != 0;
        x.taken = !bad && x.after.cost < least.cost;
        if (x.taken) {
            best = to;
            least = x.after;
        }
        bad = bad || ted4_search_note(t, &x) != 0;
        to = ted4_candidate_finer(t, m);
    }
    return bad || ted4_candidate_make(t, m, best) != 0 ? -1 : 0;
}
