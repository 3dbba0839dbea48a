/* project_bwd.c - adjoint of render/project.c, one register of Gaussians at a time. Comments quote
 * the forward equations of render/image_model.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "adjoint.h"
#include "render/image_model.h"

#include <float.h>

typedef struct {
    const ted4_adjoint *a;
    const ted4_raster *r;
    const ted4_splats *s;
    const ted4_view *v;
    const ted4_splat_grads *g;
    ted4_guard guard;
} bwd_job;

/* Gradients of one register of Gaussians. */
typedef struct {
    ted4_vf mean[3], scale[3], rot[4], opacity, colour[3], mean2d;
} grad_lanes;

/* Adds up the sums of one register of Gaussians, lane by lane, over their tiles in instance order.
 * Returns the set of Gaussians that have tiles. */
static uint32_t add_up(const ted4_adjoint *a, const ted4_raster *r, size_t i, size_t n,
                       ted4_vf sum[TED4_GRAD_SUMS], ted4_vf *sum0)
{
    typedef float row __attribute__((vector_size(32)));
    const uint32_t *first = (const uint32_t *)r->first_instance.data + i;
    const float *sums = a->sums.data, *one = a->sum0.data;
    float lane[TED4_GRAD_SUMS][TED4_VEC] = { { 0 } }, lane0[TED4_VEC] = { 0 };
    uint32_t visible = 0;

    for (size_t k = 0; k < n; k++) {
        row total = { 0 };
        float total0 = 0;

        for (uint32_t at = first[k]; at < first[k + 1]; at++) {
            row here;

            memcpy(&here, sums + (size_t)at * TED4_GRAD_SUMS, sizeof here);
            total += here;
            total0 += one[at];
        }
        for (int c = 0; c < TED4_GRAD_SUMS; c++)
            lane[c][k] = total[c];
        lane0[k] = total0;
        visible |= (uint32_t)(first[k] != first[k + 1]) << k;
    }
    for (int c = 0; c < TED4_GRAD_SUMS; c++)
        sum[c] = ted4_vf_load(lane[c]);
    *sum0 = ted4_vf_load(lane0);
    return visible;
}

/* Computes the gradients of the four components of q from dL/dR(q). Forward:
 *     r[0] = 1 - 2 (yy + zz),   r[1] = 2 (xy - wz),   ... */
static inline void rotation_bwd(const ted4_vf q[4], const ted4_vf d[9], ted4_vf out[4])
{
    const ted4_vf w = q[0], x = q[1], y = q[2], z = q[3];
    const ted4_vf sx = d[5] + d[7], sy = d[2] + d[6], sz = d[1] + d[3];
    const ted4_vf ax = d[7] - d[5], ay = d[2] - d[6], az = d[3] - d[1];

    out[0] = 2.0f * (x * ax + y * ay + z * az);
    out[1] = 2.0f * (w * ax + y * sz + z * sy - 2.0f * x * (d[4] + d[8]));
    out[2] = 2.0f * (w * ay + x * sz + z * sx - 2.0f * y * (d[0] + d[8]));
    out[3] = 2.0f * (w * az + x * sy + y * sx - 2.0f * z * (d[0] + d[4]));
}

/* Backpropagates the row dp of dL/dP of one image axis: adds to dL/dscale, dL/dR(q) and dL/dt. f:
 * focal length; u, u_free: clamped slope; du_dt: t[0] or t[1] is the slope times t[2]. Forward:
 *     q[i] = j . R(q) column i,   p[i] = q[i] scale[i],   j[i] = f / t[2] (w[i] - u w2[i]),
 *     u = clamp(t[axis] / t[2]) */
static inline void axis_bwd(const ted4_projection *p, const ted4_splat_lanes *g, float f, ted4_vf u,
                            ted4_vi u_free, const float w[3], const float w2[3], const ted4_vf j[3],
                            const ted4_vf q[3], const ted4_vf dp[3], ted4_vf d_scale[3],
                            ted4_vf d_r[9], ted4_vf *d_slope, ted4_vf *d_z)
{
    ted4_vf dj_w = { 0 }, dj_w2 = { 0 }, dq[3];

    for (int i = 0; i < 3; i++) {
        d_scale[i] = ted4_vf_fma(dp[i], q[i], d_scale[i]);
        dq[i] = dp[i] * g->scale[i];
    }
    for (int i = 0; i < 3; i++) {
        const ted4_vf dj = ted4_dot3(p->r + 3 * i, dq);

        for (int k = 0; k < 3; k++)
            d_r[3 * i + k] = ted4_vf_fma(j[i], dq[k], d_r[3 * i + k]);
        dj_w = ted4_vf_fma(dj, ted4_vf_all(w[i]), dj_w);
        dj_w2 = ted4_vf_fma(dj, ted4_vf_all(w2[i]), dj_w2);
    }
    *d_z = ted4_vf_fnma(f * p->iz * p->iz, ted4_vf_fnma(u, dj_w2, dj_w), *d_z);
    *d_slope += ted4_vf_keep(u_free, -f * p->iz * dj_w2);
}

