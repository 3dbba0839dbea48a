/* pose_ref.h - a moved camera in double precision: exp(w) by its series, Gaussians in the camera's
 * axes. The reference of test_step_grad.c. Shares no code with train/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_POSE_REF_H
#define TED4_POSE_REF_H

#include <math.h>
#include <string.h>

#include "data/dataset.h"
#include "norm/syntax.h"

/* Normalised space to the camera's axes: R x + t; turn: the quaternion of R; centre: -R^T t. */
typedef struct {
    double R[9], t[3], turn[4], centre[3];
} ref_pose;

/* to = a b, both 3 x 3. */
static inline void ref_product(const double *a, const double *b, double *to)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            to[3 * i + j] = 0;
            for (int k = 0; k < 3; k++)
                to[3 * i + j] += a[3 * i + k] * b[3 * k + j];
        }
}

/* The sum of [w]^k / k!. */
static inline void ref_exponential(const double *w, double *to)
{
    const double cross[9] = { 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0 };
    double term[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, next[9];

    memcpy(to, term, sizeof term);
    for (int k = 1; k < 25; k++) {
        ref_product(term, cross, next);
        for (int i = 0; i < 9; i++) {
            term[i] = next[i] / k;
            to[i] += term[i];
        }
    }
}

/* motion: rotation vector, then translation in normalised space. */
static inline void ref_pose_of(const ted4_header *h, const ted4_camera *given, const double *motion,
                               ref_pose *p)
{
    double turn[9], t[3];

    ref_exponential(motion, turn);
    ref_product(turn, given->R, p->R);
    for (int i = 0; i < 3; i++) {
        t[i] = given->t[i];
        for (int j = 0; j < 3; j++)
            t[i] += given->R[3 * i + j] * (double)h->origin[j];
        t[i] *= exp2(-h->exponent);
    }
    for (int i = 0; i < 3; i++)
        p->t[i] = turn[3 * i] * t[0] + turn[3 * i + 1] * t[1] + turn[3 * i + 2] * t[2] +
                  motion[3 + i];
    for (int j = 0; j < 3; j++)
        p->centre[j] = -(p->R[j] * p->t[0] + p->R[3 + j] * p->t[1] + p->R[6 + j] * p->t[2]);
    p->turn[0] = 0.5 * sqrt(1 + p->R[0] + p->R[4] + p->R[8]);
    p->turn[1] = (p->R[7] - p->R[5]) / (4 * p->turn[0]);
    p->turn[2] = (p->R[2] - p->R[6]) / (4 * p->turn[0]);
    p->turn[3] = (p->R[3] - p->R[1]) / (4 * p->turn[0]);
}

/* Moves a Gaussian (mean 3, scale 3, rotation 4, ...) into the camera's axes. */
static inline void ref_pose_splat(const ref_pose *p, double *splat)
{
    const double *a = p->turn;
    double x[3], q[4];

    memcpy(x, splat, sizeof x);
    memcpy(q, splat + 6, sizeof q);
    for (int i = 0; i < 3; i++)
        splat[i] = p->R[3 * i] * x[0] + p->R[3 * i + 1] * x[1] + p->R[3 * i + 2] * x[2] + p->t[i];
    splat[6] = a[0] * q[0] - a[1] * q[1] - a[2] * q[2] - a[3] * q[3];
    splat[7] = a[0] * q[1] + a[1] * q[0] + a[2] * q[3] - a[3] * q[2];
    splat[8] = a[0] * q[2] + a[2] * q[0] + a[3] * q[1] - a[1] * q[3];
    splat[9] = a[0] * q[3] + a[3] * q[0] + a[1] * q[2] - a[2] * q[1];
}

#endif
