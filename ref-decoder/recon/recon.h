/* recon.h - the state of a ted4_recon, and the steps of a query on one block of 32 anchors
 * (spec 11). Depends on base/arena.h, norm/syntax.h, recon/strict.h. Used inside recon/ only; the
 * public interface is ted4.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RECON_H
#define TED4_RECON_H

#include "base/arena.h"
#include "norm/syntax.h"
#include "recon/strict.h"

enum { TED4_POINT_INPUTS = 63, TED4_TIME_INPUTS = 21 }; /* sizes of E(p), E(t) of spec 11.3, inr */

/* The rows of a block, in order: each member is the number of a first row; comments give the number
 * of rows and their content. Values that do not depend on the query are computed in advance; since
 * each product of a formula is rounded by itself, this does not change results. */
typedef struct {
    unsigned position; /* 3: p */
    unsigned feature;  /* F: f */
    unsigned shift;    /* 3K: O_kj S_j */
    unsigned size;     /* 3: S_3 .. S_5 */
    unsigned tau;      /* 4: a_s, b_s, a_f, b_f with the lower bound of b applied; 0 without
                          activation */
    unsigned n;        /* number of rows */
} ted4_recon_rows;

/* Working memory for one chunk of blocks. The number of chunks does not depend on the number of
 * threads. */
typedef struct {
    float *seen;         /* [F + 3] input of heads: feature, view direction */
    float *moved;        /* [F + 3] the same with f' instead of f */
    float *point;        /* [3] p' */
    float *deform_in;    /* input of F_deform */
    float *hidden[2];    /* outputs of hidden layers, used alternately */
    float *y;            /* outputs of a network */
    float *value;        /* [7][K] values of the block's records */
    uint32_t *from, *to; /* [32 K] for each kept record: index into [K][32]; record number */
    uint32_t worst;      /* largest bit pattern, without sign, of the values written to records */
} ted4_recon_scratch;

struct ted4_recon {
    ted4_arena arena; /* owns all memory, including this structure */
    ted4_header head;
    ted4_net_shape net[TED4_NETS_R];
    ted4_strict_dense_fn dense;
    size_t n_netr, n_bank;
    float *netr, *bank;

    /* The lanes of blocks hold the static anchors first and then, beginning with a new block, the
     * moving ones. Unused lanes keep no offset. */
    size_t n_moving, n_static_blocks, n_blocks;
    uint32_t *anchor; /* [n_blocks 32] anchor number */
    uint32_t *first;  /* [n_blocks 32] number of the first record of the lane */
    uint16_t *kept;   /* [n_blocks 32] bit k: offset k is kept */
    ted4_recon_rows rows;
    float *block; /* [n_blocks][rows.n][32] */
    unsigned n_motion_rows;
    float *motion; /* [moving blocks][n_motion_rows][32]: phi or E(p) */

    float *time_in; /* [D] z of spec 11.2, or E(t) */
    float *opacity; /* [records] before activation; out.opacity without activation */
    ted4_gaussians out;
    size_t n_chunks;
    ted4_recon_scratch *scratch; /* [n_chunks] */

    /* 1: out holds the records of the last query. */
    int fresh;
    ted4_query last;
};

/* Bits for the results that have to be computed again for a block. */
enum {
    TED4_DO_MEAN = 1,
    TED4_DO_COVARIANCE = 2,
    TED4_DO_OPACITY = 4,
    TED4_DO_COLOUR = 8,
    TED4_DO_ACTIVATION = 16
};

/* The parts of a query that all blocks share. */
typedef struct {
    ted4_recon *r;
    float camera[3];  /* c' of spec 11.5 */
    float t;          /* time, 0 to 1 */
    float unit;       /* 2^e */
    unsigned todo[2]; /* TED4_DO_ bits for static blocks; for moving blocks */
} ted4_recon_job;

static inline float *ted4_recon_row(const ted4_recon *r, size_t block, unsigned row)
{
    return r->block + (block * r->rows.n + row) * TED4_ROW;
}

/* load.c: these fill lanes, blocks and motion rows from the scene. The arrays must have been
 * allocated. */
void ted4_recon_load_lanes(ted4_recon *r, const struct ted4_scene *s);
void ted4_recon_load_blocks(ted4_recon *r, const struct ted4_scene *s, const ted4_parallel *p);
/* Returns 1 if anchor i moves (spec 11.3), else 0. */
int ted4_recon_moves(const struct ted4_scene *s, size_t i);

/* network.c: computes y = network(x) by spec 7.1, for a block. */
void ted4_recon_network(const ted4_recon *r, int net, const float *x, ted4_recon_scratch *w,
                        float *y);

/* encode.c: encodes n coordinates X (spec 8) as n (1 + 2 * 10) values. */
void ted4_recon_encode(const int32_t *x, unsigned n, float *code);

/* motion.c: sets r->time_in for time num / den. */
void ted4_recon_set_time(ted4_recon *r, uint32_t num, uint32_t den);
/* motion.c: writes p' and f' of a moving block to w->point and w->moved. */
void ted4_recon_move(const ted4_recon *r, size_t block, ted4_recon_scratch *w);

/* heads.c: computes the records of a block, as far as q->todo says, from its rows. */
void ted4_recon_block(const ted4_recon_job *q, size_t block, ted4_recon_scratch *w);

#endif
