/* rate_parts.h - internals shared by the files of the rate model: packed networks, the workspace of
 * a chunk of visible blocks, and the steps between them. Depends on model.h. Private to the rate
 * model.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RATE_PARTS_H
#define TED4_RATE_PARTS_H

#include <stdatomic.h>

#include "base/arena.h"
#include "norm/prior.h"
#include "rate.h"

/* Visible blocks are processed in chunks of nearly equal size, each with its own sums. The chunks
 * of a wave run in parallel, and their sums are added in order. So results do not depend on the
 * number of threads, and memory does not grow with the number of visible blocks. If there are few
 * visible blocks, chunks become smaller so that a wave is still full, but never smaller than
 * TED4_RATE_LEAST, because each chunk adds a whole set of gradients. */
enum { TED4_RATE_CHUNK = 8, TED4_RATE_LEAST = 2 };

/* spec 10.1: the ranges of log2(sigma / step) and log2(q / Q0) that indices can express. */
#define TED4_S_MIN (-4.0f)
#define TED4_S_MAX (175.0f / 16.0f)
#define TED4_V_MIN (-4.0f)
#define TED4_V_MAX (127.0f / 32.0f)

typedef struct {
    int n; /* layers; 0 if the network does not exist */
    int dim[TED4_MAX_LAYERS + 1];
    size_t w[TED4_MAX_LAYERS],
        b[TED4_MAX_LAYERS]; /* indices in NETE of a layer's weights, biases */
    ted4_dense layer[TED4_MAX_LAYERS];
} ted4_rate_net;

/* Activations of the visible blocks of a chunk, and the gradients of all of them except the inputs:
 * x[i] is [CHUNK][dim[i]][32], and so is d[i]. */
typedef struct {
    float *x[TED4_MAX_LAYERS + 1], *d[TED4_MAX_LAYERS + 1];
} ted4_rate_acts;

/* Intermediate values of one visible block, forward and backward. A is the number of attribute
 * channels, that is, of all channels before the mask logits. */
typedef struct {
    float *value;    /* [A][32] raw values, 0 in unused lanes */
    float *residual; /* [A][32] n in k = x / q + n: noise, or the rounding difference; constant with
                        respect to gradients */
    float *d_symbol; /* [A][32] dL/dk */
    float *used;     /* [32] 1 if the lane is used and at least one offset is kept */
    float *dynamic;  /* [32] 1 if used and phi is coded */
    float *kept;     /* [K][32] 1 if used and the offset is coded */
    float *kept_bits; /* [K][32] bits of each offset, masked or not */
    float *phi_bits;  /* [32] */
    float *d_context; /* [F][32] */
} ted4_rate_block;

/* Workspace of one running chunk; a chunk takes any free one. */
typedef struct {
    float *storage; /* owned: memory of everything below */
    ted4_rate_acts hyper, slice[TED4_MAX_SLICES];
    float *context;   /* [CHUNK][F][32]: inputs of all slice networks */
    int32_t *integer; /* [P][64] outputs of the integer hyperprior */
    ted4_rate_block current;
    ted4_rate_sums *sums; /* of the current chunk */
} ted4_rate_workspace;

/* The integer networks, cached together with the weights that they were made from: those do not
 * change from step to step, and one thread has to convert them all. */
typedef struct {
    ted4_arena arena;
    ted4_prior prior;
    int ready;
    float *net;     /* owned: [n_nete] */
    uint8_t *shift; /* owned: [n_units] */
} ted4_rate_integer;

struct ted4_rate {
    ted4_layout layout;
    ted4_rate_net hyper, slice[TED4_MAX_SLICES];
    ted4_dense step;     /* the rows v of the hyperprior's last layer; the other rows are in
                            hyper.layer[n - 1] */
    size_t n_workspaces; /* entries of the three arrays below that can be used */
    ted4_rate_workspace workspace[TED4_RATE_WAVE];
    atomic_flag busy[TED4_RATE_WAVE];
    ted4_rate_sums sums[TED4_RATE_WAVE]; /* d_net is owned */
    ted4_rate_integer integer;
};

/* The arguments of a chunk besides the input. */
typedef struct {
    ted4_rate *rate;
    const ted4_rate_input *in;
    const float *const *d_value; /* may be NULL */
    float *const *d_attr;        /* NULL: no gradients */
    float *const *steps;         /* out: [TYPES][32] q of each visible block */
    size_t first, n_chunks;      /* first chunk of the wave; total number of chunks */
    size_t from;                 /* first chunk of the wave that this process evaluates */
    int steps_only;
    const ted4_rate_integer *integer; /* NULL: use the float networks only */
    float *lane_bits; /* out: [visible block][1 + K][32] bits of each anchor, then of each of its
                         offsets; NULL: not wanted */
} ted4_rate_job;

/* Returns whether bits of this type count; tau does not in the static phase. */
static inline int ted4_rate_coded(const ted4_rate_job *job, int type)
{
    return job->in->layout->shape.dim[type] > 0 && (type != TED4_TAU || job->in->activation);
}

/* rate_fwd.c: processes n visible blocks of a chunk, starting with the first. */
TED4_EACH_LEVEL(void, ted4_rate_chunk, const ted4_rate_job *job, ted4_rate_workspace *workspace,
                size_t first, size_t n);

/* rate_row.c */
TED4_EACH_LEVEL(void, ted4_rate_row, const float *u, const float *s, float *bits, float *d_u,
                float *d_s);

/* rate_integer.c: ted4_rate_integer_begin makes r->integer match the weights of the input. It
 * returns 0, or -1 if memory ran out or spec 7.3 rejects the weights. */
int ted4_rate_integer_begin(ted4_rate *r, const ted4_rate_input *in);
void ted4_rate_integer_end(ted4_rate_integer *x);

#endif
