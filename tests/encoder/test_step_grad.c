/* test_step_grad.c - the gradient of a whole training step, composed as in train/step/step.c: the
 * distortion as a function of the camera's pose, the rasteriser, the generator and, in stage 2, the
 * quantiser, plus the rate. Its products with random directions, in each part of the model and in
 * all at once, are compared with central differences of double-precision references. Quantisation
 * residuals are held fixed; masks are straight-through.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "generate_ref.h"
#include "larger.h"
#include "loss_ref.h"
#include "pose_ref.h"
#include "raster_ref.h"
#include "rate_ref.h"
#include "train/model/normalise.h"
#include "train/pose/pose_grad.h"
#include "train/raster/raster_bwd.h"
#include "train/splat/generator.h"
#include "render/raster_plain.h"
#include "train/loss/loss.h"
#include "train/math/random.h"

enum {
    WIDTH = 32,
    HEIGHT = 24,
    PIXELS = WIDTH * HEIGHT,
    N_BLOCKS = 2,
    OFFSETS = 3,
    ANCHORS = 40,
    SPLATS = N_BLOCKS * OFFSETS * TED4_LANES,
    MAX_THETA = 12000
};

#define SSIM_WEIGHT 0.3f
/* Step of the difference, and the largest relative disagreement of its two halves: a jump appears
 * as jump / STEP, and half of it in the difference. */
#define STEP        1e-7
#define JUMP_SHARE  (2 * TOLERANCE)
/* Tolerance between float gradients and double differences, by the size of the product's terms. */
#define TOLERANCE   1e-4

/* All parameters are in one array: the networks, followed by blocks of channels in the order of
 * train/model/model.h, followed by the motion of the camera's pose. */
typedef struct {
    ted4_layout layout;
    ted4_camera given;
    ted4_poses poses; /* one; borrows the next four */
    uint32_t pose;
    uint8_t seen;
    ted4_pose_motion motion, d_motion;
    ted4_view view; /* of the moved camera */
    float camera[3];
    uint32_t num, den;
    int activation, stage2;
    float bit_weight;
    uint64_t key;
    size_t n_model, n_theta; /* without and with the pose */
    uint32_t lanes[N_BLOCKS], block[N_BLOCKS];
    uint8_t truth[3 * PIXELS];
    _Alignas(64) float position[N_BLOCKS][3 * TED4_LANES];
    _Alignas(64) float steps[N_BLOCKS][TED4_TYPES * TED4_LANES];
    _Alignas(64) float net[MAX_THETA], attr[MAX_THETA], used[MAX_THETA];
    _Alignas(64) float d_net[MAX_THETA], d_attr[MAX_THETA];
    double theta[MAX_THETA], moved[MAX_THETA], gradient[MAX_THETA], residual[MAX_THETA];
    double splat[SPLATS][REF_SPLAT];
    float image[3 * PIXELS], d_image[3 * PIXELS];
} problem;

static problem pr;

static size_t channel_at(int visible, int channel, int lane)
{
    return ((size_t)visible * (size_t)pr.layout.n_channels + (size_t)channel) * TED4_LANES +
           (size_t)lane;
}

static int is_used(int visible, int lane)
{
    return pr.lanes[visible] >> lane & 1;
}

/* ---- a random model ---- */

static ted4_header make_head(void)
{
    ted4_header h = ref_header();

    h.n_offsets = OFFSETS;
    h.feature_dim = 8;
    h.slice[2] = 5;
    h.phi_dim = 3;
    h.bank_rows = 5;
    h.bank_dim = 6;
    h.deform_layers = 2;
    h.deform_width = 7;
    h.view = TED4_VIEW_COLOUR;
    h.head_layers = 1;
    h.head_width = 9;
    h.frames = 9;
    h.step[TED4_FEATURE] = 0.3f;
    h.exponent = 1;
    h.origin[0] = 0.5f;
    h.background[2] = 200;
    return h;
}

