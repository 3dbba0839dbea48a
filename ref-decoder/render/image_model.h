/* image_model.h - the mathematics of the rasteriser, written once for forward and backward: EWA projection of 16 Gaussians, and the opacity of
 * one Gaussian at the 16 pixels of a block. Depends on vec.h.
 * raster_plain.c is the same model in plain scalar code.
 *
 * The exponent of a Gaussian is taken in log2 and by the Cholesky factor of the inverse covariance [[a, b], [b, c]]^-1: with
 * d = pixel - centre and det = ac - b^2,
 *     d^T cov^-1 d = (c / det) (dx - (b / c) dy)^2 + (1 / c) dy^2,
 * a sum of squares, where the usual A dx^2 + 2B dx dy + C dy^2 loses all its digits on long thin Gaussians.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_IMAGE_MODEL_H
#define TED4_IMAGE_MODEL_H

#include "render/raster.h"
#include "render/vec.h"

#define TED4_LOG2_E           1.44269504088896341f
#define TED4_LOG2_ALPHA_MIN   -7.99435343685885793f     /* log2(1 / 255) */

/* The factors below carry sqrt(log2(e) / 2), so that exponents need no constant: log2(alpha) = level - n1^2 - n2^2. */
#define TED4_WHITEN           0.84932180028801904f      /* sqrt(log2(e) / 2) */

/* What a tile needs of one Gaussian: a cache line, since tiles visit Gaussians in depth order, which is no memory order. */
typedef struct {
    float x, y;                 /* centre, pixels */
    float a1, a2, a3;           /* n1 = a1 dx + a2 dy, n2 = a3 dy */
    float level;                /* log2(opacity) */
    float colour[3];
    float lean_x, lean_y;       /* b / c and b / a: of all points with a given dy, dx = lean_x dy is the most opaque; and vice versa */
    float unused[5];
} ted4_splat2d;

/* View constants that projection shares between Gaussians. */
typedef struct {
    float u_min, u_max, v_min, v_max;   /* clamp of x / z and y / z in the Jacobian */
} ted4_guard;

/* Frustum centre plus or minus TED4_RASTER_GUARD half-extents, from the actual principal point. */
TED4_INLINE ted4_guard ted4_guard_make(const ted4_view *v)
{
    const float half_u = 0.5f * (float)v->width / v->fx, half_v = 0.5f * (float)v->height / v->fy;
    const float mid_u = half_u - v->cx / v->fx, mid_v = half_v - v->cy / v->fy;

    return (ted4_guard){ mid_u - TED4_RASTER_GUARD * half_u, mid_u + TED4_RASTER_GUARD * half_u,
                         mid_v - TED4_RASTER_GUARD * half_v, mid_v + TED4_RASTER_GUARD * half_v };
}

/* 16 Gaussians as they come. */
typedef struct {
    ted4_vf mean[3], scale[3], rot[4], opacity;
} ted4_splats16;

TED4_INLINE void ted4_splats16_load(ted4_splats16 *g, const ted4_splats *s, size_t i, size_t n)
{
    for (int k = 0; k < 3; k++) {
        g->mean[k]  = ted4_vf_load_n(s->mean[k] + i, n);
        g->scale[k] = ted4_vf_load_n(s->scale[k] + i, n);
    }
    for (int k = 0; k < 4; k++)
        g->rot[k] = ted4_vf_load_n(s->rot[k] + i, n);
    g->opacity = ted4_vf_load_n(s->opacity + i, n);
}

/* Projection with everything its adjoint needs. cov2d = P P^T + blur, row r of P = (j_r^T R(q)) diag(scale), j = Jacobian times
 * view rotation. */
typedef struct {
    ted4_vf t[3], iz;           /* camera space; 1 / t[2] */
    ted4_vf u, v;               /* clamped x / z, y / z */
    ted4_vi u_free, v_free;     /* not clamped */
    ted4_vf j0[3], j1[3];
    ted4_vf r[9];               /* R(q) */
    ted4_vf q0[3], q1[3];       /* j_r^T R(q) */
    ted4_vf p0[3], p1[3];
    ted4_vf a, b, c, det;       /* cov2d with blur */
    ted4_vf x, y;               /* centre, pixels */
    ted4_vf a1, a2, a3;         /* as in ted4_splat2d */
} ted4_projection;

