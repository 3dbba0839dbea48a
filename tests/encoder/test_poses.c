/* test_poses.c - train/pose/pose.c and train/step/pose_step.c: which pictures share a pose, the
 * motions of the whole scene, and whether refinement finds wrong poses. That right ones are put
 * back: test_pose_trial.c; the gradient: test_step_grad.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ball_group.h"
#include "pose_ref.h"
#include "pose_training.h"
#include "random_source.h"
#include "test.h"
#include "train/model/normalise.h"
#include "train/monitor/checkpoint.h"
#include "train/state/picture.h"
#include "train/step/pose_step.h"

enum { MOST = 8 };

/* ---- cameras made by hand ---- */

typedef struct {
    ted4_picture picture[MOST];
    ted4_dataset data;
    ted4_header head;
    random_source random;
} rig;

static double uniform(rig *r)
{
    return (double)random_float(&r->random, -1, 1);
}

/* n pictures of one camera each, anywhere and turned anyhow. */
static void make_rig(rig *r, size_t n)
{
    memset(r, 0, sizeof *r);
    r->random = random_seed(7);
    r->data.pictures = r->picture;
    r->data.n_pictures = n;
    r->data.n_cameras = (uint32_t)n;
    r->data.n_frames = 1;
    r->head.exponent = 1;
    r->head.origin[0] = 0.5f;
    r->head.origin[2] = -0.25f;
    for (size_t i = 0; i < n; i++) {
        ted4_camera *c = &r->picture[i].camera;
        double turn[3];

        *c = (ted4_camera) { .width = 40, .height = 30, .fx = 40, .fy = 40, .cx = 20, .cy = 15 };
        r->picture[i].camera_id = (uint32_t)i;
        for (int k = 0; k < 3; k++) {
            turn[k] = 2 * uniform(r);
            c->t[k] = 5 * uniform(r);
        }
        ref_exponential(turn, c->R);
    }
}

static ted4_poses poses_of(const rig *r)
{
    ted4_poses p;

    assert_int_equal(ted4_poses_init(&p, &r->data, &r->head), 0);
    return p;
}

static void expect_poses(const rig *r, size_t n, const uint32_t *of)
{
    ted4_poses p = poses_of(r);

    assert_int_equal(p.n, n);
    for (size_t i = 0; n > 0 && i < r->data.n_pictures; i++)
        assert_int_equal(p.of[i], of[i]);
    for (uint32_t k = 0; k < n; k++)
        assert_int_equal(p.of[p.picture[k]], k);
    ted4_poses_finish(&p);
}

/* A camera that stands still has one pose, one that moves has one for each picture; held-out
 * pictures have none and do not decide whether a camera stands still. */
static void test_sharing(void **state)
{
    rig r;

    (void)state;
    make_rig(&r, 6);
    expect_poses(&r, 6, ((const uint32_t[]) { 0, 1, 2, 3, 4, 5 }));
    r.data.n_cameras = 2;
    for (size_t i = 0; i < 6; i++)
        r.picture[i].camera_id = (uint32_t)i % 2;
    expect_poses(&r, 6, ((const uint32_t[]) { 0, 1, 2, 3, 4, 5 }));
    r.picture[3].camera = r.picture[5].camera = r.picture[1].camera;
    expect_poses(&r, 4, ((const uint32_t[]) { 0, 1, 2, 1, 3, 1 }));
    r.picture[5].camera.t[0] += 1;
    r.picture[5].is_test = 1;
    expect_poses(&r, 4, ((const uint32_t[]) { 0, 1, 2, 1, 3, 4 }));
}

/* With one pose, every motion is one of the whole scene. */
static void test_too_few(void **state)
{
    rig r;

    (void)state;
    make_rig(&r, 1);
    expect_poses(&r, 0, NULL);
    make_rig(&r, 3);
    r.picture[1].is_test = r.picture[2].is_test = 1;
    expect_poses(&r, 0, NULL);
    r.picture[2].is_test = 0;
    expect_poses(&r, 2, ((const uint32_t[]) { 0, 2, 1 }));

    /* Nothing reads the pictures of such a scene. */
    ted4_poses none = { 0 };
    ted4_camera c = r.picture[0].camera;

    assert_false(ted4_poses_learnt(&none));
    assert_true(ted4_poses_finite(&none));
    ted4_pose_move(&none, 0, &c);
    ted4_poses_fix_gauge(&none);
    ted4_poses_put_back(&none);
    ted4_poses_finish(&none);
    assert_memory_equal(&c, &r.picture[0].camera, sizeof c);
}

