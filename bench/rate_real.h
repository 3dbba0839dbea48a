/* rate_real.h - the entropy model in floating point. rate_check.c includes this file once with REAL
 * float and once with double: NAME(x) is the name of a function for that type, SIN and COS are the
 * functions of that type. The networks are those of spec 7.1, with the weights that the file
 * stores, sine and cosine of the exact position, and contexts k STEP[Qi]; nothing is rounded to
 * integers or saturated. Anchors are processed in blocks of 64, arrays are [channel][64]; sums run
 * over the inputs in order, so that lanes are vectors. A vector is as wide as the machine's, since
 * gcc splits wider ones through memory, and a sum takes eight of them at most, which stay in
 * registers.
 * SPDX-License-Identifier: BSD-2-Clause */

typedef REAL NAME(vec) __attribute__((vector_size(VECTOR), may_alias, aligned(sizeof(REAL))));

/* Evaluates a layer: y [out][64] from x [in][64]. v: weights [out][in], then biases. ReLU follows
 * all layers but the last. */
static void NAME(layer)(const float *v, unsigned in, unsigned out, int last, const REAL *x, REAL *y)
{
    enum { LANES = VECTOR / sizeof(REAL), VECS = BLOCK / LANES < 8 ? BLOCK / LANES : 8 };

    for (unsigned o = 0; o < out; o++, y += BLOCK) {
        for (int first = 0; first < BLOCK; first += VECS * LANES) {
            const REAL *column = x + first;
            NAME(vec) sum[VECS];

            for (int i = 0; i < VECS; i++)
                sum[i] = (NAME(vec)) { 0 } + (REAL)v[(size_t)in * out + o];
            for (unsigned j = 0; j < in; j++, column += BLOCK) {
                const REAL w = (REAL)v[(size_t)o * in + j];

                for (int i = 0; i < VECS; i++)
                    sum[i] += w * *(const NAME(vec) *)(column + i * LANES);
            }
            memcpy(y + first, sum, sizeof sum);
        }
        for (int a = 0; a < BLOCK; a++)
            y[a] = last || y[a] > 0 ? y[a] : 0;
    }
}

static void NAME(net)(const ted4_net_shape *n, const float *nete, REAL *const hidden[2],
                      const REAL *x, REAL *y)
{
    const float *v = nete + n->first;

    for (unsigned i = 0; i < n->n_layers; i++) {
        const int last = i + 1u == n->n_layers;
        REAL *to = last ? y : hidden[i % 2];

        NAME(layer)(v, n->dim[i], n->dim[i + 1], last, x, to);
        v += ted4_layer_size(n, (unsigned)i);
        x = to;
    }
}

/* spec 10.1: the phase of octave l is p 2^(l - 1) turns, which is exact in a double. n anchors,
 * beginning at anchor first. */
static void NAME(inputs)(const ted4_scene *s, size_t first, size_t n, REAL *x)
{
    for (size_t a = 0; a < n; a++) {
        REAL *to = x + a;
        double p[3];

        for (size_t j = 0; j < 3; j++, to += BLOCK) {
            p[j] = ldexp(ted4_half_q24(s->position[3 * (first + a) + j]), -24);
            *to = (REAL)p[j];
        }
        for (int l = 0; l < s->head.pe_octaves; l++)
            for (int j = 0; j < 3; j++, to += 2 * BLOCK) {
                const double turns = ldexp(p[j], l - 1);
                const REAL angle = (REAL)(2 * PI * (turns - rint(turns)));

                to[0] = SIN(angle);
                to[BLOCK] = COS(angle);
            }
    }
}

/* Writes all mu and log2 sigma of n <= 64 anchors, beginning at anchor first, to y [P][64], in
 * units of the step, including the slice networks. x: workspace of [inputs][64]. */
static void NAME(model)(const ted4_scene *s, REAL *const hidden[2], size_t first, size_t n, REAL *x,
                        REAL *y)
{
    const ted4_header *h = &s->head;
    unsigned comp = h->slice[0];

    if (h->prior == TED4_PRIOR_INR)
        NAME(inputs)(s, first, n, x);
    NAME(net)(&s->shape.hyper, s->nete.values, hidden, x, y);
    for (unsigned i = 0; i < h->feature_dim; i++)
        for (size_t a = 0; a < n; a++)
            x[i * BLOCK + a] =
                s->symbol[TED4_FEATURE][(size_t)i * h->n_anchors + first + a] *
                (REAL)ted4_bits_float(ted4_step[s->step_index[TED4_FEATURE][first + a]]);
    for (unsigned m = 1; m < h->n_slices; comp += h->slice[m++]) {
        const size_t part = (size_t)h->slice[m] * BLOCK;
        REAL *mu = y + (size_t)comp * BLOCK, *sigma = mu + (size_t)h->feature_dim * BLOCK;
        REAL add[2 * TED4_MAX_FEATURE * BLOCK];

        NAME(net)(&s->shape.slice[m], s->nete.values, hidden, x, add);
        for (size_t i = 0; i < part; i++) {
            mu[i] += add[i];
            sigma[i] += add[part + i];
        }
    }
}

#undef REAL
#undef NAME
#undef SIN
#undef COS
