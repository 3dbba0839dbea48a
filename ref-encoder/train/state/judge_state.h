/* judge_state.h - state of the judge that ends stages: a part of the trainer's state.
 * step/stage_judge.c writes it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_JUDGE_STATE_H
#define TED4_JUDGE_STATE_H

#include <stdint.h>

/* Groups of pictures that rest in turns. */
enum { TED4_JUDGE_GROUPS = 8 };

/* The part of the judge that checkpoints contain. */
typedef struct {
    uint64_t resting;  /* the group that rests, from 1; 0: none */
    uint64_t last;     /* the group of the last window that ended */
    uint64_t turn;     /* windows begun so far: whose turn it is to rest */
    uint64_t begin;    /* steps done when the present window began */
    uint64_t windows;  /* windows ended so far */
    uint64_t n;        /* changes since the stage began, or since steps were last left out */
    uint64_t left_out; /* steps that the end of the last window left out */
    /* Of each group, the loss after its last rest in this stage, in stage 2 with that of the rate;
     * 0: none. */
    double level[TED4_JUDGE_GROUPS];
    /* By how much that was less than the level before it, as a share; 0: not known. */
    double gain[TED4_JUDGE_GROUPS];
} ted4_judge_state;

typedef struct {
    uint8_t *group; /* owned, [n training pictures] group of each, from 1; NULL: no judge */
    ted4_judge_state state;
} ted4_judge;

#endif