/* ---- motions of the whole scene ---- */

/* Motion k of the scene by size, of a point of normalised space. */
static void move_point(int k, double size, const double *x, double *to)
{
    double w[3] = { 0 }, turn[9];

    if (k < 3)
        w[k] = size;
    ref_exponential(w, turn);
    for (int i = 0; i < 3; i++) {
        to[i] = turn[3 * i] * x[0] + turn[3 * i + 1] * x[1] + turn[3 * i + 2] * x[2];
        to[i] = k == 6 ? to[i] * (1 + size) : to[i] + (k == 3 + i ? size : 0);
    }
}

/* The same as a motion of a pose, by central differences: the pose (w, u) after which the camera
 * has the moved points where it had the points before, but for the size of what it sees. */
static void scene_motion(const rig *r, int k, const ted4_camera *c, double *to)
{
    const double size = 1e-5, none[TED4_POSE_VALUES] = { 0 };
    double R[2][9], t[2][3], turn[9];
    ref_pose p;

    ref_pose_of(&r->head, c, none, &p);
    for (int s = 0; s < 2; s++) {
        const double way = s == 0 ? size : -size, zero[3] = { 0 };
        double back[3], column[3];

        /* R' x' + t' = (1 + scale) (R x + t) for all x. */
        for (int j = 0; j < 3; j++) {
            double axis[3] = { 0 }, from[3];

            axis[j] = 1;
            move_point(k, -way, axis, column);
            move_point(k, -way, zero, from);
            for (int i = 0; i < 3; i++)
                R[s][3 * i + j] = 0;
            for (int i = 0; i < 3; i++)
                for (int m = 0; m < 3; m++)
                    R[s][3 * i + j] += p.R[3 * i + m] * (column[m] - from[m]);
        }
        move_point(k, -way, zero, back);
        for (int i = 0; i < 3; i++)
            t[s][i] = p.t[i] + p.R[3 * i] * back[0] + p.R[3 * i + 1] * back[1] +
                      p.R[3 * i + 2] * back[2];
        if (k == 6)
            for (int i = 0; i < 9; i++) {
                R[s][i] *= 1 + way;
                t[s][i % 3] *= i < 3 ? 1 + way : 1;
            }
    }
    /* dR R^T is the matrix of w; t' = exp(w) t + u. */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            turn[3 * i + j] = 0;
            for (int m = 0; m < 3; m++)
                turn[3 * i + j] += (R[0][3 * i + m] - R[1][3 * i + m]) / (2 * size) *
                                   p.R[3 * j + m];
        }
    to[0] = turn[7];
    to[1] = turn[2];
    to[2] = turn[3];
    for (int i = 0; i < 3; i++)
        to[3 + i] = (t[0][i] - t[1][i]) / (2 * size) -
                    (turn[3 * i] * p.t[0] + turn[3 * i + 1] * p.t[1] + turn[3 * i + 2] * p.t[2]);
}

/* Returns the cosine between the motions of all poses and motion k of the whole scene. */
static double share_of(const rig *r, const ted4_poses *p, int k)
{
    double along = 0, mine = 0, scene = 0;

    for (size_t i = 0; i < p->n; i++) {
        double x[TED4_POSE_VALUES];

        scene_motion(r, k, &r->data.pictures[p->picture[i]].camera, x);
        for (int c = 0; c < TED4_POSE_VALUES; c++) {
            along += x[c] * (double)p->value[i][c];
            mine += (double)p->value[i][c] * (double)p->value[i][c];
            scene += x[c] * x[c];
        }
    }
    return along / sqrt(mine * scene + 1e-300);
}

