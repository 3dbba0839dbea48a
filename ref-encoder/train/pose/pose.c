/* pose.c - see pose.h. Everything is computed in double precision with our own functions, as the
 * results decide about the bytes of a file.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "pose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rotation_vector.h"

/* A motion of the whole scene counts as the same as others if less than this share of it is left
 * once those have been subtracted. */
#define SAME 1e-6

/* ---- which pictures share a pose ---- */

static int same_pose(const ted4_camera *a, const ted4_camera *b)
{
    return memcmp(a->R, b->R, sizeof a->R) == 0 && memcmp(a->t, b->t, sizeof a->t) == 0;
}

/* first[n_cameras]: receives the first training picture of each camera, or n_pictures if there is
 * none; still[n_cameras]: whether all its training pictures have one pose. */
static void look_at_cameras(const ted4_dataset *d, uint32_t *first, uint8_t *still)
{
    for (uint32_t c = 0; c < d->n_cameras; c++) {
        first[c] = (uint32_t)d->n_pictures;
        still[c] = 1;
    }
    for (uint32_t i = 0; i < d->n_pictures; i++) {
        const ted4_picture *p = &d->pictures[i];
        uint32_t *at = &first[p->camera_id];

        if (p->is_test)
            continue;
        if (*at == d->n_pictures)
            *at = i;
        else if (!same_pose(&d->pictures[*at].camera, &p->camera))
            still[p->camera_id] = 0;
    }
}

/* Numbers the poses in order of their first pictures: fills p->of, p->picture and p->n. */
static int number_poses(ted4_poses *p, const ted4_dataset *d)
{
    const uint32_t none = UINT32_MAX;
    uint32_t *first = malloc(((size_t)d->n_cameras + 1) * sizeof *first);
    uint8_t *still = malloc((size_t)d->n_cameras + 1);

    p->of = malloc((d->n_pictures + 1) * sizeof *p->of);
    p->picture = malloc((d->n_pictures + 1) * sizeof *p->picture);

    const int bad = first == NULL || still == NULL || p->of == NULL || p->picture == NULL;

    if (!bad)
        look_at_cameras(d, first, still);
    for (uint32_t i = 0; !bad && i < d->n_pictures; i++) {
        const ted4_picture *pic = &d->pictures[i];
        const int follows = still[pic->camera_id] && first[pic->camera_id] != i;

        p->of[i] = pic->is_test ? none : follows ? p->of[first[pic->camera_id]] : (uint32_t)p->n;
        if (!pic->is_test && !follows)
            p->picture[p->n++] = i;
    }
    for (uint32_t i = 0; !bad && i < d->n_pictures; i++)
        if (p->of[i] == none)
            p->of[i] = (uint32_t)p->n;
    free(first);
    free(still);
    return bad ? -1 : 0;
}

/* ---- motions of the whole scene ---- */

/* Computes the motion of a pose after which its picture does not change if the scene makes motion k
 * of size 1: R and t are the given pose in normalised space. To first order, the scene's rotation a
 * about the origin is w = -R a, u = t x w; its translation b is u = -R b; and its growth, after
 * which the camera has to be farther away, is u = t. */
