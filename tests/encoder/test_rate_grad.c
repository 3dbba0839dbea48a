/* test_rate_grad.c - every gradient of the files of train/rate against central differences of the
 * double-precision model in rate_ref.h, with residuals held fixed: values, mask logits, weights of
 * hyperprior and slices; at random points and at edge cases.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "rate_ref.h"

enum { MAX_ANCHORS = 16 };

/* The anchors in use, and which outputs are clamped for each of them. */
typedef struct {
    ref_model model;
    ref_anchor anchor[MAX_ANCHORS];
    ref_clamps clamps[MAX_ANCHORS];
    int visible[MAX_ANCHORS], lane[MAX_ANCHORS], n, n_clamped, n_open;
} points;

static points pts;

static void gather(ref_world *w)
{
    float *noise = ref_floats((size_t)w->layout.n_channels * TED4_LANES);

    memset(&pts, 0, sizeof pts);
    pts.model = ref_model_make(w);
    for (int i = 0; i < REF_BLOCKS; i++) {
        ref_noise(w, i, noise);
        for (int j = 0; j < TED4_LANES; j++) {
            if (!(w->lanes[i] >> j & 1))
                continue;
            assert_true(pts.n < MAX_ANCHORS);
            ref_anchor_make(w, &pts.model, i, j, noise, &pts.anchor[pts.n]);
            ref_find_clamps(&pts.model, &pts.anchor[pts.n], &pts.clamps[pts.n]);
            pts.visible[pts.n] = i;
            pts.lane[pts.n++] = j;
        }
    }
    free(noise);
    for (int i = 0; i < pts.n; i++)
        for (unsigned o = 0; o < w->layout.shape.n_outputs; o++) {
            pts.n_clamped += pts.clamps[i].open[o] >= 0;
            pts.n_open += pts.clamps[i].open[o] > 0;
        }
}

static double loss(int i)
{
    ref_result r;

    ref_evaluate(&pts.model, &pts.anchor[i], &pts.clamps[i], &r);
    return r.loss;
}

/* Central difference by *x of the summed losses of anchors [first, end). */
static double slope(double *x, double h, int first, int end)
{
    const double at = *x;
    double up = 0.0, down = 0.0;

    *x = at + h;
    for (int i = first; i < end; i++)
        up += loss(i);
    *x = at - h;
    for (int i = first; i < end; i++)
        down += loss(i);
    *x = at;
    return (up - down) / (2.0 * h);
}

/* The error is relative to the gradient, or to the sum of the terms that may have cancelled in
 * it. */
static void check(double got, double want, double scale)
{
    if (!(fabs(got - want) <= 1e-3 * fabs(want) + 1e-4 * scale))
        fail_msg("got %g, want %g, scale %g", got, want, scale);
}

static void check_values(const ref_world *w)
{
    const ted4_layout *l = &w->layout;

    for (int t = 0; t < TED4_TYPES; t++)
        for (unsigned c = 0; c < l->shape.dim[t]; c++)
            for (int i = 0; i < pts.n; i++) {
                const int ch = l->first[t] + (int)c;
                const double q = (double)w->steps[pts.visible[i]][t * TED4_LANES + pts.lane[i]];
                double *x = &pts.anchor[i].x[ch];
                const double h = fmax(1e-5 * q, 1e-9 * fabs(*x));
                const double rate = slope(x, h, i, i + 1);
                const double got = (double)w->d_attr[pts.visible[i]][ch * TED4_LANES + pts.lane[i]];

                check(got * q, rate * q, 1.0);
            }
}

static void check_logits(const ref_world *w)
{
    const ted4_layout *l = &w->layout;
    const int K = l->head.n_offsets;

    for (int i = 0; i < pts.n; i++) {
        ref_result r;

        ref_evaluate(&pts.model, &pts.anchor[i], NULL, &r);
        for (int k = 0; k <= K; k++) {
            const double m = 1.0 / (1.0 + exp(-pts.anchor[i].logit[k]));
            const int used = k < K ? l->head.offset_mask : l->head.temporal_mask;
            const double bits = k < K ? r.offset_bits[k] : r.phi_bits;
            const int row = l->offset_logit + k;

            check((double)w->d_attr[pts.visible[i]][row * TED4_LANES + pts.lane[i]],
                  used ? pts.model.bit_weight * bits * m * (1.0 - m) : 0.0, 0.1);
        }
    }
}

static void check_weights(ref_world *w, size_t stride)
{
    double scale = 0.0;
    const size_t n = w->layout.shape.n_nete;

    for (size_t i = 0; i < n; i++)
        scale += fabs((double)w->d_net[w->layout.nete + i]) / (double)n;
    for (size_t i = 0; i < w->layout.nete; i++)
        assert_true(w->d_net[i] == 0.0f);
    for (size_t i = 0; i < n; i += stride)
        check((double)w->d_net[w->layout.nete + i], slope(&w->nete[i], 1e-6, 0, pts.n),
              3.0 * scale);
}