static void make_anchor(int visible, int j)
{
    const ted4_layout *l = &pr.layout;
    float *a = pr.attr + channel_at(visible, 0, j);
    const int tau = l->first[TED4_TAU], scaling = l->first[TED4_SCALING];

    for (int c = 0; c < l->n_channels; c++)
        a[c * TED4_LANES] = (float)ref_uniform();
    for (int c = 0; c < 6; c++)
        a[(scaling + c) * TED4_LANES] = (float)(-1.8 + 0.7 * ref_uniform());
    /* The plateau lies around the middle of the sequence. */
    a[tau * TED4_LANES] = (float)(0.35 + 0.15 * ref_uniform());
    a[(tau + 2) * TED4_LANES] = (float)(0.65 + 0.1 * ref_uniform());
    a[(tau + 1) * TED4_LANES] -= 1.0f;
    a[(tau + 3) * TED4_LANES] -= 1.0f;
    for (int c = l->offset_logit; c < l->n_channels; c++)
        a[c * TED4_LANES] = (float)(-3.0 + 3.0 * ref_uniform());
    for (int c = 0; c < 3; c++)
        pr.position[visible][c * TED4_LANES + j] =
            ted4_half_to_float(ted4_float_to_half((float)ref_uniform()));
}

/* The camera is far enough from where it was given for exp to matter. The origin of normalised
 * space is not that of the world, and a unit of it is 2 units of the world. */
static void make_view(void)
{
    const double a = 0.3, c = cos(a), s = sin(a);
    ted4_camera moved;

    pr.given = (ted4_camera) {
        WIDTH, HEIGHT, 34, 36, 15, 12.5, { c, 0, -s, 0, 1, 0, s, 0, c }, { -0.6, -0.25, 5.4 }
    };
    pr.poses = (ted4_poses) { .n = 1,
                              .of = &pr.pose,
                              .value = &pr.motion,
                              .gradient = &pr.d_motion,
                              .seen = &pr.seen,
                              .unit = 2.0 };
    moved = pr.given;
    for (int i = 0; i < TED4_POSE_VALUES; i++) {
        pr.motion[i] = (float)(0.3 * ref_uniform());
        pr.theta[pr.n_model + (size_t)i] = (double)pr.motion[i];
    }
    ted4_pose_move(&pr.poses, 0, &moved);
    ted4_normalise_view(&pr.layout.head, &moved, &pr.view, pr.camera);
}

static void make(uint32_t seed, uint32_t num, int activation, int stage2)
{
    const ted4_header h = make_head();

    memset(&pr, 0, sizeof pr);
    ref_source = random_seed(77u * seed + 5u);
    ted4_layout_make(&pr.layout, &h);
    pr.n_model = pr.layout.n_net + channel_at(N_BLOCKS, 0, 0);
    pr.n_theta = pr.n_model + TED4_POSE_VALUES;
    assert_true(pr.n_theta <= MAX_THETA);
    assert_true(pr.layout.shape.n_nete <= REF_MAX_NET);
    pr.num = num;
    pr.den = h.frames - 1;
    pr.activation = activation;
    pr.stage2 = stage2;
    pr.bit_weight = 2e-4f;
    pr.key = seed;
    pr.lanes[0] = 0xdb6db7dfu;
    pr.lanes[1] = 0x00f3cf3cu;
    for (int i = 0; i < N_BLOCKS; i++)
        pr.block[i] = 11u + 7u * (uint32_t)i;
    for (size_t i = 0; i < pr.layout.n_net; i++)
        pr.net[i] = (float)((i < pr.layout.nete ? 0.7 : 0.4) * ref_uniform());
    /* Biases of the opacity head for which enough Gaussians are visible. */
    for (size_t i = 1; i <= OFFSETS; i++)
        pr.net[pr.layout.shape.netr[TED4_NET_COVARIANCE].first - i] = 0.5f;
    for (int i = 0; i < N_BLOCKS; i++)
        for (int j = 0; j < TED4_LANES; j++)
            make_anchor(i, j);
    for (size_t i = 0; i < 3 * PIXELS; i++)
        pr.truth[i] = (uint8_t)(128.0 + 40.0 * ref_uniform() +
                                60.0 * sin((double)(i / 3 % WIDTH) * 0.5 + (double)(i % 3)));
    make_view();
    for (size_t i = 0; i < pr.n_model; i++)
        pr.theta[i] = (double)(i < pr.layout.n_net ? pr.net[i] : pr.attr[i - pr.layout.n_net]);
}

/* ---- the analytic gradient ---- */

typedef struct {
    const float *attr[N_BLOCKS], *used[N_BLOCKS], *position[N_BLOCKS];
    float *d_attr[N_BLOCKS], *steps[N_BLOCKS];
} lists;