static void gauge_of(int k, const double R[9], const double t[3], double *to)
{
    memset(to, 0, TED4_POSE_VALUES * sizeof *to);
    for (int i = 0; i < 3; i++) {
        if (k < 3)
            to[i] = -R[3 * i + k];
        else
            to[3 + i] = k < 6 ? -R[3 * i + k - 3] : t[i];
    }
    if (k < 3)
        ted4_cross_product(t, to, to + 3);
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Appends column, [n][6], to the orthonormal basis, if it is not a combination of the others.
 * Subtracting the others twice leaves nothing of them. */
static void add_gauge(ted4_poses *p, double *column)
{
    const size_t size = p->n * TED4_POSE_VALUES;
    const double before = sqrt(dot(column, column, size));

    for (int again = 0; again < 2; again++)
        for (int k = 0; k < p->n_gauges; k++) {
            const double *other = p->gauge + (size_t)k * size;
            const double along = dot(other, column, size);

            for (size_t i = 0; i < size; i++)
                column[i] -= along * other[i];
        }

    const double left = sqrt(dot(column, column, size));

    if (!(left > SAME * before))
        return;
    for (size_t i = 0; i < size; i++)
        column[i] /= left;
    p->n_gauges++;
}

static void make_gauge(ted4_poses *p, const ted4_dataset *d, const ted4_header *h)
{
    const size_t size = p->n * TED4_POSE_VALUES;

    for (int k = 0; k < TED4_POSE_GAUGES; k++) {
        double *column = p->gauge + (size_t)p->n_gauges * size;

        for (size_t i = 0; i < p->n; i++) {
            const ted4_camera *c = &d->pictures[p->picture[i]].camera;
            double t[3];

            for (int r = 0; r < 3; r++) {
                t[r] = c->t[r];
                for (int j = 0; j < 3; j++)
                    t[r] += c->R[3 * r + j] * (double)h->origin[j];
                t[r] /= p->unit;
            }
            gauge_of(k, c->R, t, column + i * TED4_POSE_VALUES);
        }
        add_gauge(p, column);
    }
}

void ted4_poses_fix_gauge(ted4_poses *p)
{
    const size_t size = p->n * TED4_POSE_VALUES;
    float *x = p->value != NULL ? p->value[0] : NULL;

    for (int k = 0; k < p->n_gauges; k++) {
        const double *g = p->gauge + (size_t)k * size;
        double along = 0;

        for (size_t i = 0; i < size; i++)
            along += g[i] * (double)x[i];
        for (size_t i = 0; i < size; i++)
            x[i] = (float)((double)x[i] - along * g[i]);
    }
}

/* ---- memory ---- */

static int allocate(ted4_poses *p)
{
    const size_t n = p->n;

    p->steps = calloc(n, sizeof *p->steps);
    p->seen = calloc(n, sizeof *p->seen);
    p->value = calloc(n, sizeof *p->value);
    p->m = calloc(n, sizeof *p->m);
    p->v = calloc(n, sizeof *p->v);
    p->gradient = calloc(n, sizeof *p->gradient);
    p->gauge = calloc(n * TED4_POSE_GAUGES * TED4_POSE_VALUES, sizeof *p->gauge);
    return p->steps == NULL || p->seen == NULL || p->value == NULL || p->m == NULL ||
                   p->v == NULL || p->gradient == NULL || p->gauge == NULL
               ? -1
               : 0;
}

int ted4_poses_init(ted4_poses *p, const ted4_dataset *d, const ted4_header *h)
{
    memset(p, 0, sizeof *p);
    p->unit = ldexp(1.0, h->exponent);
    if (number_poses(p, d) != 0)
        return -1;
    if (p->n < 2) {
        ted4_poses_finish(p);
        return 0;
    }
    if (allocate(p) != 0)
        return -1;
    make_gauge(p, d, h);
    return 0;
}

void ted4_poses_finish(ted4_poses *p)
{
    free(p->of);
    free(p->picture);
    free(p->steps);
    free(p->seen);
    free(p->value);
    free(p->m);
    free(p->v);
    free(p->gradient);
    free(p->gauge);
    memset(p, 0, sizeof *p);
}

/* ---- motions ---- */

int ted4_poses_learnt(const ted4_poses *p)
{
    return p->n > 0 && p->decision != TED4_POSES_GIVEN;
}

int ted4_poses_on_trial(const ted4_poses *p)
{
    return p->decision == TED4_POSES_ON_TRIAL || p->decision == TED4_POSES_WITH_PRIOR;
}

void ted4_poses_put_back(ted4_poses *p)
{
    const size_t size = p->n * sizeof *p->value;

    p->decision = TED4_POSES_GIVEN;
    if (p->n == 0)
        return;
    memset(p->value, 0, size);
    memset(p->m, 0, size);
    memset(p->v, 0, size);
    memset(p->gradient, 0, size);
    memset(p->seen, 0, p->n * sizeof *p->seen);
    memset(p->steps, 0, p->n * sizeof *p->steps);
}

int ted4_poses_finite(const ted4_poses *p)
{
    for (size_t i = 0; i < p->n; i++)
        for (int k = 0; k < TED4_POSE_VALUES; k++)
            if (!isfinite(p->value[i][k]))
                return 0;
    return 1;
}

void ted4_pose_move(const ted4_poses *p, size_t item, ted4_camera *c)
{
    if (!ted4_poses_learnt(p) || p->of[item] == p->n)
        return;

    const float *x = p->value[p->of[item]];
    const double w[3] = { (double)x[0], (double)x[1], (double)x[2] };
    double turn[9], R[9], t[3];

    ted4_rotation_matrix(w, turn);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            R[3 * i + j] = turn[3 * i] * c->R[j] + turn[3 * i + 1] * c->R[3 + j] +
                           turn[3 * i + 2] * c->R[6 + j];
        t[i] = turn[3 * i] * c->t[0] + turn[3 * i + 1] * c->t[1] + turn[3 * i + 2] * c->t[2] +
               p->unit * (double)x[3 + i];
    }
    memcpy(c->R, R, sizeof R);
    memcpy(c->t, t, sizeof t);
}
