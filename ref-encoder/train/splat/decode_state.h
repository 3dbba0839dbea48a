/* decode_state.h - what ted4_generate keeps for ted4_generate_backward: the plan of planes,
 * packed weights, saved activations. A plane is one channel of 32 lanes. Private to this folder, of
 * which generator.c, net.c and deform_time.c are compiled once and the other files once per level.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DECODE_STATE_H
#define TED4_DECODE_STATE_H

#include "generator.h"

/* Work is cut into this many chunks of visible blocks whatever the number of threads, so that sums
 * over visible blocks have one order. Within a chunk, weight gradients are taken over groups of
 * visible blocks, few enough to stay in the second-level cache. */
enum { TED4_GEN_CHUNKS = 32, TED4_GEN_GROUP = 8 };

/* Motion inr, spec 11.3: inputs made of the position and of the time. */
enum {
    TED4_INR_OCTAVES = 10,
    TED4_INR_POINT = 3 + 6 * TED4_INR_OCTAVES,
    TED4_INR_TIME = 1 + 2 * TED4_INR_OCTAVES
};

/* Arrays of ted4_splats, in the order of its members. */
enum {
    TED4_GEN_MEAN,
    TED4_GEN_SCALE = 3,
    TED4_GEN_ROT = 6,
    TED4_GEN_OPACITY = 10,
    TED4_GEN_COLOUR = 11,
    TED4_GEN_ARRAYS = 14
};

/* One dense layer: input and output planes of a visible block, where W and then b lie in NETR,
 * where their gradients lie in a chunk's gradient array. */
typedef struct {
    ted4_dense dense;
    int x, y;
    size_t net, grad;
} ted4_gen_layer;

typedef struct {
    int n; /* 0: the network does not exist */
    ted4_gen_layer layer[TED4_MAX_LAYERS];
} ted4_gen_chain;

/* Planes of a visible block. Members are first planes; -1: absent. The attribute block is copied,
 * feature apart, with 0 in unused lanes. */
typedef struct {
    int feature, view; /* F, then 3: the input of heads that see f (and the direction) */
    int rest;          /* channels F .. of the block */
    int point;         /* inr: 63 encoded coordinates */
    int moved;         /* f' (F), then 3 when view is full: the input of the covariance
                        * head; = feature when nothing moves */
    int size;          /* S: 6 */
    int active;        /* A: 1 */
    int moving;        /* 1.0 where the anchor moves: 1 */
    int outputs;       /* the outputs of all layers, chain by chain */
    int motion;        /* last layer of F_deform: y */
    int opacity;       /* of the opacity head: 2 sigmoid(2 y) - 1 */
    int covariance;    /* of the covariance head: 3 sigmoids, 4 y, K times */
    int colour;        /* of the colour head: sigmoids */
    int n;
} ted4_gen_planes;

/* The first layer of F_deform is replaced by one that maps the lane's own inputs: everything that
 * is the same for all anchors at one time is multiplied into it (deform_time.c). */
typedef struct {
    int in, width;        /* effective layer: d or 63 inputs */
    int n_time;           /* length of z or E(t) */
    float *time, *d_time; /* [n_time] owned: z or E(t) */
    float *w, *b;         /* [width][in], [width] owned: effective weights */
    float *d_w;           /* [width][in], then [width] owned: their gradient */
    float *product;       /* [n_time][in + 1] owned: scratch of motion bank */
    size_t row;           /* of the bank: z = (1 - mix) Z[row] + mix Z[row + 1] */
    float mix;
} ted4_gen_motion;