static void check_all(ref_world *w, size_t stride)
{
    double bits[TED4_TYPES];

    w->lanes[0] = 0x00810001u;
    w->lanes[1] = 0x80000410u;
    w->lanes[2] = 0x00f00000u;
    assert_int_equal(ref_run(w, NULL, bits), 0);
    gather(w);
    check_values(w);
    check_logits(w);
    check_weights(w, stride);
}

static void test_random_points(void **state)
{
    (void)state;
    for (int quant = TED4_QUANT_NOISE; quant <= TED4_QUANT_ROUND; quant++) {
        static ref_world w;
        const ted4_header h = ref_header();

        ref_world_make(&w, &h);
        w.in.quant = (ted4_quant)quant;
        check_all(&w, 1);
        ref_world_finish(&w);
    }
}

static void test_variants(void **state)
{
    (void)state;
    for (int which = 0; which < 4; which++) {
        static ref_world w;
        ted4_header h = ref_header();

        if (which == 0) {
            h.prior = TED4_PRIOR_FACTORISED;
            h.pe_octaves = h.hyper_layers = 0;
            h.hyper_width = 0;
        } else if (which == 1) {
            h.n_slices = 1;
            h.slice[0] = h.feature_dim;
            h.ar_width = 0;
            h.hyper_layers = 0;
            h.hyper_width = 0;
        } else if (which == 2) {
            h.motion = TED4_MOTION_NONE;
            h.phi_dim = h.temporal_mask = h.activation = h.deform_layers = 0;
            h.bank_rows = h.bank_dim = h.deform_width = 0;
        }
        ref_world_make(&w, &h);
        w.in.activation = which != 3; /* 3: the static phase */
        check_all(&w, 3);
        ref_world_finish(&w);
    }
}

/* Every fourth output is moved out of range, on either side, also v: gradients follow the one-sided
 * rule (annex D.1, traps). */
static void test_clamped(void **state)
{
    (void)state;
    for (int side = 0; side < 2; side++) {
        static ref_world w;
        const ted4_header h = ref_header();

        ref_world_make(&w, &h);
        const ted4_shape *s = &w.layout.shape;
        const float out = side ? 14.0f : -6.0f;

        for (unsigned t = 0; t < TED4_TYPES; t++) {
            *ref_bias(&w, s->first_step_output + t) = t % 2 ? out : 0.3f;
            for (unsigned c = 0; c < s->dim[t]; c += 4)
                *ref_bias(&w, s->first_output[t] + s->dim[t] + c) = out;
        }
        check_all(&w, 1);
        assert_true(pts.n_clamped > 5 * pts.n);
        assert_true(pts.n_open > pts.n);
        assert_true(pts.n_open < pts.n_clamped);
        ref_world_finish(&w);
    }
}

/* Values far out in the tail, some with sigma at its lower limit: the gradient is finite and
 * correct (annex D.1, traps). */
static void test_outliers(void **state)
{
    static ref_world w;
    const ted4_header h = ref_header();

    (void)state;
    ref_world_make(&w, &h);
    const ted4_layout *l = &w.layout;

    for (int t = 0; t < TED4_TYPES; t++)
        for (unsigned c = 0; c < l->shape.dim[t]; c++) {
            *ref_bias(&w, l->shape.first_output[t] + l->shape.dim[t] + c) = -2.0f - (float)(c % 3);
            for (int j = 0; j < TED4_LANES; j++)
                for (int i = 0; i < REF_BLOCKS; i++)
                    w.attr[i][((size_t)l->first[t] + c) * TED4_LANES + (size_t)j] *=
                        t == TED4_FEATURE ? 4.0f
                        : j % 2           ? 5.0f
                                          : 200.0f;
        }
    check_all(&w, 1);
    ref_world_finish(&w);
}

/* A pruned anchor contributes nothing except the gradient that drops, or keeps, its offsets. */
static void test_all_masked(void **state)
{
    static ref_world w;
    const ted4_header h = ref_header();
    double bits[TED4_TYPES];

    (void)state;
    ref_world_make(&w, &h);
    for (int k = 0; k < h.n_offsets; k++)
        for (int j = 0; j < TED4_LANES; j++)
            for (int i = 0; i < REF_BLOCKS; i++)
                w.attr[i][(w.layout.offset_logit + k) * TED4_LANES + j] = -5.0f;
    w.in.distortion_weight = 0.0f;
    check_all(&w, 7);
    assert_int_equal(ref_run(&w, NULL, bits), 0);
    for (int t = 0; t < TED4_TYPES; t++)
        assert_true(bits[t] == 0.0);
    assert_true(w.d_attr[0][w.layout.offset_logit * TED4_LANES] > 0.0f);
    ref_world_finish(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_points), cmocka_unit_test(test_variants),
        cmocka_unit_test(test_clamped),       cmocka_unit_test(test_outliers),
        cmocka_unit_test(test_all_masked),
    };

    return cmocka_run_group_tests_name("rate_grad", tests, NULL, NULL);
}