/* Computes dL/dP from the sums. Forward: ln(alpha) = ln(o) - d^T K d / 2 with K = cov2d^-1 = U^T U,
 * where U d are the whitened offsets. So dL/dK = -1/2 sum g d d^T, and
 *     dL/dcov = -K dL/dK K = 1/2 U^T (sum g (U d)(U d)^T) U;
 * cov = P P^T + blur doubles it again. */
static inline void covariance_bwd(const ted4_projection *p, const ted4_vf sum[TED4_GRAD_SUMS],
                                  ted4_vf dp0[3], ted4_vf dp1[3])
{
    const float unscale = 1.0f / (TED4_WHITEN * TED4_WHITEN * TED4_WHITEN * TED4_WHITEN);
    const ted4_vf c = unscale * ted4_vf_fma(p->a3, sum[TED4_SUM_N12], p->a2 * sum[TED4_SUM_N11]);
    const ted4_vf d = unscale * ted4_vf_fma(p->a2, sum[TED4_SUM_N12], p->a3 * sum[TED4_SUM_N22]);
    const ted4_vf v00 = unscale * p->a1 * p->a1 * sum[TED4_SUM_N11];
    const ted4_vf v01 = p->a1 * c;
    const ted4_vf v11 = ted4_vf_fma(p->a2, c, p->a3 * d);

    for (int i = 0; i < 3; i++) {
        dp0[i] = ted4_vf_fma(v00, p->p0[i], v01 * p->p1[i]);
        dp1[i] = ted4_vf_fma(v01, p->p0[i], v11 * p->p1[i]);
    }
}

/* The a c / det from which on the loss of precision in covariance_bwd matters. A slanted Gaussian
 * that reaches it is about 170 times as long as it is wide. The error grows with a c / det, to one
 * sixth of the gradient at 1e6. */
#define THIN 3e4f

/* Computes dL/dP again for the lanes in thin. covariance_bwd computes (U^T S U) P: although U P has
 * size 1, that is a difference of numbers as large as the Gaussian is long. Here U P is computed
 * first. Its first row, a1 p0 + a2 p1 = a1 (p0 - b / c p1), is such a difference too, but is
 * computed by c p0 - b p1 = blur p0 + p1 x (p0 x p1). */
static inline void thin_bwd(const ted4_projection *p, const ted4_vf sum[TED4_GRAD_SUMS],
                            ted4_vi thin, ted4_vf dp0[3], ted4_vf dp1[3])
{
    const float unscale = 1.0f / (TED4_WHITEN * TED4_WHITEN * TED4_WHITEN * TED4_WHITEN);
    const ted4_vf ic = 1.0f / p->c;
    ted4_vf m[3], p1[3];

    for (int i = 0; i < 3; i++) {
        m[i] = ted4_cross(p->p0, p->p1, i);
        p1[i] = p->p1[i] * ic;
    }
    for (int i = 0; i < 3; i++) {
        const ted4_vf blur = ted4_vf_all(TED4_RASTER_BLUR);
        const ted4_vf w1 = p->a1 * ted4_vf_fma(blur, p->p0[i] * ic, ted4_cross(p1, m, i)),
                      w2 = p->a3 * p->p1[i];
        const ted4_vf s1 = unscale * ted4_vf_fma(sum[TED4_SUM_N11], w1, sum[TED4_SUM_N12] * w2);
        const ted4_vf s2 = unscale * ted4_vf_fma(sum[TED4_SUM_N12], w1, sum[TED4_SUM_N22] * w2);

        dp0[i] = ted4_vf_select(thin, p->a1 * s1, dp0[i]);
        dp1[i] = ted4_vf_select(thin, ted4_vf_fma(p->a2, s1, p->a3 * s2), dp1[i]);
    }
}