/* Motions of the whole scene vanish, and nothing is left of them in any others. */
static void check_gauge(rig *r, int n_gauges)
{
    ted4_poses p = poses_of(r);

    assert_int_equal(p.n_gauges, n_gauges);
    for (int k = 0; k < TED4_POSE_GAUGES; k++) {
        for (size_t i = 0; i < p.n; i++) {
            double x[TED4_POSE_VALUES];

            scene_motion(r, k, &r->picture[i].camera, x);
            for (int c = 0; c < TED4_POSE_VALUES; c++)
                p.value[i][c] = (float)x[c];
        }
        ted4_poses_fix_gauge(&p);
        for (size_t i = 0; i < p.n; i++)
            for (int c = 0; c < TED4_POSE_VALUES; c++)
                assert_true(fabsf(p.value[i][c]) < 1e-5f);
    }
    for (size_t i = 0; i < p.n; i++)
        for (int c = 0; c < TED4_POSE_VALUES; c++)
            p.value[i][c] = (float)uniform(r);
    ted4_poses_fix_gauge(&p);
    for (int k = 0; k < TED4_POSE_GAUGES; k++)
        assert_true(fabs(share_of(r, &p, k)) < 1e-6);
    ted4_poses_finish(&p);
}

static void test_gauge(void **state)
{
    rig r;

    (void)state;
    make_rig(&r, 2);
    check_gauge(&r, 7);
    make_rig(&r, MOST);
    check_gauge(&r, 7);
    /* All cameras at one place: growth about it is a translation. */
    for (size_t i = 0; i < MOST; i++) {
        ted4_camera *c = &r.picture[i].camera;

        for (int k = 0; k < 3; k++)
            c->t[k] = -(c->R[3 * k] * 1.5 + c->R[3 * k + 1] * 0.5 - c->R[3 * k + 2]);
    }
    check_gauge(&r, 6);
}

/* ---- trainings ---- */

/* Turns every camera by about a pixel, each its own way. */
static void shake(ted4_dataset *d)
{
    static const double by[BALL_CAMERAS][3] = {
        { 0.03, -0.02, 0.01 }, { -0.02, 0.03, 0 }, { 0.01, 0.03, -0.02 }, { -0.03, -0.01, 0.02 }
    };

    for (size_t i = 0; i < d->n_pictures; i++) {
        ted4_camera *c = &d->pictures[i].camera;
        double turn[9], R[9], t[3];

        ref_exponential(by[d->pictures[i].camera_id], turn);
        ref_product(turn, c->R, R);
        for (int k = 0; k < 3; k++)
            t[k] = turn[3 * k] * c->t[0] + turn[3 * k + 1] * c->t[1] + turn[3 * k + 2] * c->t[2];
        memcpy(c->R, R, sizeof R);
        memcpy(c->t, t, sizeof t);
    }
}

/* Returns the mean square of the differences between rotations, relative to that of the first
 * camera, so that a rotation of the whole scene does not count. */
static double error_of(const ted4_trainer *t, const ted4_dataset *truth)
{
    double sum = 0, first[9];

    for (size_t i = 0; i < t->poses.n; i++) {
        const uint32_t item = t->poses.picture[i];
        ted4_camera c = t->data->pictures[item].camera;
        const double *want = truth->pictures[item].camera.R;
        double between[9], back[9];

        ted4_pose_move(&t->poses, item, &c);
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                between[3 * a + b] = 0;
                for (int k = 0; k < 3; k++)
                    between[3 * a + b] += want[3 * k + a] * c.R[3 * k + b];
            }
        if (i == 0)
            memcpy(first, between, sizeof first);
        for (int k = 0; k < 9; k++)
            back[k] = between[k] - first[k];
        for (int k = 0; k < 9; k++)
            sum += back[k] * back[k];
    }
    return sum;
}

/* Wrong poses are found, pictures are rendered better than from the given ones, and the world stays
 * where it is. */