TED4_INLINE ted4_vf ted4_dot3(const ted4_vf a[3], const ted4_vf b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* R(q) of a unit quaternion w x y z, rows first. */
TED4_INLINE void ted4_rotation(const ted4_vf q[4], ted4_vf r[9])
{
    const ted4_vf w = q[0], x = q[1] + q[1], y = q[2] + q[2], z = q[3] + q[3];
    const ted4_vf xx = q[1] * x, yy = q[2] * y, zz = q[3] * z;
    const ted4_vf xy = q[1] * y, xz = q[1] * z, yz = q[2] * z;
    const ted4_vf wx = w * x, wy = w * y, wz = w * z;

    r[0] = 1.0f - yy - zz;
    r[1] = xy - wz;
    r[2] = xz + wy;
    r[3] = xy + wz;
    r[4] = 1.0f - xx - zz;
    r[5] = yz - wx;
    r[6] = xz - wy;
    r[7] = yz + wx;
    r[8] = 1.0f - xx - yy;
}

/* Rows j_r, q_r, p_r for one image axis: focal length f, clamped slope u, view rotation rows w and w2. */
TED4_INLINE void ted4_project_axis(const ted4_projection *p, const ted4_vf scale[3], float f, ted4_vf u, const float w[3],
                                   const float w2[3], ted4_vf j[3], ted4_vf q[3], ted4_vf out[3])
{
    const ted4_vf fz = f * p->iz;

    for (int i = 0; i < 3; i++)
        j[i] = fz * (w[i] - u * w2[i]);
    for (int i = 0; i < 3; i++) {
        q[i]   = j[0] * p->r[i] + j[1] * p->r[3 + i] + j[2] * p->r[6 + i];
        out[i] = q[i] * scale[i];
    }
}

/* Lanes behind the camera give numbers without meaning: the caller masks them by t[2] > near_z. */
TED4_INLINE void ted4_project16(ted4_projection *p, const ted4_splats16 *g, const ted4_view *v, const ted4_guard *guard)
{
    for (int i = 0; i < 3; i++)
        p->t[i] = v->R[3 * i] * g->mean[0] + v->R[3 * i + 1] * g->mean[1] + v->R[3 * i + 2] * g->mean[2] + v->t[i];
    p->iz = 1.0f / p->t[2];

    const ted4_vf u = p->t[0] * p->iz, w = p->t[1] * p->iz;
    p->x      = v->fx * u + v->cx;
    p->y      = v->fy * w + v->cy;
    p->u_free = (u > guard->u_min) & (u < guard->u_max);
    p->v_free = (w > guard->v_min) & (w < guard->v_max);
    p->u      = ted4_vf_min(ted4_vf_max(u, ted4_vf_all(guard->u_min)), ted4_vf_all(guard->u_max));
    p->v      = ted4_vf_min(ted4_vf_max(w, ted4_vf_all(guard->v_min)), ted4_vf_all(guard->v_max));

    ted4_rotation(g->rot, p->r);
    ted4_project_axis(p, g->scale, v->fx, p->u, v->R, v->R + 6, p->j0, p->q0, p->p0);
    ted4_project_axis(p, g->scale, v->fy, p->v, v->R + 3, v->R + 6, p->j1, p->q1, p->p1);

    /* det(P P^T) is the squared length of the rows' cross product: no cancellation, unlike ac - b^2. */
    const ted4_vf a0 = ted4_dot3(p->p0, p->p0), c0 = ted4_dot3(p->p1, p->p1);
    const ted4_vf m0 = p->p0[1] * p->p1[2] - p->p0[2] * p->p1[1];
    const ted4_vf m1 = p->p0[2] * p->p1[0] - p->p0[0] * p->p1[2];
    const ted4_vf m2 = p->p0[0] * p->p1[1] - p->p0[1] * p->p1[0];
    p->a   = a0 + TED4_RASTER_BLUR;
    p->b   = ted4_dot3(p->p0, p->p1);
    p->c   = c0 + TED4_RASTER_BLUR;
    p->det = m0 * m0 + m1 * m1 + m2 * m2 + TED4_RASTER_BLUR * (a0 + c0) + TED4_RASTER_BLUR * TED4_RASTER_BLUR;

    const ted4_vf ic = 1.0f / p->c;
    p->a1 = TED4_WHITEN * ted4_vf_sqrt(p->c / p->det);
    p->a2 = -p->a1 * (p->b * ic);
    p->a3 = TED4_WHITEN * ted4_vf_sqrt(ic);
}

/* log2(alpha) at the pixels (px, py), and the whitened offsets. */
TED4_INLINE ted4_vf ted4_splat_log2_alpha(const ted4_splat2d *g, ted4_vf px, ted4_vf py, ted4_vf *n1, ted4_vf *n2)
{
    const ted4_vf dx = px - g->x, dy = py - g->y;

    *n1 = g->a1 * dx + g->a2 * dy;
    *n2 = g->a3 * dy;
    return g->level - *n1 * *n1 - *n2 * *n2;
}

/* One step of front-to-back blending. t: transmittance before the Gaussian; updated. alpha: opacity used, w = alpha t: weight; both 0 where
 * the Gaussian is too faint or the pixel is finished. Nothing marks a finished pixel but its t, below TED4_RASTER_T_MIN ever after: so the
 * only thing that one step waits for in the one before is a multiplication and a subtraction. */
TED4_INLINE void ted4_blend_step(const ted4_splat2d *g, ted4_vf px, ted4_vf py, ted4_vf *t, ted4_vf *alpha, ted4_vf *w)
{
    ted4_vf n1, n2;
    const ted4_vf e = ted4_splat_log2_alpha(g, px, py, &n1, &n2);
    const ted4_vf capped = ted4_vf_min(ted4_vf_exp2(e), ted4_vf_all(TED4_RASTER_ALPHA_MAX));
    const ted4_vf al = ted4_vf_keep(e >= TED4_LOG2_ALPHA_MIN, capped);
    const ted4_vf next = *t - al * *t;
    const ted4_vi on = next >= TED4_RASTER_T_MIN;

    *alpha = ted4_vf_keep(on, al);
    *w     = ted4_vf_keep(on, al * *t);
    *t     = next;
}

#endif
