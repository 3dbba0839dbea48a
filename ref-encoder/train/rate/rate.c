/* rate.c - the trainer's float model of Tier E (spec 7.3, 9.4, 10): bits of chosen anchors, and
 * their gradients through rate_bwd.c. Inputs, units and sums are those of the decoder: positions in
 * Q12 as spec 10.1 rounds them, mu in steps, s = log2(sigma / step), q = Q0 2^v, contexts k q / Q0.
 * The only difference is that the networks do not round internally; with TED4_QUANT_INTEGER
 * (rate_integer.c) they do.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rate_parts.h"

#include <stdlib.h>
#include <string.h>

enum { ALIGN = 16, REDUCE_PIECE = 4096 }; /* floats */

static int net_init(ted4_rate_net *n, const ted4_net_shape *shape, int n_steps)
{
    size_t at = shape->first;

    n->n = shape->n_layers;
    for (int i = 0; i <= n->n; i++)
        n->dim[i] = shape->dim[i];
    for (int i = 0; i < n->n; i++) {
        const int out = n->dim[i + 1] - (i == n->n - 1 ? n_steps : 0);

        n->w[i] = at;
        n->b[i] = at + ted4_layer_weights(shape, (unsigned)i);
        at += ted4_layer_size(shape, (unsigned)i);
        if (ted4_dense_init(&n->layer[i], n->dim[i], out) != 0)
            return -1;
    }
    return 0;
}

static void net_finish(ted4_rate_net *n)
{
    for (int i = 0; i < n->n; i++)
        ted4_dense_finish(&n->layer[i]);
}

ted4_rate *ted4_rate_new(const ted4_layout *l)
{
    ted4_rate *r = calloc(1, sizeof *r);
    const ted4_shape *shape = &l->shape;
    const int n_steps = (int)shape->n_types;

    if (r == NULL)
        return NULL;
    r->layout = *l;
    for (int i = 0; i < TED4_RATE_WAVE; i++)
        atomic_flag_clear(&r->busy[i]);
    int failed = net_init(&r->hyper, &shape->hyper, n_steps);

    if (!failed)
        failed = ted4_dense_init(&r->step, r->hyper.dim[r->hyper.n - 1], n_steps);
    for (int m = 1; m < l->head.n_slices && !failed; m++)
        failed = net_init(&r->slice[m], &shape->slice[m], 0);
    if (failed) {
        ted4_rate_free(r);
        return NULL;
    }
    return r;
}

void ted4_rate_free(ted4_rate *r)
{
    if (r == NULL)
        return;
    for (size_t i = 0; i < TED4_RATE_WAVE; i++) {
        free(r->workspace[i].storage);
        free(r->sums[i].d_net);
    }
    ted4_rate_integer_end(&r->integer);
    net_finish(&r->hyper);
    ted4_dense_finish(&r->step);
    for (int m = 0; m < TED4_MAX_SLICES; m++)
        net_finish(&r->slice[m]);
    free(r);
}

void ted4_rate_pack(ted4_rate *r, const float *net)
{
    const float *nete = net + r->layout.nete;
    const ted4_rate_net *h = &r->hyper;
    const size_t last = (size_t)h->n - 1, rows = (size_t)h->layer[last].out;

    for (int i = 0; i < h->n; i++)
        ted4_dense_pack(&r->hyper.layer[i], nete + h->w[i], nete + h->b[i]);
    ted4_dense_pack(&r->step, nete + h->w[last] + rows * (size_t)h->dim[last],
                    nete + h->b[last] + rows);
    for (int m = 1; m < r->layout.head.n_slices; m++)
        for (int i = 0; i < r->slice[m].n; i++)
            ted4_dense_pack(&r->slice[m].layer[i], nete + r->slice[m].w[i],
                            nete + r->slice[m].b[i]);
}

/* ---- workspaces ---- */

/* Allocates pieces of one storage; with base NULL it only counts their size. */
typedef struct {
    float *base;
    size_t n;
} arena;

static float *take(arena *a, size_t n)
{
    float *p = a->base != NULL ? a->base + a->n : NULL;

    a->n += (n + ALIGN - 1) / ALIGN * ALIGN;
    return p;
}

static void take_acts(arena *a, const ted4_rate_net *n, int with_input, ted4_rate_acts *acts)
{
    for (int i = 0; i <= n->n; i++) {
        const size_t size = ted4_row_floats((size_t)n->dim[i] * TED4_RATE_CHUNK);

        if (i > 0 || with_input)
            acts->x[i] = take(a, size);
        if (i > 0)
            acts->d[i] = take(a, size);
    }
}