struct ted4_generator {
    ted4_layout layout;
    ted4_gen_planes plane;
    ted4_gen_chain chain[TED4_NETS_R]; /* that of F_project is never used */
    ted4_gen_motion motion;
    size_t n_effective; /* floats of the effective layer */
    size_t net_tail;    /* NETR offset of the layer after it */
    size_t n_grad;      /* floats of a chunk's gradients: effective layer, then
                         * NETR from net_tail on */
    float *grad;        /* [TED4_GEN_CHUNKS][n_grad] owned */
    size_t d_size;      /* floats of the gradients of one visible block's layer outputs */
    size_t d_chunk;     /* floats of one chunk's scratch: TED4_GEN_GROUP of those,
                         * then d_feature, d_moved (F + 3 planes each) */
    float *d_planes;    /* [TED4_GEN_CHUNKS][d_chunk] owned */
    size_t capacity;    /* visible blocks there is room for */
    float *saved;       /* [capacity][plane.n][32] owned */
    float *splats;      /* [TED4_GEN_ARRAYS][capacity K 32] owned */
};

/* What both ways over the visible blocks are told. */
typedef struct {
    ted4_generator *g;
    const ted4_generate_input *in;
    const ted4_splat_grads *gr;
    float *const *d_attr;
    float *d_net;
} ted4_gen_job;

/* n floats, 64-byte aligned; NULL: no memory. */
float *ted4_gen_alloc(size_t n);

/* net.c: makes the plan, the layers and everything whose size does not depend on the
 * number of visible blocks. 0 or -1. */
int ted4_gen_plan(ted4_generator *g);

/* deform_time.c. 0, or -1: no memory. */
int ted4_gen_motion_init(ted4_gen_motion *m, const ted4_layout *l);
void ted4_gen_motion_finish(ted4_gen_motion *m);
/* Interpolates the bank or encodes the time, and makes the effective layer. */
void ted4_gen_motion_make(ted4_generator *g, const ted4_generate_input *in);
/* motion inr: E(p) of 32 points, [3][32] to [63][32]. */
void ted4_gen_encode_points(const float *position, float *to);

/* decode_fwd.c: a ted4_gen_job for one visible block. decode_bwd.c: for the visible blocks of a
 * chunk; after all chunks, the sums of a range of gradients. */
TED4_EACH_LEVEL(void, ted4_gen_forward, void *job, size_t visible);
TED4_EACH_LEVEL(void, ted4_gen_backward, void *job, size_t chunk);
TED4_EACH_LEVEL(void, ted4_gen_sum_range, void *job, size_t range);

/* effective_layer.c. Of the motion bank: w has n_time columns, p n_time rows; else w has in +
 * n_time columns. */
TED4_EACH_LEVEL(void, ted4_gen_make_effective, ted4_gen_motion *m, int is_bank, const float *w,
                const float *p);
/* Takes motion.d_w back to F_project, the first layer of F_deform and the bank: adds to d_net. */
TED4_EACH_LEVEL(void, ted4_gen_motion_backward, ted4_generator *g, const float *net, float *d_net);

static inline size_t ted4_gen_stride(const ted4_generator *g)
{
    return (size_t)g->plane.n * TED4_LANES;
}

static inline float *ted4_gen_saved(const ted4_generator *g, size_t visible)
{
    return g->saved + visible * ted4_gen_stride(g);
}

static inline float *ted4_gen_plane(float *planes, int plane)
{
    return planes + (size_t)plane * TED4_LANES;
}

/* The saved copy of channel c of the attribute block. */
static inline float *ted4_gen_channel(const ted4_generator *g, float *planes, int c)
{
    const int f = g->layout.head.feature_dim;

    return ted4_gen_plane(planes, c < f ? g->plane.feature + c : g->plane.rest + c - f);
}

/* Splat array a (mean 3, scale 3, rotation 4, opacity, colour 3) from offset 0 of a visible block
 * on. */
static inline float *ted4_gen_splats(const ted4_generator *g, int a, size_t visible)
{
    const size_t row = (size_t)g->layout.head.n_offsets * TED4_LANES;

    return g->splats + ((size_t)a * g->capacity + visible) * row;
}

/* First visible block of a chunk. */
static inline size_t ted4_gen_first(size_t n_visible, size_t chunk)
{
    return n_visible * chunk / TED4_GEN_CHUNKS;
}

static inline int ted4_gen_activated(const ted4_generator *g, const ted4_generate_input *in)
{
    return in->activation && g->layout.first[TED4_TAU] >= 0;
}

#endif
