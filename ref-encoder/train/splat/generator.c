/* generator.c - see generator.h: memory of a generator, and dispatch of both directions by the
 * level in use (decode_fwd.c, decode_bwd.c).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "decode_state.h"

#include <stdlib.h>
#include <string.h>

ted4_generator *ted4_generator_new(const ted4_layout *l)
{
    ted4_generator *g = calloc(1, sizeof *g);

    if (g == NULL)
        return NULL;
    g->layout = *l;
    if (ted4_gen_plan(g) != 0) {
        ted4_generator_free(g);
        return NULL;
    }
    return g;
}

void ted4_generator_free(ted4_generator *g)
{
    if (g == NULL)
        return;
    for (int net = 0; net < TED4_NETS_R; net++)
        for (int i = 0; i < g->chain[net].n; i++)
            ted4_dense_finish(&g->chain[net].layer[i].dense);
    ted4_gen_motion_finish(&g->motion);
    free(g->grad);
    free(g->d_planes);
    free(g->saved);
    free(g->splats);
    free(g->shown);
    free(g);
}

void ted4_generator_pack(ted4_generator *g, const float *net)
{
    for (int k = 0; k < TED4_NETS_R; k++)
        for (int i = k == TED4_NET_DEFORM; i < g->chain[k].n; i++) {
            const ted4_gen_layer *layer = &g->chain[k].layer[i];
            const float *w = net + g->layout.netr + layer->net;

            ted4_dense_pack(&g->chain[k].layer[i].dense, w,
                            w + (size_t)layer->dense.in * (size_t)layer->dense.out);
        }
}

static int reserve(ted4_generator *g, size_t n)
{
    const size_t row = (size_t)g->layout.head.n_offsets * TED4_LANES;
    size_t capacity;

    if (n <= g->capacity && g->capacity > 0)
        return 0;
    capacity = n + n / 4 + 1;
    free(g->saved);
    free(g->splats);
    free(g->shown);
    g->saved = ted4_gen_alloc(capacity * ted4_gen_stride(g));
    g->splats = ted4_gen_alloc(TED4_GEN_ARRAYS * capacity * row);
    g->shown = ted4_gen_alloc(capacity * row);
    g->capacity = g->saved != NULL && g->splats != NULL && g->shown != NULL ? capacity : 0;
    return g->capacity != 0 ? 0 : -1;
}

int ted4_generate(ted4_generator *g, const ted4_generate_input *in, const ted4_parallel *p,
                  ted4_splats *out)
{
    ted4_gen_job t = { .g = g, .in = in };

    if (reserve(g, in->n_visible) != 0)
        return -1;
    ted4_gen_motion_make(g, in);
    ted4_parallel_for(p, in->n_visible, TED4_IN_USE(ted4_gen_forward), &t);
    out->n = in->n_visible * (size_t)g->layout.head.n_offsets * TED4_LANES;
    for (int c = 0; c < 3; c++) {
        out->mean[c] = ted4_gen_splats(g, TED4_GEN_MEAN + c, 0);
        out->scale[c] = ted4_gen_splats(g, TED4_GEN_SCALE + c, 0);
        out->colour[c] = ted4_gen_splats(g, TED4_GEN_COLOUR + c, 0);
    }
    for (int c = 0; c < 4; c++)
        out->rot[c] = ted4_gen_splats(g, TED4_GEN_ROT + c, 0);
    out->opacity = ted4_gen_splats(g, TED4_GEN_OPACITY, 0);
    return 0;
}

/* Sums the gradients of the camera's centre over the chunks. */
static void add_cameras(ted4_generator *g)
{
    for (int chunk = 1; chunk < TED4_GEN_CHUNKS; chunk++)
        for (int c = 0; c < 3; c++)
            g->d_camera[0][c] += g->d_camera[chunk][c];
}

