/* decode_state.h - what ted4_generate keeps for ted4_generate_backward: the layout of planes,
 * packed weights, and saved activations. A plane is one channel of 32 lanes. Private to this
 * folder, in which generator.c, net.c and deform_time.c are compiled once, and the other files once
 * per level.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DECODE_STATE_H
#define TED4_DECODE_STATE_H

#include "generator.h"

/* Within a chunk, weight gradients are computed over groups of so many visible blocks, small enough
 * to stay in the second-level cache. */
enum { TED4_GEN_GROUP = 8 };

/* Motion type inr, spec 11.3: numbers of inputs derived from the position and from the time. */
enum {
    TED4_INR_OCTAVES = 10,
    TED4_INR_POINT = 3 + 6 * TED4_INR_OCTAVES,
    TED4_INR_TIME = 1 + 2 * TED4_INR_OCTAVES
};

/* Indices of the arrays of ted4_splats, in the order of its members. */
enum {
    TED4_GEN_MEAN,
    TED4_GEN_SCALE = 3,
    TED4_GEN_ROT = 6,
    TED4_GEN_OPACITY = 10,
    TED4_GEN_COLOUR = 11,
    TED4_GEN_ARRAYS = 14
};

/* One dense layer: its input and output planes in a visible block; the index in NETR of W, followed
 * by b; and the index of their gradients in a chunk's gradient array. */
typedef struct {
    ted4_dense dense;
    int x, y;
    size_t net, grad;
} ted4_gen_layer;

typedef struct {
    int n; /* 0: the network does not exist */
    ted4_gen_layer layer[TED4_MAX_LAYERS];
} ted4_gen_chain;

/* Planes of a visible block. Each member is the index of the first plane; -1: absent. The attribute
 * block is copied, with the feature kept apart from the rest and with 0 in unused lanes. */
typedef struct {
    int feature, view; /* F, then 3: the input of heads that see f (and the viewing direction) */
    int rest;          /* channels F .. of the block */
    int point;         /* inr: 63 encoded coordinates */
    int moved;   /* f' (F), then 3 if view is full: the input of the covariance head; equals feature
                    if nothing moves */
    int size;    /* S: 6 */
    int active;  /* A: 1 */
    int moving;  /* 1: 1.0 if the anchor moves */
    int outputs; /* outputs of all layers, chain by chain */
    int motion;  /* output y of the last layer of F_deform */
    int opacity; /* output of the opacity head: 2 sigmoid(2 y) - 1 */
    int covariance; /* output of the covariance head: 3 sigmoids, then 4 y; K times */
    int colour;     /* output of the colour head: sigmoids */
    int n;
} ted4_gen_planes;

/* The first layer of F_deform is replaced by an effective layer that maps only the lane's own
 * inputs: everything that is the same for all anchors at one time is multiplied into it
 * (deform_time.c). */
typedef struct {
    int in, width;        /* inputs of the effective layer (d or 63), and its outputs */
    int n_time;           /* length of z or E(t) */
    float *time, *d_time; /* [n_time] owned: z or E(t), and its gradient */
    float *w, *b;   /* [width][in], [width] owned: weights and biases of the effective layer */
    float *d_w;     /* [width][in], then [width] owned: their gradients */
    float *product; /* [n_time][in + 1] owned: scratch, for motion type bank */
    size_t row;     /* of the bank: z = (1 - mix) Z[row] + mix Z[row + 1] */
    float mix;
} ted4_gen_motion;

struct ted4_generator {
    ted4_layout layout;
    ted4_gen_planes plane;
    ted4_gen_chain chain[TED4_NETS_R]; /* the chain of F_project is never used */
    ted4_gen_motion motion;
    size_t n_effective; /* floats of the effective layer */
    size_t net_tail;    /* NETR offset of the layer after the effective one */
    size_t n_grad; /* floats of a chunk's gradients: the effective layer, then NETR from net_tail */
    float *grad;   /* [TED4_GEN_CHUNKS][n_grad] owned */
    float d_camera[TED4_GEN_CHUNKS][3]; /* gradient of the camera's centre, by chunk; then, in
                                           chunk 0, the sum */
    size_t d_size;   /* floats of the gradients of one visible block's layer outputs */
    size_t d_chunk;  /* floats of one chunk's scratch: TED4_GEN_GROUP times d_size, then d_feature
                        and d_moved (F + 3 planes each) */
    float *d_planes; /* [TED4_GEN_CHUNKS][d_chunk] owned */
    size_t capacity; /* number of visible blocks that fit */
    float *saved;    /* [capacity][plane.n][32] owned */
    float *splats;   /* [TED4_GEN_ARRAYS][capacity K 32] owned */
    float *shown;    /* [capacity K 32] owned: opacities of one of several views */
};

