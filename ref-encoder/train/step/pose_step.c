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

/* The decision is made after this share of stage 1; by then, poses that are a pixel wrong have
 * moved by most of it if they have had a hundred steps. Measured: 0.04 to 0.17 pixels where poses
 * are right; 0.28 to 0.39 on dog and treadmill, where what moves takes few cameras along, and
 * refinement costs 0.5 to 0.9 dB; 0.8 where poses are wrong by 0.4 degrees. */
#define TRIAL 0.2
#define WORTH 0.5 /* pixels */

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

void ted4_update_poses(ted4_trainer *t)
{
    ted4_poses *p = &t->poses;
    double square = 0;

    for (size_t i = 0; i < p->n; i++) {
        if (!p->seen[i])
            continue;

        const double norm = ted4_gradients_norm(p->gradient[i], TED4_POSE_VALUES);
        const double rate = STEP_PIXELS / t->data->pictures[p->picture[i]].camera.fx;

        square += norm * norm;
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

void ted4_poses_decide(ted4_trainer *t)
{
    ted4_poses *p = &t->poses;
    double sum = 0;

    if (p->n == 0 || p->decision != TED4_POSES_ON_TRIAL ||
        ted4_stage_position(t) < (uint64_t)(TRIAL * (double)t->opt.stage1))
        return;
    for (size_t i = 0; i < p->n; i++)
        sum += squares_moved(t, i);
    p->moved = sqrt(sum / (double)p->n);
    if (p->moved < WORTH)
        ted4_poses_put_back(p);
    else
        p->decision = TED4_POSES_REFINED;
}
