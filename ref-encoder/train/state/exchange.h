/* exchange.h - several processes, the ranks, that train one scene together. All have the same
 * state, and do the same steps; of the views of a step, each draws only some. What it finds out
 * about them goes to the others by the functions of this interface, so that the training does not
 * know by what means they talk (ref-encoder/mpi/). NULL for ted4_exchange * stands for a process
 * alone. Depends on nothing.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EXCHANGE_H
#define TED4_EXCHANGE_H

#include <stddef.h>
#include <stdint.h>

enum { TED4_MAX_RANKS = 64 };

/* All functions are collective: every rank calls the same ones in the same order. They return when
 * this rank has what it asked for; if another rank has died, they end the process. */
typedef struct {
    size_t rank, n;    /* number of this rank, of n; 1 to TED4_MAX_RANKS */
    size_t neighbours; /* ranks on this rank's machine, with itself */
    void *user;        /* borrowed: first argument of the functions */
    /* Gives all ranks the size bytes of each: rank r's are at all + r size. */
    void (*gather)(void *user, const void *mine, size_t size, void *all);
    /* Gives each rank its piece of the arrays of the first n_from ranks. Piece r of an array is
     * floats first[r] to first[r + 1], with first[n + 1]. from: the array of this rank, if it is
     * one of these ranks. to: [n_from][first[rank + 1] - first[rank]]. */
    void (*deal)(void *user, const float *from, const size_t *first, size_t n_from, float *to);
    /* Gives all ranks the whole array, of which each has its piece: all + first[rank]. */
    void (*share)(void *user, float *all, const size_t *first);
    /* For a rank that has to end: waits for the others, some seconds. Returns whether all have
     * called it. */
    int (*meet)(void *user);
    /* Ends all ranks with an exit status. Does not return. Not collective. */
    void (*end)(void *user, int status);
    uint64_t steps; /* training steps of which the views were shared */
    uint64_t bytes; /* payload that this rank has sent so far */
    double seconds; /* that it has spent in gather, deal and share, waiting for others included */
} ted4_exchange;

/* Sets first and end to the views of a step that this rank draws, of n. One view alone is drawn by
 * all ranks: nothing of it needs to be sent then. Otherwise ranks have 2^k views each, beginning
 * at a multiple, so that their sums are nodes of the tree of view_sums.h; the last ones may have
 * fewer, or none. */
void ted4_exchange_views(const ted4_exchange *x, size_t n, size_t *first, size_t *end);
/* Returns by how many ranks n views are drawn, one at least; these are the first ranks. */
size_t ted4_exchange_drawing(const ted4_exchange *x, size_t n);

/* These call the functions above, and count bytes. A process alone keeps what it has. */
void ted4_exchange_gather(ted4_exchange *x, const void *mine, size_t size, void *all);
void ted4_exchange_deal(ted4_exchange *x, const float *from, const size_t *first, size_t n_from,
                        float *to);
void ted4_exchange_share(ted4_exchange *x, float *all, const size_t *first);

/* Returns the first number that is not 0, by rank, of the numbers that all ranks give; 0: there is
 * none. */
int ted4_exchange_first(ted4_exchange *x, int number);

#endif
