/* image_model.h - the mathematics of the rasteriser, shared by the forward and backward passes: the
 * EWA projection of one Gaussian per lane of a register, and the opacity of one Gaussian at one
 * pixel of a block per lane. Depends on raster_state.h, vec.h. raster_plain.c is the same model in
 * plain scalar code.
 *
 * The exponent of a Gaussian is computed in log2, with the Cholesky factor of the inverse
 * covariance [[a, b], [b, c]]^-1: with d = pixel - centre and det = ac - b^2,
 *     d^T cov^-1 d = (c / det) (dx - (b / c) dy)^2 + (1 / c) dy^2,
 * which is a sum of squares. The usual A dx^2 + 2B dx dy + C dy^2 loses all its digits for long,
 * thin Gaussians.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_IMAGE_MODEL_H
#define TED4_IMAGE_MODEL_H

#include "render/raster_state.h"
#include "render/vec.h"

#define TED4_LOG2_E         1.44269504088896341f
#define TED4_LOG2_ALPHA_MIN -7.99435343685885793f /* log2(1 / 255) */

/* The coefficients a1, a2 and a3 include the factor sqrt(log2(e) / 2), so that exponents need no
 * constant: log2(alpha) = level - n1^2 - n2^2. */
#define TED4_WHITEN 0.84932180028801904f /* sqrt(log2(e) / 2) */

/* View constants that projection shares between Gaussians. */
typedef struct {
    float u_min, u_max, v_min, v_max; /* clamp of x / z and y / z in the Jacobian */
    float learnt, blur; /* added to both variances in training, and here, pixels^2 (annex I.4) */
} ted4_guard;

/* The bounds are the frustum's centre plus or minus TED4_RASTER_GUARD times its half-extents. The
 * centre follows from the actual principal point. */
TED4_INLINE ted4_guard ted4_guard_make(const ted4_view *v)
{
    const float half_u = 0.5f * (float)v->width / v->fx, half_v = 0.5f * (float)v->height / v->fy;
    const float mid_u = half_u - v->cx / v->fx, mid_v = half_v - v->cy / v->fy;
    const float fine = v->pixel > 0.0f ? 1.0f / (v->pixel * v->pixel) : 1.0f;
    const float learnt = fine * TED4_RASTER_BLUR;
    const float blur = fine < 1.0f ? learnt + (1.0f - fine) * TED4_RASTER_BOX : learnt;

    return (ted4_guard) { mid_u - TED4_RASTER_GUARD * half_u,
                          mid_u + TED4_RASTER_GUARD * half_u,
                          mid_v - TED4_RASTER_GUARD * half_v,
                          mid_v + TED4_RASTER_GUARD * half_v,
                          learnt,
                          blur };
}

/* The parameters of one Gaussian per lane of a register. */
typedef struct {
    ted4_vf mean[3], scale[3], rot[4], opacity;
} ted4_splat_lanes;

TED4_INLINE void ted4_splat_lanes_load(ted4_splat_lanes *g, const ted4_splats *s, size_t i,
                                       size_t n)
{
    for (int k = 0; k < 3; k++) {
        g->mean[k] = ted4_vf_load_n(s->mean[k] + i, n);
        g->scale[k] = ted4_vf_load_n(s->scale[k] + i, n);
    }
    for (int k = 0; k < 4; k++)
        g->rot[k] = ted4_vf_load_n(s->rot[k] + i, n);
    g->opacity = ted4_vf_load_n(s->opacity + i, n);
}

/* A projection with all intermediate values that its adjoint needs. cov2d = P P^T + blur I, row r
 * of P = (j_r^T R(q)) diag(scale), j = Jacobian times view rotation. */