static void test_wrong(void **state)
{
    ted4_train_options o = pose_options();
    tiny_folder f;
    ted4_dataset d;
    ted4_trainer t, given;

    (void)state;
    ball_load(&f, &d, FRAMES, 1);
    shake(&d);
    ball_begin(&t, &o, &d, NULL);

    const double before = error_of(&t, &balls);

    ball_train(&t, STAGE1);
    assert_int_equal(t.poses.decision, TED4_POSES_REFINED);
    assert_true(t.poses.moved > 0.25);
    assert_true(error_of(&t, &balls) < 0.5 * before);

    rig r = { .data = d, .head = t.layout.head };

    for (int k = 0; k < TED4_POSE_GAUGES; k++)
        assert_true(fabs(share_of(&r, &t.poses, k)) < 1e-6);
    ball_set(&o, "poses=0");
    ball_begin(&given, &o, &d, NULL);
    ball_train(&given, STAGE1);
    assert_true(t.progress.loss < 0.5 * given.progress.loss);
    ted4_trainer_finish(&given);
    ted4_trainer_finish(&t);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* A training that is resumed in each part of the trial, and once more after it, equals one that is
 * not. */
static void test_resumed(void **state)
{
    static const uint64_t ends[] = { FREE / 2, FREE + 100, DECIDED + 50, DECIDED + 150 };
    enum { PARTS = sizeof ends / sizeof *ends };
    const ted4_train_options o = pose_options();
    tiny_folder f;
    ted4_dataset d;
    ted4_trainer whole, t;
    ted4_snapshot s = { 0 };

    (void)state;
    ball_load(&f, &d, FRAMES, 1);
    shake(&d);
    ball_begin(&whole, &o, &d, NULL);
    ball_train(&whole, ends[PARTS - 1]);
    for (int part = 0; part < PARTS; part++) {
        ball_begin(&t, &o, &d, NULL);
        if (part > 0)
            assert_int_equal(ted4_snapshot_restore(&t, &s), 0);
        ball_train(&t, ends[part]);
        assert_int_equal(t.poses.decision, part == 0   ? TED4_POSES_ON_TRIAL
                                           : part == 1 ? TED4_POSES_WITH_PRIOR
                                                       : TED4_POSES_REFINED);
        if (part == PARTS - 1)
            break;
        assert_int_equal(ted4_snapshot_take(&t, &s), 0);
        ted4_trainer_finish(&t);
    }
    assert_true(t.poses.moved == whole.poses.moved);
    assert_memory_equal(t.poses.value, whole.poses.value, t.poses.n * sizeof *t.poses.value);
    assert_memory_equal(t.poses.v, whole.poses.v, t.poses.n * sizeof *t.poses.v);
    assert_memory_equal(t.net.value, whole.net.value, t.layout.n_net * sizeof *t.net.value);
    ted4_snapshot_free(&s);
    ted4_trainer_finish(&t);
    ted4_trainer_finish(&whole);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* Several pictures of one pose in one step: the gradients add up, and it is one step of Adam. */
static void test_batch(void **state)
{
    const ted4_train_options o = pose_options();
    ted4_trainer t;
    ted4_pose_motion once;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, 5);
    assert_int_equal(t.poses.of[0], 0);
    assert_int_equal(t.poses.of[1], 0);
    for (int k = 0; k < 2; k++) {
        ted4_view v;
        ted4_generate_input in;
        ted4_splats s;

        assert_int_equal(ted4_trainer_render(&t, &balls.pictures[0], TED4_PASS_STEP, &v, &in, &s),
                         0);
        memset(t.work.d_image, 0, 3 * BALL_W * BALL_H * sizeof *t.work.d_image);
        t.work.d_image[BALL_W * BALL_H / 2 + BALL_W / 2] = 1;
        assert_int_equal(ted4_trainer_render_backward(&t, &v, &s), 0);
        assert_int_equal(ted4_generate_backward(t.work.generator, &in, &t.work.splat_gradient, NULL,
                                                t.visible_blocks.gradient, t.net.gradient),
                         0);
        ted4_pose_motion gradient;

        ted4_pose_gradient(&t, &balls.pictures[k], &v, &s, gradient);
        ted4_pose_add(&t, &balls.pictures[k], gradient);
        if (k == 0)
            memcpy(once, t.poses.gradient[0], sizeof once);
    }

    const uint64_t steps = t.poses.steps[0], others = t.poses.steps[1];

    for (int k = 0; k < TED4_POSE_VALUES; k++)
        assert_true(t.poses.gradient[0][k] == 2 * once[k]);
    ted4_update_poses(&t);
    assert_int_equal(t.poses.steps[0], steps + 1);
    assert_int_equal(t.poses.steps[1], others);
    for (int k = 0; k < TED4_POSE_VALUES; k++)
        assert_true(t.poses.gradient[0][k] == 0);
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sharing), cmocka_unit_test(test_too_few),
        cmocka_unit_test(test_gauge),   cmocka_unit_test(test_wrong),
        cmocka_unit_test(test_resumed), cmocka_unit_test(test_batch),
    };

    return cmocka_run_group_tests_name("poses", tests, set_up, tear_down);
}