static void lay_out_workspace(arena *a, const ted4_rate *r, ted4_rate_workspace *workspace)
{
    const ted4_layout *l = &r->layout;
    const size_t channels = ted4_row_floats((size_t)l->offset_logit);
    const size_t offsets = ted4_row_floats(l->head.n_offsets);
    const size_t context = ted4_row_floats(l->shape.dim[TED4_FEATURE]);
    ted4_rate_block *s = &workspace->current;

    take_acts(a, &r->hyper, 1, &workspace->hyper);
    workspace->context = take(a, context * TED4_RATE_CHUNK);
    workspace->integer = (int32_t *)take(a, l->shape.n_outputs * TED4_PRIOR_BLOCK);
    for (int m = 1; m < l->head.n_slices; m++)
        take_acts(a, &r->slice[m], 0, &workspace->slice[m]);
    s->value = take(a, channels);
    s->residual = take(a, channels);
    s->d_symbol = take(a, channels);
    s->used = take(a, TED4_LANES);
    s->dynamic = take(a, TED4_LANES);
    s->phi_bits = take(a, TED4_LANES);
    s->kept = take(a, offsets);
    s->kept_bits = take(a, offsets);
    s->d_context = take(a, context);
}

static int make_workspaces(ted4_rate *r, size_t n)
{
    for (; r->n_workspaces < n; r->n_workspaces++) {
        ted4_rate_workspace *workspace = &r->workspace[r->n_workspaces];
        ted4_rate_sums *sums = &r->sums[r->n_workspaces];
        arena a = { NULL, 0 };

        lay_out_workspace(&a, r, workspace);
        if (workspace->storage == NULL)
            workspace->storage = aligned_alloc(64, a.n * sizeof(float));
        if (sums->d_net == NULL)
            sums->d_net = malloc(r->layout.shape.n_nete * sizeof(float));
        if (workspace->storage == NULL || sums->d_net == NULL)
            return -1;
        a = (arena) { workspace->storage, 0 };
        lay_out_workspace(&a, r, workspace);
    }
    return 0;
}

/* Takes the first free workspace, so that few are ever used and they stay in the caches. */
static size_t workspace_acquire(ted4_rate *r)
{
    for (size_t i = 0;; i = (i + 1) % r->n_workspaces)
        if (!atomic_flag_test_and_set_explicit(&r->busy[i], memory_order_acquire))
            return i;
}

static void workspace_release(ted4_rate *r, size_t i)
{
    atomic_flag_clear_explicit(&r->busy[i], memory_order_release);
}

/* ---- chunks ---- */

static size_t whole_waves(size_t n_visible)
{
    const size_t wave = (size_t)TED4_RATE_CHUNK * TED4_RATE_WAVE;

    return (n_visible + wave - 1) / wave * TED4_RATE_WAVE;
}

static size_t count_chunks(size_t n_visible)
{
    const size_t most = (n_visible + TED4_RATE_LEAST - 1) / TED4_RATE_LEAST,
                 whole = whole_waves(n_visible);

    return whole < most ? whole : most;
}

static size_t chunk_first(const ted4_rate_job *job, size_t chunk)
{
    return job->in->n_visible * chunk / job->n_chunks;
}

static void run_chunk(void *arg, size_t i)
{
    const ted4_rate_job *job = arg;
    const size_t chunk = job->from + i;
    const size_t entered = workspace_acquire(job->rate);
    ted4_rate_workspace *workspace = &job->rate->workspace[entered];
    const size_t first = chunk_first(job, job->first + chunk);
    const size_t n = chunk_first(job, job->first + chunk + 1) - first;

    workspace->sums = &job->rate->sums[chunk];
    TED4_IN_USE(ted4_rate_chunk)(job, workspace, first, n);
    workspace_release(job->rate, entered);
}

typedef struct {
    const ted4_rate *rate;
    size_t n_workspaces;
    float *d_nete;
} reduction;

/* Adds the weight gradients of the chunks in the order of the chunks. */
static void reduce_piece(void *arg, size_t piece)
{
    const reduction *r = arg;
    const size_t n = r->rate->layout.shape.n_nete;
    const size_t first = piece * REDUCE_PIECE;
    const size_t end = n - first < REDUCE_PIECE ? n : first + REDUCE_PIECE;

    for (size_t k = 0; k < r->n_workspaces; k++) {
        const float *from = r->rate->sums[k].d_net;

        for (size_t i = first; i < end; i++)
            r->d_nete[i] += from[i];
    }
}

