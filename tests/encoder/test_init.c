/* test_init.c - initialisation: normalised space and views in it (train/model/normalise.h), anchors
 * from points (train/model/init.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "cloud_case.h"
#include "larger.h"
#include "train/math/voxel_set.h"
#include "train/model/init.h"
#include "train/model/normalise.h"
#include "train/step/trainer_init.h"

static cloud_case cloud;

/* ---- space ---- */

static void test_normalise_make(void **state)
{
    static float many[1000][3];
    ted4_header h;

    (void)state;
    memset(&h, 0, sizeof h);
    cloud_make(&cloud, 1);
    ted4_normalise_scene(&h, &cloud.data);
    /* The lattice extends 1.5 to either side; with a margin of a quarter, that is between 1 and
     * 2. */
    assert_true(h.origin[0] == 10.0f);
    assert_true(h.origin[1] == -4.0f);
    assert_true(h.origin[2] == 2.0f);
    assert_int_equal(h.exponent, 1);

    /* Three of a thousand points, far away, are ignored. */
    for (size_t i = 0; i < 1000; i++)
        for (size_t j = 0; j < 3; j++)
            many[i][j] = i % 400 == 7 ? 1e5f : 80.0f * ted4_uniform(3, 3 * i + j);
    cloud.data.points = many[0];
    cloud.data.n_points = 1000;
    ted4_normalise_scene(&h, &cloud.data);
    assert_int_equal(h.exponent, 6);
    for (int j = 0; j < 3; j++)
        assert_true(fabsf(h.origin[j] - 40.0f) < 4.0f);

    /* Degenerate clouds. */
    cloud.data.n_points = 1;
    ted4_normalise_scene(&h, &cloud.data);
    assert_int_equal(h.exponent, 0);
    assert_true(h.origin[0] == many[0][0]);
    cloud.data.n_points = 0;
    ted4_normalise_scene(&h, &cloud.data);
    assert_int_equal(h.exponent, 0);
    assert_true(h.origin[0] == 0.0f);
}

/* A camera with random rotation and position. */
static ted4_camera random_camera(uint64_t key)
{
    ted4_camera c = { 640, 480, 500, 520, 300, 250, { 0 }, { 0 } };
    double q[4], n = 0;

    for (uint64_t k = 0; k < 4; k++) {
        q[k] = (double)ted4_uniform(key, k) - 0.5;
        n += q[k] * q[k];
    }
    for (int k = 0; k < 4; k++)
        q[k] /= sqrt(n);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double R[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
        2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)
    };

    memcpy(c.R, R, sizeof R);
    for (uint64_t k = 0; k < 3; k++)
        c.t[k] = 20.0 * ((double)ted4_uniform(key, 10 + k) - 0.5);
    return c;
}

/* Asserts that a point has the same pixel through both cameras, and that the centre of the view is
 * the camera's position. */
static void check_point(const ted4_header *h, const ted4_camera *c, const float world[3])
{
    const double unit = ldexp(1.0, h->exponent);
    ted4_view v;
    float centre[3], p[3];
    double far[3], near[3];

    ted4_normalise_view(h, c, &v, centre);
    ted4_normalise_point(h, world, p);
    for (int i = 0; i < 3; i++) {
        far[i] = c->t[i];
        near[i] = (double)v.t[i];
        for (int j = 0; j < 3; j++) {
            far[i] += c->R[3 * i + j] * (double)world[j];
            near[i] += (double)v.R[3 * i + j] * (double)p[j];
        }
        assert_true(fabs(far[i] - unit * near[i]) < 1e-5 * (30.0 + unit));
    }
    for (int i = 0; i < 3; i++) {
        double back = (double)v.t[i];

        for (int j = 0; j < 3; j++)
            back += (double)v.R[3 * i + j] * (double)centre[j];
        assert_true(fabs(back) < 1e-5 * (1.0 + 30.0 / unit));
    }
    if (fabs(far[2]) < 1)
        return;
    assert_true(fabs(c->fx * far[0] / far[2] + c->cx -
                     ((double)v.fx * near[0] / near[2] + (double)v.cx)) < 0.02);
    assert_true(fabs(c->fy * far[1] / far[2] + c->cy -
                     ((double)v.fy * near[1] / near[2] + (double)v.cy)) < 0.02);
}

