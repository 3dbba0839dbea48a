/* lab_anchors.c - finds the anchors that their motion throws out of all pictures, and measures how
 * far anchors move: see lab_facts.h. Needs only the tracks.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include "lab_facts.h"

/* x: in world coordinates. */
static int sees(const ted4_camera *c, double near_z, const float x[3])
{
    double at[3];

    for (int i = 0; i < 3; i++)
        at[i] = c->R[3 * i] * (double)x[0] + c->R[3 * i + 1] * (double)x[1] +
                c->R[3 * i + 2] * (double)x[2] + c->t[i];
    if (!(at[2] > near_z))
        return 0;

    const double u = c->fx * at[0] / at[2] + c->cx, v = c->fy * at[1] / at[2] + c->cy;

    return u >= 0 && u < c->width && v >= 0 && v < c->height;
}

static int rig_sees(const lab_tracks *t, size_t time, const float x[3])
{
    const lab_rig *const rig = &t->rig[time];

    for (size_t c = 0; c < rig->n; c++)
        if (sees(rig->camera[c], t->near_z, x))
            return 1;
    return 0;
}

static const float *centre_of(const lab_tracks *t, size_t time, size_t anchor)
{
    return t->centre + 3 * (time * t->n + anchor);
}

/* Returns 1 if the anchor is drawn at a time that has cameras. */
static int counts(const lab_tracks *t, size_t time, size_t anchor)
{
    return t->rig[time].n > 0 && t->drawn[time * t->n + anchor];
}

/* Returns 1 if a camera of that time would see the anchor at its centre of some other time that
 * counts. */
static int seen_elsewhere(const lab_tracks *t, size_t time, size_t anchor)
{
    for (size_t other = 0; other < t->n_times; other++)
        if (other != time && t->rig[other].n > 0 && rig_sees(t, time, centre_of(t, other, anchor)))
            return 1;
    return 0;
}

static int is_thrown_out(const lab_tracks *t, size_t anchor)
{
    for (size_t time = 0; time < t->n_times; time++)
        if (counts(t, time, anchor) && !rig_sees(t, time, centre_of(t, time, anchor)) &&
            seen_elsewhere(t, time, anchor))
            return 1;
    return 0;
}

/* Returns the largest distance from where the anchor was first drawn, in world units, or -1 if it
 * is never drawn. */
static double farthest(const lab_tracks *t, size_t anchor)
{
    const float *from = NULL;
    double most = -1;

    for (size_t time = 0; time < t->n_times; time++) {
        const float *const x = centre_of(t, time, anchor);
        double square = 0;

        if (!counts(t, time, anchor))
            continue;
        if (from == NULL)
            from = x;
        for (int c = 0; c < 3; c++)
            square += ((double)x[c] - (double)from[c]) * ((double)x[c] - (double)from[c]);
        most = fmax(most, sqrt(square));
    }
    return most;
}

static int compare(const void *x, const void *y)
{
    const double a = *(const double *)x, b = *(const double *)y;

    return a < b ? -1 : a > b;
}

int lab_judge_anchors(const lab_tracks *t, lab_anchors *a)
{
    double *const far = malloc((t->n + 1) * sizeof *far);

    *a = (lab_anchors) { 0 };
    if (far == NULL)
        return -1;
    for (size_t i = 0; i < t->n; i++) {
        const double most = farthest(t, i);

        if (most < 0)
            continue;
        far[a->drawn++] = most / t->size;
        a->out += (size_t)is_thrown_out(t, i);
    }
    if (a->drawn > 0) {
        qsort(far, a->drawn, sizeof *far, compare);
        a->displacement = far[a->drawn - 1];
        a->displacement_99 = far[(a->drawn - 1) * 99 / 100];
    }
    free(far);
    return 0;
}