/* Completes a wave of n chunks by what the other processes have of it. */
static int join_wave(const ted4_rate_job *job, size_t n, float *d_nete)
{
    const ted4_rate_ranks *x = job->in->ranks;
    size_t first[TED4_RATE_WAVE + 1];

    for (size_t k = 0; k <= n; k++)
        first[k] = chunk_first(job, job->first + k);
    return x->join(x->user, job->rate->sums, first, n, d_nete);
}

/* Runs n chunks from job->first on, and adds their results to the sums. Returns 0, or -1 if memory
 * ran out. */
static int run_wave(ted4_rate_job *job, size_t n, const ted4_parallel *p, float *d_net,
                    double *bits)
{
    const ted4_layout *l = job->in->layout;
    const size_t n_pieces = (l->shape.n_nete + REDUCE_PIECE - 1) / REDUCE_PIECE;
    const ted4_rate_ranks *x = job->d_attr != NULL ? job->in->ranks : NULL;
    const size_t to = x != NULL ? n * (x->rank + 1) / x->n : n;

    job->from = x != NULL ? n * x->rank / x->n : 0;
    ted4_parallel_for(p, to - job->from, run_chunk, job);
    if (job->steps_only)
        return 0;
    if (x != NULL && join_wave(job, n, d_net + l->nete) != 0)
        return -1;
    for (size_t k = 0; k < n; k++)
        for (int t = 0; t < TED4_TYPES; t++)
            bits[t] += job->rate->sums[k].bits[t];
    if (job->d_attr != NULL && x == NULL) {
        reduction sum = { job->rate, n, d_net + l->nete };

        ted4_parallel_for(p, n_pieces, reduce_piece, &sum);
    }
    return 0;
}

/* Fills in all members of job except rate, input and the outputs, and runs the chunks. */
static int evaluate(ted4_rate_job job, const ted4_parallel *p, float *d_net, double *bits)
{
    ted4_rate *r = job.rate;
    const ted4_rate_input *in = job.in;
    const size_t n_chunks = count_chunks(in->n_visible);

    for (int t = 0; t < TED4_TYPES && bits != NULL; t++)
        bits[t] = 0.0;
    if (make_workspaces(r, n_chunks < TED4_RATE_WAVE ? n_chunks : TED4_RATE_WAVE) != 0)
        return -1;
    if (in->quant == TED4_QUANT_INTEGER) {
        if (ted4_rate_integer_begin(r, in) != 0)
            return -1;
        job.integer = &r->integer;
    }
    for (size_t c = 0; c < n_chunks; c += TED4_RATE_WAVE) {
        const size_t left = n_chunks - c;

        job.first = c;
        job.n_chunks = n_chunks;
        if (run_wave(&job, left < TED4_RATE_WAVE ? left : TED4_RATE_WAVE, p, d_net, bits) != 0)
            return -1;
    }
    return 0;
}

int ted4_rate_evaluate(ted4_rate *r, const ted4_rate_input *in, const ted4_parallel *p,
                       const float *const *d_value, float *const *d_attr, float *d_net,
                       float *const *steps, double *bits)
{
    return evaluate((ted4_rate_job) { .rate = r,
                                      .in = in,
                                      .d_value = d_value,
                                      .d_attr = d_attr,
                                      .steps = steps,
                                      .steps_only = bits == NULL },
                    p, d_net, bits);
}

int ted4_rate_lanes(ted4_rate *r, const ted4_rate_input *in, const ted4_parallel *p,
                    float *const *steps, float *lane_bits)
{
    double bits[TED4_TYPES];

    memset(lane_bits, 0,
           in->n_visible * ted4_row_floats(1u + in->layout->head.n_offsets) * sizeof *lane_bits);
    return evaluate((ted4_rate_job) { .rate = r, .in = in, .steps = steps, .lane_bits = lane_bits },
                    p, NULL, bits);
}

/* ---- dispatch by the level in use ---- */

void ted4_rate_row(const float *u, const float *s, float *bits, float *d_u, float *d_s)
{
    TED4_IN_USE(ted4_rate_row)(u, s, bits, d_u, d_s);
}
