/* weight_bits.c - see weight_bits.h. Measured in bench/compact.md: full precision makes files 4 to
 * 9 % larger, for 0.005 dB.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "weight_bits.h"

#include "candidates.h"
#include "file_cost.h"

/* Trials of a grid: 12, 10, 8, 6, 5 and 4 bits. They stop after PATIENCE failures in a row, not
 * after the first, as a grid may be worse than the one before it, and the next one better than
 * both. */
enum { LEAST_BITS = 4, PATIENCE = 2, MOST_TRIALS = 6 * TED4_WEIGHT_GRIDS };

double ted4_coarsen_weights_steps(const ted4_trainer *t)
{
    if (t->opt.profile != TED4_PROFILE_COMPACT || t->opt.capacity)
        return 0;
    return ted4_search_afford(t, (1 + MOST_TRIALS) * ted4_file_cost_steps(t));
}

/* Makes one grid coarser, and updates the least cost. Returns 0, or -1 with t->message. */
static int coarsen(ted4_trainer *t, ted4_candidate m, ted4_cost *least)
{
    int best = ted4_candidate_now(t, m), failed = 0;

    for (int to = best; best > 0 && failed < PATIENCE;) {
        struct ted4_trial x = { .candidate = m, .from = best, .before = *least };

        if ((to = ted4_candidate_next(t, m, 0)) < LEAST_BITS)
            break;
        x.to = to;
        if (ted4_candidate_make(t, m, to) != 0 || ted4_file_cost(t, &x.after) != 0)
            return -1;
        x.taken = x.after.cost < least->cost;
        failed = x.taken ? 0 : failed + 1;
        if (x.taken) {
            best = to;
            *least = x.after;
        }
        if (ted4_search_note(t, &x) != 0)
            return -1;
    }
    return best > 0 ? ted4_candidate_make(t, m, best) : 0;
}

int ted4_coarsen_weights(ted4_trainer *t)
{
    const int affordable = ted4_coarsen_weights_steps(t) > 0;
    ted4_cost least;

    t->search.decided = TED4_DECIDED_ALL;
    if (!affordable)
        return 0;
    if (ted4_file_cost(t, &least) != 0)
        return -1;
    for (ted4_candidate m = TED4_CANDIDATE_HEAD_BITS; m <= TED4_CANDIDATE_PRIOR_BITS; m++)
        if (coarsen(t, m, &least) != 0)
            return -1;
    return 0;
}