typedef struct {
    ted4_vf t[3], iz;       /* mean in camera space; 1 / t[2] */
    ted4_vf u, v;           /* clamped x / z, y / z */
    ted4_vi u_free, v_free; /* masks: u, v are not clamped */
    ted4_vf j0[3], j1[3];
    ted4_vf r[9];         /* R(q) */
    ted4_vf q0[3], q1[3]; /* j_r^T R(q) */
    ted4_vf p0[3], p1[3];
    ted4_vf a, b, c, det; /* cov2d with blur */
    ted4_vf det_learnt;   /* determinant of cov2d with the blur of training */
    ted4_vf x, y;         /* centre, pixels */
    ted4_vf a1, a2, a3;   /* as in ted4_splat2d */
} ted4_projection;

TED4_INLINE ted4_vf ted4_dot3(const ted4_vf a[3], const ted4_vf b[3])
{
    return ted4_vf_fma(a[0], b[0], ted4_vf_fma(a[1], b[1], a[2] * b[2]));
}

/* Returns m . x for a row m of a matrix that all lanes share. */
TED4_INLINE ted4_vf ted4_row3(const float m[3], const ted4_vf x[3])
{
    return ted4_vf_fma(ted4_vf_all(m[2]), x[2], ted4_vf_fma(ted4_vf_all(m[1]), x[1], m[0] * x[0]));
}

/* Returns component i of the cross product of a and b. */
TED4_INLINE ted4_vf ted4_cross(const ted4_vf a[3], const ted4_vf b[3], int i)
{
    const int j = (i + 1) % 3, k = (i + 2) % 3;

    return ted4_vf_fnma(a[k], b[j], a[j] * b[k]);
}

/* Computes the rotation matrix R(q) of a unit quaternion w x y z, row by row. */
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

/* Computes the rows j_r, q_r and p_r of one image axis, which has focal length f, clamped slope u,
 * and rows w and w2 of the view rotation. */
TED4_INLINE void ted4_project_axis(const ted4_projection *p, const ted4_vf scale[3], float f,
                                   ted4_vf u, const float w[3], const float w2[3], ted4_vf j[3],
                                   ted4_vf q[3], ted4_vf out[3])
{
    const ted4_vf fz = f * p->iz;

    for (int i = 0; i < 3; i++)
        j[i] = fz * ted4_vf_fnma(u, ted4_vf_all(w2[i]), ted4_vf_all(w[i]));
    for (int i = 0; i < 3; i++) {
        const ted4_vf column[3] = { p->r[i], p->r[3 + i], p->r[6 + i] };

        q[i] = ted4_dot3(j, column);
        out[i] = q[i] * scale[i];
    }
}

/* Results in lanes behind the camera are meaningless; the caller masks them by t[2] > near_z. */
TED4_INLINE void ted4_project_lanes(ted4_projection *p, const ted4_splat_lanes *g,
                                    const ted4_view *v, const ted4_guard *guard)
{
    for (int i = 0; i < 3; i++)
        p->t[i] = ted4_row3(v->R + 3 * i, g->mean) + v->t[i];
    p->iz = 1.0f / p->t[2];

    const ted4_vf u = p->t[0] * p->iz, w = p->t[1] * p->iz;
    p->x = ted4_vf_fma(ted4_vf_all(v->fx), u, ted4_vf_all(v->cx));
    p->y = ted4_vf_fma(ted4_vf_all(v->fy), w, ted4_vf_all(v->cy));
    p->u_free = (u > guard->u_min) & (u < guard->u_max);
    p->v_free = (w > guard->v_min) & (w < guard->v_max);
    p->u = ted4_vf_min(ted4_vf_max(u, ted4_vf_all(guard->u_min)), ted4_vf_all(guard->u_max));
    p->v = ted4_vf_min(ted4_vf_max(w, ted4_vf_all(guard->v_min)), ted4_vf_all(guard->v_max));

    ted4_rotation(g->rot, p->r);
    ted4_project_axis(p, g->scale, v->fx, p->u, v->R, v->R + 6, p->j0, p->q0, p->p0);
    ted4_project_axis(p, g->scale, v->fy, p->v, v->R + 3, v->R + 6, p->j1, p->q1, p->p1);

    /* det(P P^T) is the squared length of the cross product of the rows, which, unlike ac - b^2,
     * does not suffer from cancellation. */
    const ted4_vf a0 = ted4_dot3(p->p0, p->p0), c0 = ted4_dot3(p->p1, p->p1);
    const ted4_vf m[3] = { ted4_cross(p->p0, p->p1, 0), ted4_cross(p->p0, p->p1, 1),
                           ted4_cross(p->p0, p->p1, 2) };
    const ted4_vf blur = ted4_vf_all(guard->blur), learnt = ted4_vf_all(guard->learnt);
    const ted4_vf det0 = ted4_dot3(m, m);
    p->a = a0 + blur;
    p->b = ted4_dot3(p->p0, p->p1);
    p->c = c0 + blur;
    p->det = det0 + ted4_vf_fma(blur, a0 + c0, blur * blur);
    p->det_learnt = det0 + ted4_vf_fma(learnt, a0 + c0, learnt * learnt);

    const ted4_vf ic = 1.0f / p->c;
    p->a1 = TED4_WHITEN * ted4_vf_sqrt(p->c / p->det);
    p->a2 = -p->a1 * (p->b * ic);
    p->a3 = TED4_WHITEN * ted4_vf_sqrt(ic);
}

