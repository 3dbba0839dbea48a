/* pose_step.c - see pose_step.h. Results have the same bits on all machines: plain operations in
 * fixed order.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "pose_step.h"

#include <math.h>
#include <string.h>

#include "train/math/adam.h"
#include "train/model/normalise.h"
#include "train/monitor/grad_norm.h"
#include "train/pose/pose_grad.h"
#include "train/state/visible_blocks.h"

/* The angle by which a step of Adam turns a camera, in pixels at the centre of its picture; a
 * translation by as much of normalised space comes with it. */
#define STEP_PIXELS 0.02

/* The trial, in shares of stage 1: poses move freely at first, and then with a prior. By the end of
 * the first part, poses that are a pixel wrong have moved by most of it if they have had a hundred
 * steps. */
#define FREE  0.2
#define TRIAL 0.3

/* The root mean square of the pixels that poses have to move freely. Measured: 0.03 to 0.30 where
 * poses are right, to 0.5 on treadmill and with models that cannot move; and as much as they are
 * wrong from 0.2 pixels on (0.2 and 0.4 cost 1.3 and 3 dB unless they are refined). A pose that
 * only one picture determines follows what moves in it: 0.28 to 0.47 on dog, where refinement costs
 * 0.5 to 0.9 dB. */
#define WORTH       0.2
#define WORTH_ALONE 0.5
/* The share of that motion that has to remain with the prior. Measured: at least 0.84 where poses
 * are wrong, at most 0.62 where they are right. In a training of 1,000 steps, whose pictures are
 * blurred, 0.73 where they are wrong: there, the pixels that remain suffice. */
#define REMAINS     0.75
#define SUFFICE     0.5
/* Weight of the prior: the loss of a picture grows by half of this times the square of the pixels
 * by which its pose turns the camera, and so for the translation. With half of it, 0.2 to 0.3 of
 * the motion remains on treadmill; with 2.5 times as much, wrong poses keep 0.82. */
#define PRIOR       0.02

void ted4_pose_gradient(ted4_trainer *t, const ted4_picture *pic, const ted4_view *v,
                        const ted4_splats *s, ted4_pose_motion gradient)
{
    if (ted4_poses_learnt(&t->poses))
        ted4_pose_backward(&t->poses, (size_t)(pic - t->data->pictures), v, s,
                           &t->work.splat_gradient,
                           ted4_generate_camera_gradient(t->work.generator), t->parallel, gradient);
    else
        memset(gradient, 0, sizeof(ted4_pose_motion));
}

void ted4_pose_add(ted4_trainer *t, const ted4_picture *pic, const ted4_pose_motion gradient)
{
    ted4_poses *p = &t->poses;

    if (!ted4_poses_learnt(p))
        return;

    const size_t pose = p->of[pic - t->data->pictures];

    for (int i = 0; i < TED4_POSE_VALUES; i++)
        p->gradient[pose][i] += gradient[i];
    p->seen[pose] = 1;
}

/* Adds the gradient of the prior to that of a pose; focal: pixels per radian. */
static void add_prior(ted4_poses *p, size_t pose, double focal)
{
    for (int k = 0; k < TED4_POSE_VALUES; k++)
        p->gradient[pose][k] += (float)(PRIOR * focal * focal * (double)p->value[pose][k]);
}

void ted4_update_poses(ted4_trainer *t)
{
    ted4_poses *p = &t->poses;
    double square = 0;

    for (size_t i = 0; i < p->n; i++) {
        if (!p->seen[i])
            continue;

        const double norm = ted4_gradients_norm(p->gradient[i], TED4_POSE_VALUES);
        const double focal = t->data->pictures[p->picture[i]].camera.fx;
        const double rate = STEP_PIXELS / focal;

        square += norm * norm;
        if (p->decision == TED4_POSES_WITH_PRIOR)
            add_prior(p, i, focal);
        ted4_adam(p->value[i], p->m[i], p->v[i], p->gradient[i], TED4_POSE_VALUES,
                  (float)(rate * t->monitor.state.factor), ted4_adam_bias_make(++p->steps[i]));
        memset(p->gradient[i], 0, sizeof p->gradient[i]);
        p->seen[i] = 0;
    }
    if (square > 0)
        ted4_poses_fix_gauge(p);
    t->monitor.norm[TED4_TERM_POSE] = sqrt(square);
}

/* Computes where v shows a point, in pixels, in the picture or beside it. Returns 0 if the point is
 * not in front of the camera. */
static int project(const ted4_view *v, const float x[3], double at[2])
{
    double c[3];

    for (int i = 0; i < 3; i++)
        c[i] = (double)v->R[3 * i] * (double)x[0] + (double)v->R[3 * i + 1] * (double)x[1] +
               (double)v->R[3 * i + 2] * (double)x[2] + (double)v->t[i];
    at[0] = (double)v->fx * c[0] / c[2] + (double)v->cx;
    at[1] = (double)v->fy * c[1] / c[2] + (double)v->cy;
    return c[2] > (double)v->near_z;
}

static int is_inside(const ted4_view *v, const double at[2])
{
    return at[0] >= 0 && at[0] <= v->width && at[1] >= 0 && at[1] <= v->height;
}

/* Returns the mean square of the pixels by which anchors have moved in the first picture of a pose,
 * over those that the given pose shows; 0 if it shows none. */
static double squares_moved(const ted4_trainer *t, size_t pose)
{
    const ted4_picture *pic = &t->data->pictures[t->poses.picture[pose]];
    ted4_view given, refined;
    float centre[3];
    double sum = 0, n = 0;

    ted4_normalise_view(&t->layout.head, &pic->camera, &given, centre);
    ted4_trainer_view(t, pic, &refined, centre);
    for (size_t i = 0; i < t->anchors.n; i++) {
        float x[3];
        double a[2], b[2];

        for (int j = 0; j < 3; j++)
            x[j] = *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j);
        if (!project(&given, x, a) || !is_inside(&given, a) || !project(&refined, x, b))
            continue;
        sum += (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
        n++;
    }
    return n > 0 ? sum / n : 0;
}

static double pixels_moved(const ted4_trainer *t)
{
    double sum = 0;

    for (size_t i = 0; i < t->poses.n; i++)
        sum += squares_moved(t, i);
    return sqrt(sum / (double)t->poses.n);
}

/* Returns whether something may move while most poses have one picture only. */
static int poses_alone(const ted4_trainer *t)
{
    size_t pictures = 0;

    for (size_t i = 0; i < t->data->n_pictures; i++)
        pictures += t->poses.of[i] < t->poses.n;
    return t->data->n_frames > 1 && pictures < 2 * t->poses.n;
}

void ted4_poses_decide(ted4_trainer *t)
{
    ted4_poses *p = &t->poses;
    const int prior = p->decision == TED4_POSES_WITH_PRIOR;
    const double share = prior ? TRIAL : FREE;

    if (p->n == 0 || !ted4_poses_on_trial(p) ||
        ted4_stage_position(t) < (uint64_t)(share * (double)t->opt.stage1))
        return;

    const double moved = pixels_moved(t);
    const double least = poses_alone(t) ? WORTH_ALONE : WORTH;
    const double worth = prior ? fmin(REMAINS * p->moved, SUFFICE) : least;

    p->moved = moved;
    if (moved < worth)
        ted4_poses_put_back(p);
    else
        p->decision = prior ? TED4_POSES_REFINED : TED4_POSES_WITH_PRIOR;
}