static void splats_bwd(const bwd_job *job, const ted4_splat_lanes *g,
                       const ted4_vf sum[TED4_GRAD_SUMS], const ted4_vf *sum0, grad_lanes *out)
{
    const ted4_view *v = job->v;
    const float unscale = 1.0f / (TED4_WHITEN * TED4_WHITEN);
    ted4_projection p;
    ted4_vf dp0[3], dp1[3], d_r[9] = { { 0 } }, d_z = { 0 }, d_u = { 0 }, d_v = { 0 };

    ted4_project_lanes(&p, g, v, &job->guard);
    covariance_bwd(&p, sum, dp0, dp1);

    const ted4_vi thin = p.a * p.c > THIN * p.det;
    if (ted4_vi_bits(thin) != 0)
        thin_bwd(&p, sum, thin, dp0, dp1);
    memset(out->scale, 0, sizeof out->scale);
    axis_bwd(&p, g, v->fx, p.u, p.u_free, v->R, v->R + 6, p.j0, p.q0, dp0, out->scale, d_r, &d_u,
             &d_z);
    axis_bwd(&p, g, v->fy, p.v, p.v_free, v->R + 3, v->R + 6, p.j1, p.q1, dp1, out->scale, d_r,
             &d_v, &d_z);
    rotation_bwd(g->rot, d_r, out->rot);

    /* x = fx t[0] / t[2] + cx; d ln(alpha) / d centre = K d */
    const ted4_vf dx = unscale * p.a1 * sum[TED4_SUM_N1];
    const ted4_vf dy = unscale * (p.a2 * sum[TED4_SUM_N1] + p.a3 * sum[TED4_SUM_N2]);
    d_u += v->fx * dx;
    d_v += v->fy * dy;
    /* the slopes are t[0] / t[2] and t[1] / t[2] */
    const ted4_vf dt0 = d_u * p.iz, dt1 = d_v * p.iz;
    d_z -= (dt0 * p.t[0] + dt1 * p.t[1]) * p.iz;
    for (int i = 0; i < 3; i++) {
        out->mean[i] = v->R[i] * dt0 + v->R[3 + i] * dt1 + v->R[6 + i] * d_z;
        out->colour[i] = sum[TED4_SUM_COLOUR + i];
    }
    out->opacity = *sum0 / g->opacity;

    const ted4_vf mx = dx * (0.5f * (float)v->width), my = dy * (0.5f * (float)v->height);
    const ted4_vf square = mx * mx + my * my;
    out->mean2d = ted4_vf_sqrt(ted4_vf_select(square > FLT_MAX, ted4_vf_all(FLT_MAX), square));
}

/* Stores the gradients. ok: the lanes that have tiles; the numbers in other lanes are undefined. */
static void store_grads(const ted4_splat_grads *g, const grad_lanes *d, ted4_vi ok, size_t i,
                        size_t n)
{
    for (int k = 0; k < 3; k++) {
        ted4_vf_store_n(g->mean[k] + i, ted4_vf_keep(ok, d->mean[k]), n);
        ted4_vf_store_n(g->scale[k] + i, ted4_vf_keep(ok, d->scale[k]), n);
        ted4_vf_store_n(g->colour[k] + i, ted4_vf_keep(ok, d->colour[k]), n);
    }
    for (int k = 0; k < 4; k++)
        ted4_vf_store_n(g->rot[k] + i, ted4_vf_keep(ok, d->rot[k]), n);
    ted4_vf_store_n(g->opacity + i, ted4_vf_keep(ok, d->opacity), n);
    ted4_vf_store_n(g->mean2d + i, ted4_vf_keep(ok, d->mean2d), n);
}

static void project_chunk_bwd(void *arg, size_t c)
{
    const bwd_job *job = arg;
    const size_t begin = c * TED4_CHUNK,
                 end = begin + TED4_CHUNK < job->s->n ? begin + TED4_CHUNK : job->s->n;

    for (size_t i = begin; i < end; i += TED4_VEC) {
        const size_t n = end - i < TED4_VEC ? end - i : TED4_VEC;
        ted4_vf sum[TED4_GRAD_SUMS], sum0;
        const uint32_t visible = add_up(job->a, job->r, i, n, sum, &sum0);
        grad_lanes d;
        ted4_vi ok;

        memset(&d, 0, sizeof d);
        for (size_t k = 0; k < TED4_VEC; k++)
            ok[k] = -(int32_t)(visible >> k & 1);
        for (size_t k = 0; k < n; k++)
            job->g->visible[i + k] = visible >> k & 1;
        if (visible != 0) {
            ted4_splat_lanes g;

            ted4_splat_lanes_load(&g, job->s, i, n);
            splats_bwd(job, &g, sum, &sum0, &d);
        }
        store_grads(job->g, &d, ok, i, n);
    }
}

void TED4_LEVELED(ted4_raster_project_bwd)(const ted4_adjoint *a, const ted4_raster *r,
                                           const ted4_splats *s, const ted4_view *v,
                                           const ted4_parallel *p, const ted4_splat_grads *g)
{
    bwd_job job = { a, r, s, v, g, ted4_guard_make(v) };

    ted4_parallel_for(p, (s->n + TED4_CHUNK - 1) / TED4_CHUNK, project_chunk_bwd, &job);
}