static lists make_lists(void)
{
    lists l;

    for (int i = 0; i < N_BLOCKS; i++) {
        l.attr[i] = pr.attr + channel_at(i, 0, 0);
        l.used[i] = (pr.stage2 ? pr.used : pr.attr) + channel_at(i, 0, 0);
        l.position[i] = pr.position[i];
        l.d_attr[i] = pr.d_attr + channel_at(i, 0, 0);
        l.steps[i] = pr.steps[i];
    }
    return l;
}

static ted4_rate_input rate_input(const lists *l)
{
    return (ted4_rate_input) { &pr.layout,    pr.net,   NULL,     N_BLOCKS, l->attr,
                               l->position,   pr.lanes, pr.block, pr.key,   TED4_QUANT_NOISE,
                               pr.bit_weight, 1.0f,     1,        NULL };
}

/* Computes the values as rendered, and the residuals in units of their steps. */
static void quantise(ted4_rate *rate, const lists *l)
{
    const ted4_rate_input in = rate_input(l);

    ted4_rate_pack(rate, pr.net);
    assert_int_equal(ted4_rate_evaluate(rate, &in, NULL, NULL, NULL, NULL, l->steps, NULL), 0);
    for (int i = 0; i < N_BLOCKS; i++) {
        ted4_quantise(&pr.layout, TED4_QUANT_NOISE, l->attr[i], l->steps[i], pr.block[i], pr.key,
                      pr.used + channel_at(i, 0, 0));
        for (int t = 0; t < TED4_TYPES; t++)
            for (int c = 0; c < (int)pr.layout.shape.dim[t]; c++)
                for (int j = 0; j < TED4_LANES; j++) {
                    const size_t at = channel_at(i, pr.layout.first[t] + c, j);

                    pr.residual[at] = ((double)pr.used[at] - (double)pr.attr[at]) /
                                      (double)pr.steps[i][t * TED4_LANES + j];
                }
    }
}

/* Takes d_image; fills d_attr and d_net with the gradient of the distortion. */
static void distortion_backward(ted4_raster *raster, ted4_generator *g,
                                const ted4_generate_input *in, const ted4_splats *s,
                                float *const *d_attr)
{
    static float of_splat[15][SPLATS];
    static uint8_t visible[SPLATS];
    ted4_splat_grads gr = { .opacity = of_splat[10], .mean2d = of_splat[14], .visible = visible };

    for (int c = 0; c < 3; c++) {
        gr.mean[c] = of_splat[c];
        gr.scale[c] = of_splat[3 + c];
        gr.colour[c] = of_splat[11 + c];
    }
    for (int c = 0; c < 4; c++)
        gr.rot[c] = of_splat[6 + c];
    ted4_adjoint *adjoint = ted4_adjoint_new();
    assert_int_equal(ted4_raster_backward(adjoint, raster, s, &pr.view, NULL, pr.d_image, &gr), 0);
    ted4_adjoint_free(adjoint);
    assert_int_equal(ted4_generate_backward(g, in, &gr, NULL, d_attr, pr.d_net), 0);
    ted4_pose_backward(&pr.poses, 0, &pr.view, s, &gr, ted4_generate_camera_gradient(g), NULL,
                       pr.poses.gradient[0]);
}

