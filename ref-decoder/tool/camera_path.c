/* camera_path.c - see camera_path.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "camera_path.h"

#include <math.h>
#include <string.h>

/* Cameras further than this from their mean direction, in radians, stand around the scene. */
static const double MOST_SWING = 2.0;

/* ---- vectors ---- */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Scales v to length 1. Returns 0, or -1 if it has no direction. */
static int normalise(double v[3])
{
    const double length = sqrt(dot(v, v));

    for (int k = 0; k < 3; k++)
        v[k] = length > 0.0 ? v[k] / length : 0.0;
    return length > 0.0 ? 0 : -1;
}

void ted4_view_centre(const ted4_view *v, double centre[3])
{
    for (int k = 0; k < 3; k++)
        centre[k] = -((double)v->R[k] * (double)v->t[0] + (double)v->R[3 + k] * (double)v->t[1] +
                      (double)v->R[6 + k] * (double)v->t[2]);
}

/* Sets R, and t so that the centre is where it should be. R: row by row. */
static void set_pose(ted4_view *v, const double R[9], const double centre[3])
{
    for (int k = 0; k < 3; k++) {
        v->t[k] = (float)-dot(R + 3 * k, centre);
        for (int c = 0; c < 3; c++)
            v->R[3 * k + c] = (float)R[3 * k + c];
    }
}

/* ---- along keys ---- */

/* The unit quaternion w x y z of a rotation, from the largest of its four squares. */
static void quaternion(const float R[9], double q[4])
{
    double m[9], best = -1.0, length = 0.0;
    int largest = 0;

    for (int i = 0; i < 9; i++)
        m[i] = (double)R[i];
    const double square[4] = { 1 + m[0] + m[4] + m[8], 1 + m[0] - m[4] - m[8],
                               1 - m[0] + m[4] - m[8], 1 - m[0] - m[4] + m[8] };
    const double row[4][4] = {
        { square[0], m[7] - m[5], m[2] - m[6], m[3] - m[1] },
        { m[7] - m[5], square[1], m[1] + m[3], m[2] + m[6] },
        { m[2] - m[6], m[1] + m[3], square[2], m[5] + m[7] },
        { m[3] - m[1], m[2] + m[6], m[5] + m[7], square[3] },
    };

    for (int i = 0; i < 4; i++) {
        if (square[i] > best) {
            best = square[i];
            largest = i;
        }
    }
    for (int i = 0; i < 4; i++)
        length += row[largest][i] * row[largest][i];
    for (int i = 0; i < 4; i++)
        q[i] = row[largest][i] / sqrt(length);
}

static void rotation(const double q[4], double R[9])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[9] = {
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
        2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)
    };

    memcpy(R, m, sizeof m);
}

/* The rotation between a and b at u in [0, 1]. */
static void slerp(const double a[4], const double b[4], double u, double out[4])
{
    double cosine = 0.0, length = 0.0;

    for (int i = 0; i < 4; i++)
        cosine += a[i] * b[i];
    const double sign = cosine < 0.0 ? -1.0 : 1.0, angle = acos(fmin(fabs(cosine), 1.0));
    const double wa = angle > 1e-6 ? sin((1.0 - u) * angle) / sin(angle) : 1.0 - u;
    const double wb = angle > 1e-6 ? sin(u * angle) / sin(angle) : u;

    for (int i = 0; i < 4; i++) {
        out[i] = wa * a[i] + sign * wb * b[i];
        length += out[i] * out[i];
    }
    for (int i = 0; i < 4; i++)
        out[i] /= sqrt(length);
}

/* Catmull-Rom between p[1] and p[2]. */
static double spline(const double p[4], double u)
{
    return p[1] + 0.5 * u *
                      (p[2] - p[0] +
                       u * (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] +
                            u * (3 * (p[1] - p[2]) + p[3] - p[0])));
}

static float between(float a, float b, double u)
{
    return (float)((double)a + u * ((double)b - (double)a));
}

/* The lens between two keys, in pixels of the first key of the path. */
static void set_lens(ted4_view *v, const ted4_view *size, const ted4_view *a, const ted4_view *b,
                     double u)
{
    const float wa = (float)size->width / (float)a->width,
                wb = (float)size->width / (float)b->width,
                ha = (float)size->height / (float)a->height,
                hb = (float)size->height / (float)b->height;

    const float fx = between(a->fx * wa, b->fx * wb, u);

    *v = (ted4_view) { .pixel = size->pixel * size->fx / fx,
                       .width = size->width,
                       .height = size->height,
                       .fx = fx,
                       .fy = between(a->fy * ha, b->fy * hb, u),
                       .cx = between(a->cx * wa, b->cx * wb, u),
                       .cy = between(a->cy * ha, b->cy * hb, u) };
}

double ted4_path_position(size_t i, size_t n, size_t keys)
{
    return n > 1 ? (double)i * (double)(keys - 1) / (double)(n - 1) : 0.0;
}