/* Computes the columns px and rows py of the pixel centres in part part of block b of tile
 * (tx, ty). A part is one register of the block's pixels, which are numbered row by row. */
TED4_INLINE void ted4_block_pixels(uint32_t tx, uint32_t ty, int b, int part, ted4_vf *px,
                                   ted4_vf *py)
{
    static const float col[TED4_LANE_GROUP] = { 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3 };
    static const float row[TED4_LANE_GROUP] = { 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3 };

    *px = ted4_vf_load(col + part * TED4_VEC) +
          ((float)(tx * TED4_TILE + (uint32_t)(b % TED4_BLOCK) * TED4_BLOCK) + 0.5f);
    *py = ted4_vf_load(row + part * TED4_VEC) +
          ((float)(ty * TED4_TILE + (uint32_t)(b / TED4_BLOCK) * TED4_BLOCK) + 0.5f);
}

/* Returns log2(alpha) at the pixels (px, py); *n1 and *n2 are set to the whitened offsets. */
TED4_INLINE ted4_vf ted4_splat_log2_alpha(const ted4_splat2d *g, ted4_vf px, ted4_vf py,
                                          ted4_vf *n1, ted4_vf *n2)
{
    const ted4_vf dx = px - g->x, dy = py - g->y;

    *n1 = ted4_vf_fma(ted4_vf_all(g->a1), dx, g->a2 * dy);
    *n2 = g->a3 * dy;
    return ted4_vf_fnma(*n2, *n2, ted4_vf_fnma(*n1, *n1, ted4_vf_all(g->level)));
}

/* Does one step of front-to-back blending. *t is the transmittance before the Gaussian, and is
 * updated. *alpha is set to the opacity used and *w to the weight alpha t; both are 0 where the
 * Gaussian is too faint or the pixel is finished. A pixel is finished once t is below
 * TED4_RASTER_T_MIN, where it stays; there is no other mark, so that a step depends on the previous
 * one only by a multiplication and a subtraction. */
TED4_INLINE void ted4_blend_step(const ted4_splat2d *g, ted4_vf px, ted4_vf py, ted4_vf *t,
                                 ted4_vf *alpha, ted4_vf *w)
{
    ted4_vf n1, n2;
    const ted4_vf e = ted4_splat_log2_alpha(g, px, py, &n1, &n2);
    const ted4_vf capped = ted4_vf_min(ted4_vf_exp2(e), ted4_vf_all(TED4_RASTER_ALPHA_MAX));
    const ted4_vf al = ted4_vf_keep(e >= TED4_LOG2_ALPHA_MIN, capped);
    const ted4_vf next = ted4_vf_fnma(al, *t, *t);
    const ted4_vi on = next >= TED4_RASTER_T_MIN;

    *alpha = ted4_vf_keep(on, al);
    *w = ted4_vf_keep(on, al * *t);
    *t = next;
}

#endif