/* Fills the gradient, residuals and image; returns the loss. */
static double analytic(void)
{
    const lists l = make_lists();
    ted4_generator *g = ted4_generator_new(&pr.layout);
    ted4_rate *rate = ted4_rate_new(&pr.layout);
    ted4_raster *raster = ted4_raster_new();
    ted4_loss_workspace *w = ted4_loss_workspace_new();
    const ted4_generate_input in = {
        &pr.layout,    pr.net,     N_BLOCKS,
        l.used,        l.position, pr.lanes,
        pr.num,        pr.den,     { pr.camera[0], pr.camera[1], pr.camera[2] },
        pr.activation, 0,          NULL
    };
    ted4_splats s;
    double bits[TED4_TYPES], l1, ssim, loss;

    assert_non_null(g);
    assert_non_null(rate);
    assert_non_null(raster);
    assert_non_null(w);
    if (pr.stage2)
        quantise(rate, &l);
    ted4_generator_pack(g, pr.net);
    assert_int_equal(ted4_generate(g, &in, NULL, &s), 0);
    assert_int_equal(ted4_raster_forward(raster, &s, &pr.view, NULL, 1, pr.image), 0);
    loss =
        ted4_loss(w, pr.image, pr.truth, WIDTH, HEIGHT, SSIM_WEIGHT, NULL, pr.d_image, &l1, &ssim);
    memset(pr.d_net, 0, sizeof pr.d_net);
    distortion_backward(raster, g, &in, &s, l.d_attr);
    if (pr.stage2) {
        const ted4_rate_input r = rate_input(&l);

        assert_int_equal(ted4_rate_evaluate(rate, &r, NULL, (const float *const *)l.d_attr,
                                            l.d_attr, pr.d_net, l.steps, bits),
                         0);
        for (int t = 0; t < TED4_TYPES; t++)
            loss += (double)pr.bit_weight * bits[t];
    }
    for (size_t i = 0; i < pr.n_model; i++)
        pr.gradient[i] =
            (double)(i < pr.layout.n_net ? pr.d_net[i] : pr.d_attr[i - pr.layout.n_net]);
    for (size_t i = 0; i < TED4_POSE_VALUES; i++)
        pr.gradient[pr.n_model + i] = (double)pr.d_motion[i];
    ted4_generator_free(g);
    ted4_rate_free(rate);
    ted4_raster_free(raster);
    ted4_loss_workspace_free(w);
    return loss;
}

/* ---- the reference ---- */

/* Bits with straight-through masks. Stores the steps in *r. */
static double reference_bits(const double *theta, int visible, int j, ref_result *r)
{
    const ted4_layout *l = &pr.layout;
    const ref_model m = { l, theta + l->nete, 1.0, 0.0, 1 };
    ref_anchor a;

    memset(&a, 0, sizeof a);
    for (int c = 0; c < 3; c++)
        a.position[c] = (double)pr.position[visible][c * TED4_LANES + j];
    for (int c = 0; c < l->offset_logit; c++) {
        a.x[c] = theta[l->n_net + channel_at(visible, c, j)];
        a.n[c] = pr.residual[channel_at(visible, c, j)];
    }
    for (int c = l->offset_logit; c < l->n_channels; c++)
        a.logit[c - l->offset_logit] = pr.theta[l->n_net + channel_at(visible, c, j)];
    ref_evaluate(&m, &a, NULL, r);
    for (unsigned i = 0; i < l->shape.n_outputs; i++) { /* no output is near a limit */
        assert_true(r->raw[i] > -3.9);
        assert_true(r->raw[i] < 3.9);
    }

    double bits = r->loss;

    for (int k = 0; k <= OFFSETS; k++) {
        const size_t at = l->n_net + channel_at(visible, l->offset_logit + k, j);

        bits += (ref_sigmoid(theta[at]) - ref_sigmoid(pr.theta[at])) *
                (k < OFFSETS ? r->offset_bits[k] : r->phi_bits);
    }
    return bits;
}

/* The channels as the generator receives them. */
static void reference_values(const double *theta, const ref_result *r, int visible, int j,
                             double *x)
{
    const ted4_layout *l = &pr.layout;

    for (int c = 0; c < l->n_channels; c++)
        x[c] = theta[l->n_net + channel_at(visible, c, j)];
    for (int t = 0; t < TED4_TYPES && pr.stage2; t++)
        for (int c = l->first[t]; c < l->first[t] + (int)l->shape.dim[t]; c++)
            x[c] += r->steps[t] * pr.residual[channel_at(visible, c, j)];
}

/* The view of what ref_pose_splat has moved. */
static ted4_view in_camera_axes(void)
{
    ted4_view v = pr.view;

    memset(v.R, 0, sizeof v.R);
    memset(v.t, 0, sizeof v.t);
    v.R[0] = v.R[4] = v.R[8] = 1;
    return v;
}