/* The arguments of the forward and the backward pass over the visible blocks. */
typedef struct {
    ted4_generator *g;
    const ted4_generate_input *in;
    const ted4_splat_grads *gr;
    float *const *d_attr;
    float *view_sum; /* colours of one of several views: their gradients */
    size_t first;    /* backward pass: the chunk of job 0 */
} ted4_gen_job;

/* Returns n floats, 64-byte aligned, or NULL if memory ran out. Free with free(). */
float *ted4_gen_alloc(size_t n);

/* net.c: plans the planes and layers, and allocates everything whose size does not depend on the
 * number of visible blocks. Returns 0 or -1. */
int ted4_gen_plan(ted4_generator *g);

/* deform_time.c: returns 0, or -1 if memory ran out. */
int ted4_gen_motion_init(ted4_gen_motion *m, const ted4_layout *l);
void ted4_gen_motion_finish(ted4_gen_motion *m);
/* Interpolates the bank or encodes the time, and makes the effective layer. */
void ted4_gen_motion_make(ted4_generator *g, const ted4_generate_input *in);
/* Motion type inr: computes E(p) of 32 points, from [3][32] to [63][32]. */
void ted4_gen_encode_points(const float *position, float *to);

/* job is a ted4_gen_job. decode_fwd.c: ted4_gen_forward processes one visible block. decode_bwd.c:
 * ted4_gen_backward processes the visible blocks of a chunk; ted4_gen_sum_range, after all chunks,
 * sums a range of the gradients into the array of chunk 0. */
TED4_EACH_LEVEL(void, ted4_gen_forward, void *job, size_t visible);
TED4_EACH_LEVEL(void, ted4_gen_backward, void *job, size_t k);
TED4_EACH_LEVEL(void, ted4_gen_sum_range, void *job, size_t range);

/* view_colours.c: the same for the colours of one of several views. */
TED4_EACH_LEVEL(void, ted4_gen_view_forward, void *job, size_t visible);
TED4_EACH_LEVEL(void, ted4_gen_view_backward, void *job, size_t chunk);

/* effective_layer.c: computes the effective layer. For motion type bank, w has n_time columns and p
 * has n_time rows; otherwise, w has in + n_time columns and p is not used. */
TED4_EACH_LEVEL(void, ted4_gen_make_effective, ted4_gen_motion *m, int is_bank, const float *w,
                const float *p);
/* Backpropagates motion.d_w to F_project, the first layer of F_deform and the bank; adds to
 * d_net. */
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

/* Returns the saved copy of channel c of the attribute block. */
static inline float *ted4_gen_channel(const ted4_generator *g, float *planes, int c)
{
    const int f = g->layout.head.feature_dim;

    return ted4_gen_plane(planes, c < f ? g->plane.feature + c : g->plane.rest + c - f);
}

/* Returns splat array a (mean 3, scale 3, rotation 4, opacity, colour 3) of a visible block,
 * starting at its offset 0. */
static inline float *ted4_gen_splats(const ted4_generator *g, int a, size_t visible)
{
    const size_t row = (size_t)g->layout.head.n_offsets * TED4_LANES;

    return g->splats + ((size_t)a * g->capacity + visible) * row;
}

/* Returns the first visible block of a chunk. */
static inline size_t ted4_gen_first(size_t n_visible, size_t chunk)
{
    return n_visible * chunk / TED4_GEN_CHUNKS;
}

/* Returns the index of the colour head's gradients in a chunk's gradient array. */
static inline size_t ted4_gen_colour_grad(const ted4_generator *g)
{
    return g->n_effective + g->layout.shape.netr[TED4_NET_COLOUR].first - g->net_tail;
}

/* Returns the number of weights of the colour head. */
static inline size_t ted4_gen_colour_weights(const ted4_generator *g)
{
    return ted4_network_size(&g->layout.shape.netr[TED4_NET_COLOUR]);
}

/* Returns the floats of one visible block in the gradients behind colours of a view. */
static inline size_t ted4_gen_view_row(const ted4_generator *g)
{
    return (size_t)g->layout.head.feature_dim * TED4_LANES;
}

static inline int ted4_gen_activated(const ted4_generator *g, const ted4_generate_input *in)
{
    return in->activation && g->layout.first[TED4_TAU] >= 0;
}

#endif
