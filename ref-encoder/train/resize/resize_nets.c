/* resize_nets.c - see resize_nets.h. Each layer W x + b becomes R (W C) x' + R (b + W c), where R
 * selects the outputs that remain, and x = C x' + c expresses the old inputs by the new ones. The
 * moments of Adam are those of the units that remain.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "resize_nets.h"

#include <stdlib.h>
#include <string.h>

#include "train/model/formulas.h"

enum { MOST_UNITS = 640 };

/* One layer of a network while it is assembled. */
typedef struct {
    const ted4_net_shape *from, *to;
    size_t blob_from, blob_to; /* offset of the networks' blob in the arrays */
    int layer;
    int row[MOST_UNITS];      /* [outputs] the old output of each */
    int col[MOST_UNITS];      /* [inputs] the old input of each */
    int n_rows, n_from, n_to; /* numbers of rows, old columns and new columns so far */
    double *decode;           /* [old inputs][new inputs + 1] */
} layer_map;

static size_t layer_at(const ted4_net_shape *s, int layer)
{
    size_t at = s->first;

    for (int i = 0; i < layer; i++)
        at += ted4_layer_size(s, (unsigned)i);
    return at;
}

static int begin_layer(layer_map *m, const ted4_net_shape *from, const ted4_net_shape *to,
                       int layer, size_t blob_from, size_t blob_to)
{
    *m = (layer_map) {
        .from = from, .to = to, .layer = layer, .blob_from = blob_from, .blob_to = blob_to
    };
    m->decode = calloc((size_t)from->dim[layer] * (to->dim[layer] + 1u) + 1, sizeof *m->decode);
    return m->decode != NULL ? 0 : -1;
}

/* Adds the next n old inputs, reduced by w, or unchanged if w is NULL. */
static void add_inputs(layer_map *m, int n, const ted4_pruned_units *w)
{
    const size_t stride = m->to->dim[m->layer] + 1u;
    const int to = w != NULL ? w->to : n;

    for (int i = 0; i < n; i++) {
        double *row = m->decode + (size_t)(m->n_from + i) * stride;

        if (w == NULL) {
            row[m->n_to + i] = 1.0;
            continue;
        }
        for (int k = 0; k < to; k++)
            row[m->n_to + k] = w->decode[i * (to + 1) + k];
        row[stride - 1] = w->decode[i * (to + 1) + to];
    }
    for (int k = 0; k < to; k++)
        m->col[m->n_to + k] = m->n_from + (w != NULL ? w->keep[k] : k);
    m->n_from += n;
    m->n_to += to;
}

/* Adds the next n old outputs, from old row first on; unless w is NULL, only those that it keeps.
 */
static void add_outputs(layer_map *m, int first, int n, const ted4_pruned_units *w)
{
    const int to = w != NULL ? w->to : n;

    for (int k = 0; k < to; k++)
        m->row[m->n_rows++] = first + (w != NULL ? w->keep[k] : k);
}

/* Writes the assembled layer to the new arrays, and frees the memory of m. */
static void end_layer(layer_map *m, const ted4_resize_nets *n)
{
    const size_t in = m->from->dim[m->layer], out = m->from->dim[m->layer + 1];
    const size_t fewer = m->to->dim[m->layer], rows = m->to->dim[m->layer + 1];
    const size_t old = m->blob_from + layer_at(m->from, m->layer);
    const size_t new = m->blob_to + layer_at(m->to, m->layer);

    for (size_t o = 0; o < rows; o++) {
        const float *w = n->old[0] + old + (size_t)m->row[o] * in;
        float *to = n->new[0] + new + o *fewer;

        for (size_t k = 0; k <= fewer; k++) {
            double sum = k < fewer ? 0.0 : (double)n->old[0][old + in * out + (size_t)m->row[o]];

            for (size_t i = 0; i < in; i++)
                sum += (double)w[i] * m->decode[i * (fewer + 1) + k];
            *(k < fewer ? to + k : n->new[0] + new + fewer *rows + o) = (float)sum;
        }
        for (int a = 1; a < TED4_RESIZE_ARRAYS; a++) {
            for (size_t k = 0; k < fewer; k++)
                n->new[a][new + o *fewer + k] =
                    n->old[a][old + (size_t)m->row[o] * in + (size_t)m->col[k]];
            n->new[a][new + fewer *rows + o] = n->old[a][old + in * out + (size_t)m->row[o]];
        }
    }
    free(m->decode);
}

/* ---- reconstruction networks ---- */

/* Adds the outputs of the last layer. */
static void add_last_outputs(layer_map *m, const ted4_resize_nets *n, int net)
{
    static const int each[TED4_NETS_R] = { 0, 0, 1, 7, 3 };
    const ted4_resize *s = n->resize;

    if (net == TED4_NET_PROJECT) {
        add_outputs(m, 0, n->from->head.bank_dim, s->bank);
    } else if (net == TED4_NET_DEFORM) {
        add_outputs(m, 0, 3, NULL);
        add_outputs(m, 3, n->from->head.feature_dim, s->feature);
    } else {
        for (int k = 0; k < n->to->head.n_offsets; k++)
            add_outputs(m, each[net] * s->offset[k], each[net], NULL);
    }
}