static double reference(const double *theta)
{
    static double image[3 * PIXELS];
    const ted4_layout *l = &pr.layout;
    ref_query q = { l->head, pr.num, pr.den, { 0 }, pr.activation, theta, l->bank };
    ref_pose pose;
    double bits = 0, l1, ssim;
    size_t n = 0;

    ref_pose_of(&l->head, &pr.given, theta + pr.n_model, &pose);
    memcpy(q.camera, pose.centre, sizeof q.camera);
    for (int i = 0; i < N_BLOCKS; i++)
        for (int j = 0; j < TED4_LANES; j++) {
            double p[3], x[REF_MAX_CHANNELS], base[REF_MAX_CHANNELS];
            ref_result r;

            if (!is_used(i, j))
                continue;
            for (int c = 0; c < 3; c++)
                p[c] = (double)pr.position[i][c * TED4_LANES + j];
            if (pr.stage2)
                bits += reference_bits(theta, i, j, &r);
            reference_values(theta, &r, i, j, x);
            for (int c = 0; c < l->n_channels; c++)
                base[c] = pr.theta[l->n_net + channel_at(i, c, j)];
            ref_generate(&q, x, base, p, pr.splat + n);
            n += OFFSETS;
        }
    const ted4_view view = in_camera_axes();

    for (size_t i = 0; i < n; i++)
        ref_pose_splat(&pose, pr.splat[i]);
    const size_t seen = ref_render(&view, (const double(*)[REF_SPLAT])pr.splat, n, image);
    const ref_picture picture = { WIDTH, HEIGHT, image, pr.truth };

    assert_int_equal(n, ANCHORS * OFFSETS);
    assert_true(seen > ANCHORS / 2);
    return ref_distortion(&picture, (double)SSIM_WEIGHT, &l1, &ssim) + (double)pr.bit_weight * bits;
}

/* ---- directions ---- */

/* A part of the parameters: network values, or channels, [first, first + n). */
typedef struct {
    const char *name;
    size_t first, n;
    int is_channels;
} part;

enum { MAX_PARTS = 16 };

static size_t list_parts(part *p)
{
    static const char *const nets[TED4_NETS_R] = { "project", "deform", "opacity", "covariance",
                                                   "colour" };
    static const char *const types[TED4_TYPES] = { "feature", "scaling", "offset", "phi", "tau" };
    const ted4_layout *l = &pr.layout;
    size_t n = 0;

    for (int i = 0; i < TED4_NETS_R; i++) {
        const size_t end = i + 1 < TED4_NETS_R ? l->shape.netr[i + 1].first : l->shape.n_netr;

        p[n++] = (part) { nets[i], l->shape.netr[i].first, end - l->shape.netr[i].first, 0 };
    }
    p[n++] = (part) { "pose", pr.n_model, TED4_POSE_VALUES, 0 };
    p[n++] = (part) { "bank", l->bank, l->shape.n_bank, 0 };
    if (pr.stage2)
        p[n++] = (part) { "prior", l->nete, l->shape.n_nete, 0 };
    for (int t = 0; t < TED4_TYPES; t++)
        if (t != TED4_TAU || pr.activation)
            p[n++] = (part) { types[t], (size_t)l->first[t], l->shape.dim[t], 1 };
    p[n++] = (part) { "offset mask", (size_t)l->offset_logit, OFFSETS, 1 };
    p[n++] = (part) { "temporal mask", (size_t)l->temporal_logit, 1, 1 };
    return n;
}

/* Makes a random direction within a part, scaled so that the root of the sum of squares of its
 * terms of the product is 1. Returns 0 if the part has no gradient (tau, where all anchors are on
 * their plateau); the direction is then so long that any gradient would show. */
static int make_direction(const part *p, uint64_t key, double *own)
{
    double size = 0;

    memset(own, 0, MAX_THETA * sizeof *own);
    for (size_t i = 0; i < p->n && !p->is_channels; i++)
        own[p->first + i] = 2.0 * (double)ted4_uniform(key, i) - 1.0;
    for (size_t i = 0; i < p->n && p->is_channels; i++)
        for (int visible = 0; visible < N_BLOCKS; visible++)
            for (int j = 0; j < TED4_LANES; j++) {
                const size_t at = channel_at(visible, (int)(p->first + i), j);

                own[pr.layout.n_net + at] =
                    is_used(visible, j) ? 2.0 * (double)ted4_uniform(key, at) - 1.0 : 0.0;
            }
    for (size_t i = 0; i < pr.n_theta; i++)
        size += own[i] * own[i] * pr.gradient[i] * pr.gradient[i];
    for (size_t i = 0; i < pr.n_theta; i++)
        own[i] *= size > 0 ? 1.0 / sqrt(size) : 1e6;
    return size > 0;
}