void ted4_path_between(const ted4_camera_list *keys, size_t n, ted4_view *view)
{
    const size_t last = keys->n - 1;

    for (size_t i = 0; i < n; i++) {
        const double at = ted4_path_position(i, n, keys->n);
        const size_t k = at < (double)last ? (size_t)at : last, next = k < last ? k + 1 : last;
        const double u = at - (double)k;
        const ted4_view *const a = &keys->camera[k].view, *const b = &keys->camera[next].view;
        double p[4][3], centre[3], from[4], to[4], q[4], R[9];

        ted4_view_centre(&keys->camera[k > 0 ? k - 1 : 0].view, p[0]);
        ted4_view_centre(a, p[1]);
        ted4_view_centre(b, p[2]);
        ted4_view_centre(&keys->camera[next < last ? next + 1 : last].view, p[3]);
        for (int c = 0; c < 3; c++)
            centre[c] = spline((const double[]) { p[0][c], p[1][c], p[2][c], p[3][c] }, u);
        quaternion(a->R, from);
        quaternion(b->R, to);
        slerp(from, to, u, q);
        rotation(q, R);
        set_lens(&view[i], &keys->camera[0].view, a, b, u);
        set_pose(&view[i], R, centre);
    }
}

/* ---- around a point ---- */

/* Two unit vectors that are orthogonal to up, the first one towards start if that has a part across
 * up. */
static void plane(const double up[3], const double start[3], double e1[3], double e2[3])
{
    for (int k = 0; k < 3; k++)
        e1[k] = start[k] - dot(start, up) * up[k];
    if (dot(e1, e1) < 1e-12 * dot(start, start) || normalise(e1) != 0) {
        const int axis = fabs(up[0]) < 0.6 ? 0 : 1;

        for (int k = 0; k < 3; k++)
            e1[k] = (k == axis) - up[axis] * up[k];
        (void)normalise(e1);
    }
    cross(up, e1, e2);
}

void ted4_orbit_around(const ted4_orbit *o, size_t n, ted4_view *view)
{
    const double turn = 2.0 * acos(-1.0);
    double e1[3], e2[3];

    plane(o->up, o->start, e1, e2);
    for (size_t i = 0; i < n; i++) {
        const double phase = turn * (double)i / (double)n;
        const double angle = o->swing > 0.0 ? o->swing * sin(phase) : phase;
        double centre[3], R[9], *const right = R, *const down = R + 3, *const forward = R + 6;

        for (int k = 0; k < 3; k++) {
            const double away = o->radius * (cos(angle) * e1[k] + sin(angle) * e2[k]) +
                                o->height * o->up[k];

            centre[k] = o->centre[k] + away;
            forward[k] = -away;
        }
        (void)normalise(forward);
        cross(forward, o->up, right);
        (void)normalise(right);
        cross(forward, right, down);
        view[i] = o->lens;
        set_pose(&view[i], R, centre);
    }
}

/* From centre to camera i. Returns its part along up. */
static double away(const ted4_camera_list *l, size_t i, const ted4_orbit *o, double d[3])
{
    ted4_view_centre(&l->camera[i].view, d);
    for (int k = 0; k < 3; k++)
        d[k] -= o->centre[k];
    return dot(d, o->up);
}

void ted4_orbit_of_cameras(const ted4_camera_list *l, ted4_orbit *o)
{
    double d[3], e1[3], e2[3], mean[3] = { 0.0 };

    o->height = o->radius = o->swing = 0.0;
    for (size_t i = 0; i < l->n; i++) {
        const double along = away(l, i, o, d);

        for (int k = 0; k < 3; k++)
            mean[k] += d[k] / (double)l->n;
        o->height += along / (double)l->n;
        o->radius += sqrt(fmax(dot(d, d) - along * along, 0.0)) / (double)l->n;
    }
    memcpy(o->start, mean, sizeof mean);
    plane(o->up, o->start, e1, e2);
    for (size_t i = 0; i < l->n; i++) {
        (void)away(l, i, o, d);
        o->swing = fmax(o->swing, fabs(atan2(dot(d, e2), dot(d, e1))));
    }
    if (o->swing > MOST_SWING)
        o->swing = 0.0;
}

/* Solves A x = b by Cramer's rule. Returns 0, or -1 if A is nearly singular beside its trace. */
static int solve(const double A[9], const double b[3], double x[3])
{
    double c[3][3], det;
    const double trace = A[0] + A[4] + A[8];

    cross(A + 3, A + 6, c[0]);
    cross(A + 6, A, c[1]);
    cross(A, A + 3, c[2]);
    det = dot(A, c[0]);
    if (!(det > 1e-3 * trace * trace * trace / 27.0))
        return -1;
    for (int k = 0; k < 3; k++)
        x[k] = (b[0] * c[0][k] + b[1] * c[1][k] + b[2] * c[2][k]) / det;
    return 0;
}

int ted4_orbit_pivot(const ted4_camera_list *l, double centre[3])
{
    double A[9] = { 0.0 }, b[3] = { 0.0 };
    size_t behind = 0;

    for (size_t i = 0; i < l->n; i++) {
        const float *const f = l->camera[i].view.R + 6;
        double c[3];

        ted4_view_centre(&l->camera[i].view, c);
        for (int r = 0; r < 3; r++) {
            for (int k = 0; k < 3; k++) {
                const double across = (r == k) - (double)f[r] * (double)f[k];

                A[3 * r + k] += across;
                b[r] += across * c[k];
            }
        }
    }
    if (solve(A, b, centre) != 0)
        return -1;
    for (size_t i = 0; i < l->n; i++) {
        const ted4_view *const v = &l->camera[i].view;

        behind += (double)v->R[6] * centre[0] + (double)v->R[7] * centre[1] +
                      (double)v->R[8] * centre[2] + (double)v->t[2] <=
                  0.0;
    }
    return 2 * behind < l->n ? 0 : -1;
}