static void test_normalise_view(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        const ted4_camera c = random_camera(i);
        ted4_header h;
        ted4_view v;
        float centre[3], world[3];

        memset(&h, 0, sizeof h);
        h.exponent = (int8_t)(i % 7 - 2);
        h.background[1] = 255;
        for (uint64_t j = 0; j < 3; j++) {
            h.origin[j] = 10.0f * ted4_uniform(i, 20 + j) - 5.0f;
            world[j] = 10.0f * ted4_uniform(i, 30 + j) - 5.0f;
        }
        check_point(&h, &c, world);
        ted4_normalise_view(&h, &c, &v, centre);
        assert_int_equal(v.width, 640);
        assert_int_equal(v.height, 480);
        assert_true(v.near_z == TED4_NEAR);
        assert_true(v.background[0] == 0.0f);
        assert_true(v.background[1] == 1.0f);
    }
}

/* ---- anchors ---- */

static void check_values(const ted4_trainer *t, size_t i, float scale)
{
    const ted4_layout *l = &t->layout;
    const float tau[4] = { 0.0f, -3.3f, 1.0f, -3.3f };

    for (int c = 0; c < l->n_channels; c++) {
        const float x = *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, c);
        const int s = c - l->first[TED4_SCALING], a = c - l->first[TED4_TAU];

        if (s >= 0 && s < 6)
            assert_true(fabsf(x - scale) < 1e-5f);
        else if (l->first[TED4_TAU] >= 0 && a >= 0 && a < 4)
            assert_true(x == tau[a]);
        else if (c >= l->first[TED4_PHI] && c < l->first[TED4_PHI] + l->head.phi_dim)
            assert_true(fabsf(x) <= 0.5f);
        else
            assert_true(x == (c >= l->offset_logit ? 1.0f : 0.0f));
    }
}

/* The voxel size is the lattice's spacing: one anchor per point, at the point's position. */
static void test_lattice(void **state)
{
    (void)state;
    for (int single = 0; single < 2; single++) {
        ted4_trainer t;
        uint8_t seen[CLOUD_POINTS] = { 0 };

        cloud_make(&cloud, single ? 1 : 5);
        cloud_begin(&cloud, &t);
        assert_int_equal(t.anchors.n, CLOUD_POINTS);
        assert_true(fabs(t.voxel - 0.25) < 1e-6);
        assert_int_equal((t.layout.first[TED4_TAU] >= 0), !single);
        for (size_t i = 0; i < t.anchors.n; i++) {
            size_t found = 0;

            for (size_t k = 0; k < CLOUD_POINTS; k++) {
                float p[3];
                double far = 0;

                ted4_normalise_point(&t.layout.head, cloud.point[k], p);
                for (int j = 0; j < 3; j++)
                    far = larger(
                        far, fabsf(p[j] - *ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, i, j)));
                found += far < 1e-6 && !seen[k]++;
            }
            assert_int_equal(found, 1);
            check_values(&t, i, -2.0f);
        }
        ted4_trainer_finish(&t);
    }
}

/* Several points in a voxel become one anchor, at the voxel's centre; points outside the cube are
 * dropped. */
static void test_voxels(void **state)
{
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, 1);
    cloud.options.cell = 1.0; /* scene units: half a unit of normalised space */
    cloud.point[0][0] = 100;
    cloud_begin(&cloud, &t);
    assert_true(fabs(t.voxel - 0.5) < 1e-9);
    assert_true(t.anchors.n <= 4 * 4 * 4);
    assert_true(t.anchors.n >= 3 * 3 * 3);
    for (size_t i = 0; i < t.anchors.n; i++)
        for (int j = 0; j < 3; j++) {
            const float x = *ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, i, j);

            assert_true(x == rintf(2 * x) / 2);
            assert_true(fabsf(x) <= 1);
        }
    ted4_trainer_finish(&t);
}

/* The voxel size has a lower limit, so that different voxels never share a key. */
static void test_finest(void **state)
{
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, 1);
    cloud.options.cell = 1e-300;
    cloud_begin(&cloud, &t);
    assert_true(t.voxel == TED4_FINEST_VOXEL);
    assert_int_equal(t.anchors.n, CLOUD_POINTS);
    ted4_trainer_finish(&t);
}

static void test_bound(void **state)
{
    (void)state;
    for (int most = 1; most <= 100; most += 33) {
        ted4_trainer t;

        cloud_make(&cloud, 1);
        cloud.options.init_anchors = most;
        cloud_begin(&cloud, &t);
        assert_true(t.anchors.n >= 1);
        assert_true(t.anchors.n <= (size_t)most);
        assert_true(t.voxel > 0.25);
        ted4_trainer_finish(&t);
    }
}

