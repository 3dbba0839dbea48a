/* pose_grad.c - see pose_grad.h. A picture depends on camera and Gaussians only through where the
 * Gaussians are in the camera's axes, apart from viewing directions. So a small rotation of the
 * camera's axes about its centre has the gradient of the same rotation of all Gaussians, means and
 * orientations alike; and a translation that of their translation.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "pose_grad.h"

#include <string.h>

#include "math/lane_sum.h"
#include "rotation_vector.h"

/* The sum over Gaussians is split into this many parts for any number of threads. */
enum { PARTS = 32 };

/* Force is the sum of dL/d(mean); torque is the gradient with respect to a rotation about the
 * camera's centre, both in normalised space. */
enum { FORCE, TORQUE = 3, SUMS = 6 };

typedef struct {
    const ted4_splats *s;
    const ted4_splat_grads *g;
    float centre[3];
    float sum[PARTS][SUMS];
} gather_job;

static float kept(uint8_t on, float x)
{
    return on ? x : 0.0f;
}

/* Adds n <= 16 Gaussians from number i on, each to a lane of its own. Gaussians that were culled
 * have no gradient, and need not be finite. Forward, for a small rotation by the vector d:
 *     mean' = mean + d x (mean - centre),   q' = (1, d / 2) q. */
static void add_gaussians(const gather_job *job, size_t i, size_t n, float sum[][TED4_SUM_LANES])
{
    const ted4_splats *s = job->s;
    const ted4_splat_grads *g = job->g;

#pragma omp simd
    for (size_t j = 0; j < n; j++) {
        const size_t k = i + j;
        const uint8_t on = g->visible[k];
        const float x = kept(on, s->mean[0][k] - job->centre[0]);
        const float y = kept(on, s->mean[1][k] - job->centre[1]);
        const float z = kept(on, s->mean[2][k] - job->centre[2]);
        const float fx = g->mean[0][k], fy = g->mean[1][k], fz = g->mean[2][k];
        const float a = kept(on, s->rot[0][k]), b = kept(on, s->rot[1][k]);
        const float c = kept(on, s->rot[2][k]), d = kept(on, s->rot[3][k]);
        const float da = g->rot[0][k], db = g->rot[1][k], dc = g->rot[2][k], dd = g->rot[3][k];

        sum[FORCE][j] += fx;
        sum[FORCE + 1][j] += fy;
        sum[FORCE + 2][j] += fz;
        sum[TORQUE][j] += y * fz - z * fy + 0.5f * (a * db - b * da + c * dd - d * dc);
        sum[TORQUE + 1][j] += z * fx - x * fz + 0.5f * (a * dc - c * da + d * db - b * dd);
        sum[TORQUE + 2][j] += x * fy - y * fx + 0.5f * (a * dd - d * da + b * dc - c * db);
    }
}

static void gather(void *arg, size_t part)
{
    gather_job *job = arg;
    const size_t n = job->s->n, rows = (n + TED4_SUM_LANES - 1) / TED4_SUM_LANES;
    const size_t from = rows * part / PARTS, to = rows * (part + 1) / PARTS;
    float sum[SUMS][TED4_SUM_LANES];

    memset(sum, 0, sizeof sum);
    for (size_t row = from; row < to; row++) {
        const size_t i = row * TED4_SUM_LANES;

        add_gaussians(job, i, n - i < TED4_SUM_LANES ? n - i : TED4_SUM_LANES, sum);
    }
    for (int k = 0; k < SUMS; k++)
        job->sum[part][k] = ted4_lanes_total(sum[k]);
}

/* Returns row i of R times x. */
static double turned(const ted4_view *v, int i, const double x[3])
{
    return (double)v->R[3 * i] * x[0] + (double)v->R[3 * i + 1] * x[1] +
           (double)v->R[3 * i + 2] * x[2];
}

void ted4_pose_backward(const ted4_poses *p, size_t item, const ted4_view *v, const ted4_splats *s,
                        const ted4_splat_grads *g, const float *d_centre,
                        const ted4_parallel *parallel, ted4_pose_motion gradient)
{
    gather_job job = { .s = s, .g = g };
    const size_t pose = p->of[item];
    const float *x = p->value[pose];
    const double w[3] = { (double)x[0], (double)x[1], (double)x[2] };
    const double u[3] = { (double)x[3], (double)x[4], (double)x[5] };
    double sum[SUMS] = { 0 }, force[3], torque[3], lever[3];

    for (int j = 0; j < 3; j++)
        job.centre[j] = -(v->R[j] * v->t[0] + v->R[3 + j] * v->t[1] + v->R[6 + j] * v->t[2]);
    ted4_parallel_for(parallel, PARTS, gather, &job);
    for (int part = 0; part < PARTS; part++)
        for (int k = 0; k < SUMS; k++)
            sum[k] += (double)job.sum[part][k];
    /* The centre is -R^T t: it moves by -R^T u. */
    for (int j = 0; j < 3; j++)
        sum[FORCE + j] -= (double)d_centre[j];
    for (int i = 0; i < 3; i++) {
        force[i] = turned(v, i, sum + FORCE);
        torque[i] = turned(v, i, sum + TORQUE);
    }
    /* exp(w) turns R x + t, but not u. So after it, a rotation by d about the camera's centre also
     * includes the translation by u x d. */
    ted4_cross_product(force, u, lever);
    for (int i = 0; i < 3; i++)
        torque[i] += lever[i];
    ted4_rotation_backward(w, torque);
    for (int i = 0; i < 3; i++) {
        gradient[i] = (float)torque[i];
        gradient[3 + i] = (float)force[i];
    }
}