static void add_first_inputs(layer_map *m, const ted4_resize_nets *n, int net)
{
    const ted4_resize *s = n->resize;
    const ted4_header *h = &n->from->head;
    const int in = m->from->dim[0];

    if (net == TED4_NET_PROJECT) {
        add_inputs(m, h->phi_dim, s->phi);
    } else if (net == TED4_NET_DEFORM && h->motion == TED4_MOTION_CONCAT) {
        add_inputs(m, h->phi_dim, s->phi);
        add_inputs(m, h->bank_dim, NULL);
    } else if (net == TED4_NET_DEFORM) {
        add_inputs(m, in, h->motion == TED4_MOTION_BANK ? s->bank : NULL);
    } else if (s->input[net] != NULL) {
        add_inputs(m, in, s->input[net]);
    } else {
        add_inputs(m, h->feature_dim, s->feature);
        add_inputs(m, in - h->feature_dim, NULL);
    }
}

static int map_netr(const ted4_resize_nets *n, int net)
{
    const ted4_net_shape *from = &n->from->shape.netr[net], *to = &n->to->shape.netr[net];
    layer_map m;

    for (int i = 0; i < to->n_layers; i++) {
        if (begin_layer(&m, from, to, i, n->from->netr, n->to->netr) != 0)
            return -1;
        if (i == 0)
            add_first_inputs(&m, n, net);
        else
            add_inputs(&m, from->dim[i], n->resize->hidden[net][i]);
        if (i + 1 == to->n_layers)
            add_last_outputs(&m, n, net);
        else
            add_outputs(&m, 0, from->dim[i + 1], n->resize->hidden[net][i + 1]);
        end_layer(&m, n);
    }
    return 0;
}

/* ---- prior networks ---- */

/* Adds mu, then s, of the components that remain. */
static void add_type_outputs(layer_map *m, const ted4_resize_nets *n, int type)
{
    const ted4_resize *s = n->resize;
    const int dim = (int)n->from->shape.dim[type], first = (int)n->from->shape.first_output[type];
    const ted4_pruned_units *w = type == TED4_FEATURE ? s->feature
                                 : type == TED4_PHI   ? s->phi
                                                      : NULL;

    for (int half = 0; half < 2 && n->to->shape.dim[type] > 0; half++) {
        if (type != TED4_OFFSET)
            add_outputs(m, first + half * dim, dim, w);
        for (int k = 0; type == TED4_OFFSET && k < n->to->head.n_offsets; k++)
            add_outputs(m, first + half * dim + 3 * s->offset[k], 3, NULL);
    }
}

static int map_hyper(const ted4_resize_nets *n)
{
    const ted4_shape *shape = &n->from->shape;
    const ted4_net_shape *from = &shape->hyper, *to = &n->to->shape.hyper;
    layer_map m;

    for (int i = 0; i < to->n_layers; i++) {
        if (begin_layer(&m, from, to, i, n->from->nete, n->to->nete) != 0)
            return -1;
        add_inputs(&m, from->dim[i], i == 0 ? n->resize->position : n->resize->hyper[i]);
        if (i + 1 < to->n_layers) {
            add_outputs(&m, 0, from->dim[i + 1], n->resize->hyper[i + 1]);
        } else {
            for (int y = 0; y < TED4_TYPES; y++)
                add_type_outputs(&m, n, y);
            for (int y = 0, v = (int)shape->first_step_output; y < TED4_TYPES; y++) {
                if (n->to->shape.dim[y] > 0)
                    add_outputs(&m, v, 1, NULL);
                v += shape->dim[y] > 0;
            }
        }
        end_layer(&m, n);
    }
    return 0;
}

/* Returns the slice of component c of the feature, and sets *begin to the slice's first component.
 */
static int slice_of(const ted4_header *h, int c, int *begin)
{
    int m = 0;

    for (*begin = 0; c >= *begin + h->slice[m]; m++)
        *begin += h->slice[m];
    return m;
}

static int old_feature(const ted4_resize_nets *n, int c)
{
    return n->resize->feature != NULL ? n->resize->feature->keep[c] : c;
}

/* Adds the contexts of an old slice network. Contexts that no longer exist are replaced by their
 * means. */
static void add_contexts(layer_map *map, const ted4_resize_nets *n, int known)
{
    const size_t stride = map->to->dim[0] + 1u;

    for (int i = 0; i < map->from->dim[0]; i++) {
        int k = 0;

        while (k < known && old_feature(n, k) != i)
            k++;
        map->decode[(size_t)i * stride + (size_t)(k < known ? k : known)] =
            k < known ? 1.0 : (double)n->context[i];
        if (k < known)
            map->col[k] = i;
    }
}