/* By default half of max_anchors, or all of it where pictures are taken from fewer than three
 * places, whatever their times. */
static void test_default_bound(void **state)
{
    ted4_picture views[3];
    ted4_trainer t;

    (void)state;
    for (int places = 1; places <= 3; places++) {
        cloud_make(&cloud, 3);
        cloud.options.max_anchors = 101;
        for (uint32_t i = 0; i < 3; i++) {
            views[i] = cloud.picture;
            views[i].frame = i;
            views[i].camera.t[1] += (double)(i % (uint32_t)places);
        }
        cloud.data.pictures = views;
        cloud.data.n_pictures = 3;
        cloud_begin(&cloud, &t);
        assert_in_range(t.anchors.n, places < 3 ? 52 : 26, places < 3 ? 101 : 51);
        ted4_trainer_finish(&t);
    }
}

/* One point is enough; no point is refused with a message. */
static void test_few_points(void **state)
{
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, 1);
    cloud.data.n_points = 1;
    cloud_begin(&cloud, &t);
    assert_int_equal(t.anchors.n, 1);
    ted4_trainer_finish(&t);
    cloud.data.n_points = 0;
    assert_int_equal(ted4_trainer_init(&t, &cloud.options, &cloud.data, NULL), -1);
    assert_non_null(strstr(t.message.text, "no initial point"));
    ted4_trainer_finish(&t);
}

/* Networks are equal for equal seeds and differ otherwise; the last layer of F_deform is zero, so
 * that nothing moves at first. */
static void test_networks(void **state)
{
    ted4_trainer t, other;
    size_t same = 0;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    cloud_begin(&cloud, &other);
    assert_memory_equal(t.net.value, other.net.value, t.layout.n_net * sizeof *t.net.value);
    ted4_trainer_finish(&other);
    cloud.options.seed = 1;
    cloud_begin(&cloud, &other);
    for (size_t i = 0; i < t.layout.nete; i++)
        same += t.net.value[i] == other.net.value[i];

    const ted4_net_shape *deform = &t.layout.shape.netr[TED4_NET_DEFORM];
    const int last = deform->n_layers - 1;
    const size_t n = ((size_t)deform->dim[last] + 1) * deform->dim[last + 1];
    const size_t end = t.layout.shape.netr[TED4_NET_OPACITY].first;

    for (size_t i = end - n; i < end; i++)
        assert_true(t.net.value[i] == 0.0f);
    assert_true(t.net.value[end - n - deform->dim[last] - 1] != 0.0f);
    assert_true(same < n + 10);
    ted4_trainer_finish(&t);
    ted4_trainer_finish(&other);
}

/* Mean and standard deviation of n numbers. */
static void moments(const float *x, size_t n, double *mean, double *spread)
{
    double sum = 0, square = 0;

    for (size_t i = 0; i < n; i++) {
        sum += (double)x[i];
        square += (double)x[i] * (double)x[i];
    }
    *mean = sum / (double)n;
    *spread = sqrt(square / (double)n - *mean * *mean);
}

/* The bank begins as N(0, 0.1): within 5 standard deviations of both estimates. */
static void test_bank(void **state)
{
    ted4_trainer t;
    double mean, spread;

    (void)state;
    cloud_make(&cloud, 200);
    cloud.options.bank_dim = 64;
    cloud_begin(&cloud, &t);

    const double n = (double)t.layout.shape.n_bank;

    assert_true(n == 100 * 64);
    moments(t.net.value + t.layout.bank, t.layout.shape.n_bank, &mean, &spread);
    assert_true(fabs(mean) < 5 * 0.1 / sqrt(n));
    assert_true(fabs(spread - 0.1) < 5 * 0.1 / sqrt(2 * n));
    ted4_trainer_finish(&t);
}

/* Temporal features distinguish places, without any chance: each is a wave of amplitude 1/2 over
 * space. */
static void test_phi(void **state)
{
    static float x[CLOUD_POINTS];
    ted4_trainer t, other;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    cloud.options.seed = 1;
    cloud_begin(&cloud, &other);
    for (int c = 0; c < t.layout.head.phi_dim; c++) {
        double mean, spread;

        for (size_t i = 0; i < t.anchors.n; i++) {
            const int channel = t.layout.first[TED4_PHI] + c;

            x[i] = *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, channel);
            assert_true(fabsf(x[i]) <= 0.5f);
            assert_true(x[i] == *ted4_anchor_value(&other.anchors, TED4_ROW_VALUE, i, channel));
        }
        moments(x, t.anchors.n, &mean, &spread);
        assert_true(spread > 0.1);
    }
    ted4_trainer_finish(&t);
    ted4_trainer_finish(&other);
}

