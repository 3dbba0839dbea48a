/* net.c - the plan of a generator: the contents of each plane, and the place of each gradient. spec
 * 7.4.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "decode_state.h"

#include <stdlib.h>

float *ted4_gen_alloc(size_t n)
{
    return aligned_alloc(64, (n + 16) / 16 * 64);
}

/* Rounds a number of planes up to an odd one, because blocks at multiples of 4096 bytes would
 * compete for the same lines of the first-level cache. */
static int odd(int n)
{
    return n | 1;
}

static void plan_inputs(ted4_generator *g)
{
    const ted4_layout *l = &g->layout;
    const int f = l->head.feature_dim;
    ted4_gen_planes *p = &g->plane;
    int n = f;

    p->feature = 0;
    p->view = l->head.view != TED4_VIEW_NONE ? n : -1;
    n += p->view >= 0 ? 3 : 0;
    p->moved = p->feature;
    if (l->head.motion != TED4_MOTION_NONE) {
        p->moved = n;
        n += f + (l->head.view == TED4_VIEW_FULL ? 3 : 0);
    }
    p->rest = n;
    n += l->n_channels - f;
    p->point = l->head.motion == TED4_MOTION_INR ? n : -1;
    n += p->point >= 0 ? TED4_INR_POINT : 0;
    p->size = n;
    n += 6;
    p->active = n++;
    p->moving = n++;
    p->outputs = n;
    p->n = n;
}

/* Adds the layers of one network: their outputs become planes, and their gradients lie behind the
 * first n_effective. Layer 0 of F_deform is the effective one. */
static int plan_chain(ted4_generator *g, int net, int x)
{
    const ted4_net_shape *s = &g->layout.shape.netr[net];
    ted4_gen_chain *c = &g->chain[net];
    size_t at = s->first;

    for (int i = 0; i < s->n_layers; i++) {
        ted4_gen_layer *layer = &c->layer[i];
        const int effective = net == TED4_NET_DEFORM && i == 0;
        const int in = effective ? g->motion.in : s->dim[i], out = s->dim[i + 1];

        if (ted4_dense_init(&layer->dense, in, out) != 0)
            return -1;
        c->n = i + 1;
        layer->x = x;
        layer->y = x = g->plane.n;
        g->plane.n += out;
        layer->net = at;
        layer->grad = effective ? 0 : g->n_effective + at - g->net_tail;
        at += ted4_layer_size(s, (unsigned)i);
    }
    return 0;
}

static int last_plane(const ted4_gen_chain *c)
{
    return c->n > 0 ? c->layer[c->n - 1].y : -1;
}

static int plan_layers(ted4_generator *g)
{
    const ted4_shape *s = &g->layout.shape;
    const ted4_net_shape *deform = &s->netr[TED4_NET_DEFORM];
    ted4_gen_planes *p = &g->plane;
    int lane_input = p->point;

    g->net_tail = s->netr[TED4_NET_OPACITY].first;
    if (deform->n_layers > 0) {
        if (lane_input < 0)
            lane_input = p->rest + g->layout.first[TED4_PHI] - g->layout.head.feature_dim;
        g->n_effective = (size_t)g->motion.width * (size_t)(g->motion.in + 1);
        g->net_tail = deform->first + ted4_layer_size(deform, 0);
    }
    g->n_grad = g->n_effective + s->n_netr - g->net_tail;
    if (plan_chain(g, TED4_NET_DEFORM, lane_input) != 0 ||
        plan_chain(g, TED4_NET_OPACITY, p->feature) != 0 ||
        plan_chain(g, TED4_NET_COVARIANCE, p->moved) != 0 ||
        plan_chain(g, TED4_NET_COLOUR, p->feature) != 0)
        return -1;
    p->motion = last_plane(&g->chain[TED4_NET_DEFORM]);
    p->opacity = last_plane(&g->chain[TED4_NET_OPACITY]);
    p->covariance = last_plane(&g->chain[TED4_NET_COVARIANCE]);
    p->colour = last_plane(&g->chain[TED4_NET_COLOUR]);
    return 0;
}

int ted4_gen_plan(ted4_generator *g)
{
    const size_t d_inputs = 2 * ((size_t)g->layout.head.feature_dim + 3);

    plan_inputs(g);
    if (ted4_gen_motion_init(&g->motion, &g->layout) != 0 || plan_layers(g) != 0)
        return -1;
    g->d_size = (size_t)odd(g->plane.n - g->plane.outputs) * TED4_LANES;
    g->plane.n = odd(g->plane.n);
    g->d_chunk = TED4_GEN_GROUP * g->d_size + d_inputs * TED4_LANES;
    g->d_planes = ted4_gen_alloc(TED4_GEN_CHUNKS * g->d_chunk);
    g->grad = ted4_gen_alloc(TED4_GEN_CHUNKS * g->n_grad);
    return g->d_planes != NULL && g->grad != NULL ? 0 : -1;
}