static double moved(const double *direction, double step)
{
    for (size_t i = 0; i < pr.n_theta; i++)
        pr.moved[i] = pr.theta[i] + step * direction[i];
    return reference(pr.moved);
}

/* Directions that were tested, and those of them without a jump. */
static int n_directions, n_smooth;

/* size: of the terms of the product. */
static void check(const char *name, const double *direction, double size)
{
    double got = 0, longest = 0;

    for (size_t i = 0; i < pr.n_theta; i++) {
        got += pr.gradient[i] * direction[i];
        longest = larger(longest, fabs(direction[i]));
    }
    const double step = STEP / longest, here = reference(pr.theta);
    const double up = moved(direction, step) - here, down = here - moved(direction, -step);
    const double want = (up + down) / (2.0 * step);

    n_directions++;
    if (fabs(up - down) > JUMP_SHARE * size * step)
        return;
    n_smooth++;
    if (!(fabs(got - want) <= TOLERANCE * size))
        fail_msg("%s, time %u/%u: %g, should be %g", name, pr.num, pr.den, got, want);
}

static void check_all(void)
{
    static double all[MAX_THETA], one[MAX_THETA];
    part parts[MAX_PARTS];
    const size_t n = list_parts(parts);
    const double loss = analytic(), want = reference(pr.theta);

    assert_true(n <= MAX_PARTS);
    assert_true(fabs(loss - want) < 1e-5 * (1.0 + want));
    memset(all, 0, sizeof all);
    for (size_t i = 0; i < n; i++) {
        const int live = make_direction(&parts[i], ted4_mix(pr.key) + i, one);

        check(parts[i].name, one, 1.0);
        for (size_t k = 0; k < pr.n_theta && live; k++)
            all[k] += one[k];
    }
    check("all", all, sqrt((double)n));
}

/* ---- tests ---- */

/* Compares the double-precision renderer with the project's own. */
static void test_renderer(void **state)
{
    static float rounded[REF_SPLAT][SPLATS];
    static double image[3 * PIXELS], plain[3 * PIXELS];
    ted4_splats s = { .n = ANCHORS * OFFSETS, .opacity = rounded[10] };

    (void)state;
    make(1, 4, 1, 0);
    (void)reference(pr.theta);
    for (size_t i = 0; i < s.n; i++)
        for (int c = 0; c < REF_SPLAT; c++)
            rounded[c][i] = (float)pr.splat[i][c];
    for (size_t i = 0; i < s.n; i++)
        for (int c = 0; c < REF_SPLAT; c++)
            pr.splat[i][c] = (double)rounded[c][i];
    pr.view = in_camera_axes();
    for (int c = 0; c < 3; c++) {
        s.mean[c] = rounded[c];
        s.scale[c] = rounded[3 + c];
        s.colour[c] = rounded[11 + c];
    }
    for (int c = 0; c < 4; c++)
        s.rot[c] = rounded[6 + c];
    assert_int_equal(ted4_raster_plain(&s, &pr.view, plain), 0);
    assert_true(ref_render(&pr.view, (const double(*)[REF_SPLAT])pr.splat, s.n, image) > 30);
    for (size_t i = 0; i < 3 * PIXELS; i++)
        assert_true(fabs(image[i] - plain[i]) < 1e-9);
}

/* Times before, inside and after the plateau, on rows of the bank and between them. */
static const uint32_t times[] = { 0, 1, 3, 4, 5, 8 };

enum { N_TIMES = (int)(sizeof times / sizeof times[0]) };

static void check_times(int activation, int stage2)
{
    n_directions = n_smooth = 0;
    for (uint32_t i = 0; i < 2 * N_TIMES; i++) {
        make(10 * i + (uint32_t)stage2, times[i % N_TIMES], activation, stage2);
        check_all();
    }
    assert_true(n_smooth > n_directions * 8 / 10);
}

static void test_stage1(void **state)
{
    (void)state;
    check_times(1, 0);
}

static void test_static_phase(void **state)
{
    (void)state;
    check_times(0, 0);
}

static void test_stage2(void **state)
{
    (void)state;
    check_times(1, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_renderer),
        cmocka_unit_test(test_stage1),
        cmocka_unit_test(test_static_phase),
        cmocka_unit_test(test_stage2),
    };

    return cmocka_run_group_tests_name("step_grad", tests, NULL, NULL);
}
