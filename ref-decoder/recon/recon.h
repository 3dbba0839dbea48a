/* recon.h - spec 11: what a ted4_recon holds, and the steps of a query on one block of 32 anchors.
 * Depends on base/arena.h, norm/syntax.h, recon/strict.h. Used inside recon/ only; the public face
 * is ted4.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RECON_H
#define TED4_RECON_H

#include "base/arena.h"
#include "norm/syntax.h"
#include "recon/strict.h"

enum { TED4_POINT_INPUTS = 63, TED4_TIME_INPUTS = 21 }; /* of spec 11.3 inr: E(p), E(t) */

/* Rows of a block, in order. What no query changes is computed beforehand: products of a formula
 * are rounded one by one, so it does not matter when. */
typedef struct {
    unsigned position; /* 3: p */
    unsigned feature;  /* F: f */
    unsigned shift;    /* 3K: O_kj S_j */
    unsigned size;     /* 3: S_3 .. S_5 */
    unsigned tau;      /* 4: a_s, b_s, a_f, b_f with b as floored; none without activation */
    unsigned n;
} ted4_recon_rows;

/* Working rows of one chunk of blocks; so many chunks share the work whatever the number of
 * threads. */
typedef struct {
    float *seen;         /* [F + 3] input of heads: feature, view direction */
    float *moved;        /* [F + 3] the same with f' */
    float *point;        /* [3] p' */
    float *deform_in;    /* input of F_deform */
    float *hidden[2];    /* hidden layers in turn */
    float *y;            /* outputs of a network */
    float *value;        /* [7][K] values of the block's records */
    uint32_t *from, *to; /* [32 K] kept records: place in [K][32], record number */
    uint32_t worst;      /* largest bit pattern, without sign, among values put */
} ted4_recon_scratch;

struct ted4_recon {
    ted4_arena arena; /* owned: everything, this structure included */
    ted4_header head;
    ted4_net_shape net[TED4_NETS_R];
    ted4_strict_dense_fn dense;
    size_t n_netr, n_bank;
    float *netr, *bank;

    /* Lanes: static anchors first, then, from a new block on, those that move. Spare lanes keep no
     * offset. */
    size_t n_moving, n_static_blocks, n_blocks;
    uint32_t *anchor; /* [n_blocks 32] */
    uint32_t *first;  /* [n_blocks 32] number of the lane's first record */
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

    /* The records of the last query stand in out when fresh. */
    int fresh;
    ted4_query last;
};

/* What has to be done again for a block. */
enum {
    TED4_DO_MEAN = 1,
    TED4_DO_COVARIANCE = 2,
    TED4_DO_OPACITY = 4,
    TED4_DO_COLOUR = 8,
    TED4_DO_ACTIVATION = 16
};

/* One query: what all blocks need of it. */
typedef struct {
    ted4_recon *r;
    float camera[3]; /* c' of spec 11.5 */
    float t;
    float unit;       /* 2^e */
    unsigned todo[2]; /* TED4_DO_ of static blocks, of moving ones */
} ted4_recon_job;

static inline float *ted4_recon_row(const ted4_recon *r, size_t block, unsigned row)
{
    return r->block + (block * r->rows.n + row) * TED4_ROW;
}

/* load.c: fills lanes, blocks and motion rows from the scene. The arrays are in place. */
void ted4_recon_load_lanes(ted4_recon *r, const struct ted4_scene *s);
void ted4_recon_load_blocks(ted4_recon *r, const struct ted4_scene *s, const ted4_parallel *p);
/* Does anchor i move? spec 11.3 */
int ted4_recon_moves(const struct ted4_scene *s, size_t i);

/* network.c: y = network(x) by spec 7.1 */
void ted4_recon_network(const ted4_recon *r, int net, const float *x, ted4_recon_scratch *w,
                        float *y);

/* encode.c: n coordinates X (spec 8) to n (1 + 2 * 10) values. */
void ted4_recon_encode(const int32_t *x, unsigned n, float *code);

/* motion.c: time_in for a time; p' and f' of a moving block into w->point and w->moved. */
void ted4_recon_set_time(ted4_recon *r, uint32_t num, uint32_t den);
void ted4_recon_move(const ted4_recon *r, size_t block, ted4_recon_scratch *w);

/* heads.c: the todo of a block, from its rows to records. */
void ted4_recon_block(const ted4_recon_job *q, size_t block, ted4_recon_scratch *w);

#endif