/* Makes the network of slice m of the new header from that of the old slice of its components. */
static int map_slice(const ted4_resize_nets *n, int m, int known)
{
    int begin;
    const int was = slice_of(&n->from->head, old_feature(n, known), &begin),
              size = n->from->head.slice[was];
    layer_map first, second;

    if (begin_layer(&first, &n->from->shape.slice[was], &n->to->shape.slice[m], 0, n->from->nete,
                    n->to->nete) != 0)
        return -1;
    add_contexts(&first, n, known);
    add_outputs(&first, 0, first.from->dim[1], n->resize->slice[was]);
    end_layer(&first, n);
    if (begin_layer(&second, &n->from->shape.slice[was], &n->to->shape.slice[m], 1, n->from->nete,
                    n->to->nete) != 0)
        return -1;
    add_inputs(&second, second.from->dim[1], n->resize->slice[was]);
    for (int half = 0; half < 2; half++)
        for (int c = 0; c < n->to->head.slice[m]; c++)
            add_outputs(&second, half * size + old_feature(n, known + c) - begin, 1, NULL);
    end_layer(&second, n);
    return 0;
}

/* Evaluates the old slice network m at the mean context. said: [2 slice], receives mu and s of its
 * components. */
static void say_at_mean(const ted4_resize_nets *n, int m, float *said)
{
    const ted4_net_shape *s = &n->from->shape.slice[m];
    const float *w = n->old[0] + n->from->nete + s->first, *b = w + ted4_layer_weights(s, 0);
    float hidden[TED4_MAX_WIDTH];

    for (size_t o = 0; o < s->dim[1]; o++) {
        float sum = b[o];

        for (size_t i = 0; i < s->dim[0]; i++)
            sum += w[o * s->dim[0] + i] * n->context[i];
        hidden[o] = sum > 0 ? sum : 0;
    }
    w = b + s->dim[1];
    b = w + ted4_layer_weights(s, 1);
    for (size_t o = 0; o < s->dim[2]; o++) {
        said[o] = b[o];
        for (size_t i = 0; i < s->dim[1]; i++)
            said[o] += w[o * s->dim[1] + i] * hidden[i];
    }
}

/* For components of the new first slice that had a slice network before, adds the mean output of
 * that network to the hyperprior. */
static void keep_means(const ted4_resize_nets *n)
{
    const ted4_net_shape *h = &n->to->shape.hyper;
    const int last = h->n_layers - 1, F = n->to->head.feature_dim;
    float *const bias = n->new[0] + n->to->nete + layer_at(h, last) +
                        ted4_layer_weights(h, (unsigned)last) +
                        n->to->shape.first_output[TED4_FEATURE];

    for (int c = 0; c < n->to->head.slice[0]; c++) {
        float said[2 * TED4_MAX_FEATURE];
        int begin;
        const int old = old_feature(n, c), was = slice_of(&n->from->head, old, &begin),
                  size = n->from->head.slice[was];

        if (was == 0)
            continue;
        say_at_mean(n, was, said);
        bias[c] += said[old - begin];
        bias[F + c] += said[size + old - begin];
    }
}

static int map_nete(const ted4_resize_nets *n)
{
    int known = 0;

    if (map_hyper(n) != 0)
        return -1;
    for (int m = 1; m < n->to->head.n_slices; m++) {
        known += n->to->head.slice[m - 1];
        if (map_slice(n, m, known) != 0)
            return -1;
    }
    keep_means(n);
    return 0;
}

/* ---- bank ---- */

/* Resamples the bank. Rows at other times are interpolated as in spec 11.2. */
static void map_bank(const ted4_resize_nets *n)
{
    const ted4_header *from = &n->from->head, *to = &n->to->head;
    const ted4_pruned_units *w = n->resize->bank;

    for (uint32_t r = 0; n->to->shape.n_bank > 0 && r < to->bank_rows; r++) {
        float mix;
        const size_t row = ted4_bank_row(from, r, to->bank_rows > 1 ? to->bank_rows - 1 : 1, &mix);

        for (int c = 0; c < to->bank_dim; c++) {
            const size_t col = (size_t)(w != NULL ? w->keep[c] : c);

            for (int a = 0; a < TED4_RESIZE_ARRAYS; a++) {
                const float *z = n->old[a] + n->from->bank + row * from->bank_dim;

                n->new[a][n->to->bank + (size_t)r * to->bank_dim + (size_t)c] =
                    ted4_bank_value(z, from->bank_dim, col, mix);
            }
        }
    }
}

int ted4_resize_networks(const ted4_resize_nets *n)
{
    for (int i = 0; i < TED4_NETS_R; i++)
        if (map_netr(n, i) != 0)
            return -1;
    map_bank(n);
    return map_nete(n);
}
