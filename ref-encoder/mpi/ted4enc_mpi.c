/* ted4enc_mpi.c - ted4enc with several processes: mpirun -n N ted4enc-mpi SCENE ... The exchange
 * between them (train/state/exchange.h) by MPI.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "tool/cli.h"
#include "tool/encode_main.h"

/* Seconds that a rank which has to end waits for the others to end, too. */
#define MEET_WITHIN 3.0

/* The communicators, and arguments of collective calls. */
typedef struct {
    MPI_Comm work, end; /* end: for the meeting alone */
    ted4_exchange *exchange;
    int from_n[TED4_MAX_RANKS], from_at[TED4_MAX_RANKS]; /* floats */
    int to_n[TED4_MAX_RANKS], to_at[TED4_MAX_RANKS];
} ranks;

static void gather(void *user, const void *mine, size_t size, void *all)
{
    ranks *r = user;
    const double begin = MPI_Wtime();

    MPI_Allgather(mine, (int)size, MPI_BYTE, all, (int)size, MPI_BYTE, r->work);
    r->exchange->seconds += MPI_Wtime() - begin;
}

static void deal(void *user, const float *from, const size_t *first, size_t n_from, float *to)
{
    ranks *r = user;
    const ted4_exchange *x = r->exchange;
    const size_t own = first[x->rank + 1] - first[x->rank];
    const double begin = MPI_Wtime();

    for (size_t i = 0; i < x->n; i++) {
        r->from_n[i] = x->rank < n_from ? (int)(first[i + 1] - first[i]) : 0;
        r->from_at[i] = (int)first[i];
        r->to_n[i] = i < n_from ? (int)own : 0;
        r->to_at[i] = i < n_from ? (int)(i * own) : 0;
    }
    MPI_Alltoallv(from, r->from_n, r->from_at, MPI_FLOAT, to, r->to_n, r->to_at, MPI_FLOAT,
                  r->work);
    r->exchange->seconds += MPI_Wtime() - begin;
}

static void share(void *user, float *all, const size_t *first)
{
    ranks *r = user;
    const ted4_exchange *x = r->exchange;
    const double begin = MPI_Wtime();

    for (size_t i = 0; i < x->n; i++) {
        r->to_n[i] = (int)(first[i + 1] - first[i]);
        r->to_at[i] = (int)first[i];
    }
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all, r->to_n, r->to_at, MPI_FLOAT, r->work);
    r->exchange->seconds += MPI_Wtime() - begin;
}

static int meet(void *user)
{
    ranks *r = user;
    const double begin = MPI_Wtime();
    const struct timespec pause = { .tv_nsec = 1000000 };
    MPI_Request request;
    int done = 0;

    MPI_Ibarrier(r->end, &request);
    while (MPI_Test(&request, &done, MPI_STATUS_IGNORE) == MPI_SUCCESS && !done &&
           MPI_Wtime() - begin < MEET_WITHIN)
        nanosleep(&pause, NULL);
    return done;
}

static void end(void *user, int status)
{
    ranks *r = user;

    fflush(NULL);
    MPI_Abort(r->work, status);
    abort();
}

/* Fills *x for the ranks of this run. Returns 0, or -1: they are too many. */
static int begin_ranks(ranks *r, ted4_exchange *x)
{
    MPI_Comm machine;
    int rank, n, neighbours;

    MPI_Comm_dup(MPI_COMM_WORLD, &r->work);
    MPI_Comm_dup(MPI_COMM_WORLD, &r->end);
    MPI_Comm_rank(r->work, &rank);
    MPI_Comm_size(r->work, &n);
    MPI_Comm_split_type(r->work, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &neighbours);
    MPI_Comm_free(&machine);
    *x = (ted4_exchange) { .rank = (size_t)rank,
                           .n = (size_t)n,
                           .neighbours = (size_t)neighbours,
                           .user = r,
                           .gather = gather,
                           .deal = deal,
                           .share = share,
                           .meet = meet,
                           .end = end };
    r->exchange = x;
    return n <= TED4_MAX_RANKS ? 0 : -1;
}

int main(int argc, char **argv)
{
    static ranks r;
    ted4_exchange x;
    int level, status = TED4_EXIT_TOOL;

    /* Other threads, as that of the status line, do not talk to other ranks. */
    if (MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level) != MPI_SUCCESS)
        return TED4_EXIT_TOOL;
    if (begin_ranks(&r, &x) == 0)
        status = ted4_encoder_main(argc, argv, x.n > 1 ? &x : NULL);
    else if (x.rank == 0)
        fprintf(stderr, "ted4enc: at most %d ranks\n", TED4_MAX_RANKS);
    MPI_Finalize();
    return status;
}