/* Adds the gradients of the colour head, summed over the views. */
static void add_colour_head(const ted4_generator *g, const ted4_generate_input *in, float *d_net)
{
    const size_t n = ted4_gen_colour_weights(g);
    const float *sum = in->view_sum + in->n_visible * ted4_gen_view_row(g);
    float *to = d_net + g->layout.netr + g->layout.shape.netr[TED4_NET_COLOUR].first;

    for (size_t i = 0; i < n; i++)
        to[i] += sum[i];
}

size_t ted4_generate_first(size_t n_visible, size_t chunk)
{
    return ted4_gen_first(n_visible, chunk);
}

void ted4_generate_backward_chunks(ted4_generator *g, const ted4_generate_input *in,
                                   const ted4_splat_grads *gr, const ted4_parallel *p,
                                   float *const *d_attr, size_t from, size_t to)
{
    ted4_gen_job t = { .g = g, .in = in, .gr = gr, .d_attr = d_attr, .first = from };

    ted4_parallel_for(p, to - from, TED4_IN_USE(ted4_gen_backward), &t);
}

float *ted4_generate_chunk_gradients(ted4_generator *g, size_t *size)
{
    *size = g->n_grad;
    return g->grad;
}

void ted4_generate_backward_end(ted4_generator *g, const ted4_generate_input *in, float *d_net)
{
    const float *sum = g->grad;
    float *tail = d_net + g->layout.netr + g->net_tail;

    for (size_t i = 0; i < g->n_effective; i++)
        g->motion.d_w[i] = sum[i];
    for (size_t i = g->n_effective; i < g->n_grad; i++)
        tail[i - g->n_effective] += sum[i];
    if (in->by_view)
        add_colour_head(g, in, d_net);
    TED4_IN_USE(ted4_gen_motion_backward)(g, in->net, d_net);
}

int ted4_generate_backward(ted4_generator *g, const ted4_generate_input *in,
                           const ted4_splat_grads *gr, const ted4_parallel *p, float *const *d_attr,
                           float *d_net)
{
    ted4_gen_job t = { .g = g };

    ted4_generate_backward_chunks(g, in, gr, p, d_attr, 0, TED4_GEN_CHUNKS);
    ted4_parallel_for(p, TED4_GEN_CHUNKS, TED4_IN_USE(ted4_gen_sum_range), &t);
    ted4_generate_backward_end(g, in, d_net);
    add_cameras(g);
    return 0;
}

const float *ted4_generate_camera_gradient(const ted4_generator *g)
{
    return g->d_camera[0];
}

void ted4_generate_view(ted4_generator *g, const ted4_generate_input *in, const ted4_parallel *p,
                        ted4_splats *out)
{
    ted4_gen_job t = { .g = g, .in = in };

    ted4_parallel_for(p, in->n_visible, TED4_IN_USE(ted4_gen_view_forward), &t);
    out->opacity = g->shown;
}

size_t ted4_generate_view_size(const ted4_generator *g, size_t n_visible)
{
    return n_visible * ted4_gen_view_row(g) + ted4_gen_colour_weights(g);
}

size_t ted4_generate_view_row(const ted4_generator *g)
{
    return ted4_gen_view_row(g);
}

void ted4_generate_view_backward(ted4_generator *g, const ted4_generate_input *in,
                                 const ted4_splat_grads *gr, const ted4_parallel *p, float *sum)
{
    ted4_gen_job t = { .g = g, .in = in, .gr = gr, .view_sum = sum };
    const size_t n = ted4_gen_colour_weights(g);
    float *weights = sum + in->n_visible * ted4_gen_view_row(g);

    ted4_parallel_for(p, TED4_GEN_CHUNKS, TED4_IN_USE(ted4_gen_view_backward), &t);
    add_cameras(g);
    memset(weights, 0, n * sizeof *weights);
    for (size_t c = 0; c < TED4_GEN_CHUNKS; c++) {
        const float *grad = g->grad + c * g->n_grad + ted4_gen_colour_grad(g);

        for (size_t i = 0; i < n; i++)
            weights[i] += grad[i];
    }
}