/* The biases of the hyperprior's last layer. */
static const float *prior_biases(const ted4_trainer *t)
{
    const ted4_net_shape *s = &t->layout.shape.hyper;
    size_t at = t->layout.nete + s->first;

    for (int i = 0; i < s->n_layers; i++)
        at += ((size_t)s->dim[i] + 1) * s->dim[i + 1];
    return t->net.value + at - s->dim[s->n_layers];
}

/* The prior begins with the mean and the spread of each component, in steps: half of the anchors
 * are above the mean by the spread, half below. The logarithm of the spread is held to [-1, 9]; the
 * steps begin at those of the header. */
static void test_prior(void **state)
{
    static const double spreads[] = { 0.01, 4, 1e5 }; /* in steps */
    static const double logs[] = { -1, 2, 9 };
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &t);
    assert_int_equal(t.anchors.n % 2, 0);
    for (int y = 0; y < TED4_TYPES; y++)
        for (unsigned c = 0; c < t.layout.shape.dim[y]; c++)
            for (size_t i = 0; i < t.anchors.n; i++)
                *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.first[y] + (int)c) =
                    t.layout.head.step[y] *
                    (float)(3.0 * c - y + (i % 2 ? 1 : -1) * spreads[c % 3]);
    ted4_init_prior(t.net.value, &t.layout, &t.anchors, 3);

    const float *bias = prior_biases(&t);

    for (int y = 0; y < TED4_TYPES; y++)
        for (unsigned c = 0; c < t.layout.shape.dim[y]; c++) {
            const unsigned at = t.layout.shape.first_output[y] + c;

            assert_true(fabs((double)bias[at] - (3.0 * c - y)) < 1e-3 + 1e-6 * spreads[c % 3]);
            assert_true(fabs((double)bias[at + t.layout.shape.dim[y]] - logs[c % 3]) < 1e-3);
        }
    for (unsigned k = 0; k < t.layout.shape.n_types; k++)
        assert_true(bias[t.layout.shape.first_step_output + k] == 0.0f);
    ted4_trainer_finish(&t);
}

/* Evaluates a network for inputs that are all zero: y, in double precision. */
static void answer(const float *w, const ted4_net_shape *s, double *y)
{
    double x[64] = { 0 };

    for (int i = 0; i < s->n_layers; i++) {
        const unsigned in = s->dim[i], out = s->dim[i + 1];

        assert_true(in <= 64);
        assert_true(out <= 64);
        for (unsigned k = 0; k < out; k++) {
            y[k] = (double)w[in * out + k];
            for (unsigned c = 0; c < in; c++)
                y[k] += (double)w[k * in + c] * x[c];
        }
        for (unsigned k = 0; k < out; k++)
            x[k] = y[k] > 0 ? y[k] : 0;
        w += (in + 1) * out;
    }
}

/* A Gaussian whose initial opacity were negative would never be drawn, so no seed may give one. */
static void test_awake(void **state)
{
    (void)state;
    cloud_make(&cloud, 5);
    for (uint32_t seed = 0; seed < 40; seed++) {
        ted4_trainer t;
        double y[64];

        cloud.options.seed = seed;
        cloud_begin(&cloud, &t);

        const ted4_net_shape *const s = &t.layout.shape.netr[TED4_NET_OPACITY];

        answer(t.net.value + t.layout.netr + s->first, s, y);
        for (int k = 0; k < t.layout.head.n_offsets; k++)
            if (!(y[k] > 0))
                fail_msg("seed %u: opacity %d begins at %g", seed, k, y[k]);
        ted4_trainer_finish(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normalise_make), cmocka_unit_test(test_normalise_view),
        cmocka_unit_test(test_lattice),        cmocka_unit_test(test_voxels),
        cmocka_unit_test(test_finest),         cmocka_unit_test(test_bound),
        cmocka_unit_test(test_default_bound),  cmocka_unit_test(test_few_points),
        cmocka_unit_test(test_networks),       cmocka_unit_test(test_awake),
        cmocka_unit_test(test_bank),           cmocka_unit_test(test_phi),
        cmocka_unit_test(test_prior),
    };

    return cmocka_run_group_tests_name("init", tests, NULL, NULL);
}
