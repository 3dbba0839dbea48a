/* spec_tolerance.h - annex E: the thresholds of class T for a stream and a query, and whether
 * records satisfy them. Evaluations use the code that the specification prints (spec/eval.c).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPEC_TOLERANCE_H
#define TED4_SPEC_TOLERANCE_H

#include "spec_model.h"

enum { TOL_POSITION, TOL_SCALE, TOL_ROTATION, TOL_OPACITY, TOL_COLOUR, TOL_GROUPS };
enum { TOL_EXACT, TOL_WIDE, TOL_FUSED, TOL_REORDERED, TOL_EVALUATIONS };

/* Each evaluation gives the records of a struct scene and returns their number. */
typedef size_t tol_evaluation(const void *scene, uint32_t num, uint32_t den, const float *camera,
                              float (*out)[14]);
tol_evaluation tol_exact, tol_wide, tol_fused, tol_reordered;

typedef struct {
    size_t n;                             /* records */
    float (*record[TOL_EVALUATIONS])[14]; /* owned */
    uint8_t *judged;                      /* [n]; bit g: group g of the record is judged */
    double peak[TOL_GROUPS], rms[TOL_GROUPS];
    double unit; /* 2^e */
} tol_reference;

/* R-TOL-002: deviation of y from the record x of class X, not below u. */
static inline void tol_deviation(const float *x, const float *y, double unit,
                                 double dev[TOL_GROUPS])
{
    double u = 0, minus = 0, plus = 0;

    memset(dev, 0, TOL_GROUPS * sizeof *dev);
    for (int j = 0; j < 3; j++) {
        u = fmax(u, fabs((double)x[j]));
        dev[TOL_POSITION] = fmax(dev[TOL_POSITION], fabs((double)y[j] - (double)x[j]) / unit);
        dev[TOL_SCALE] = fmax(dev[TOL_SCALE], fabs((double)y[3 + j] - (double)x[3 + j]) /
                                                  fmax((double)x[3 + j], 0x1p-24 * unit));
        dev[TOL_COLOUR] = fmax(dev[TOL_COLOUR], fabs((double)y[11 + j] - (double)x[11 + j]));
    }
    for (int j = 6; j < 10; j++) {
        minus = fmax(minus, fabs((double)y[j] - (double)x[j]));
        plus = fmax(plus, fabs((double)y[j] + (double)x[j]));
    }
    dev[TOL_ROTATION] = fmin(minus, plus);
    dev[TOL_OPACITY] = fabs((double)y[10] - (double)x[10]);
    for (int g = 0; g < TOL_GROUPS; g++)
        dev[g] = fmax(dev[g], g == TOL_POSITION ? 0x1p-24 * u / unit : 0x1p-24);
}

/* Largest deviation and root mean square deviation of each group; 0 where nothing is judged. */
static inline void tol_measure(const tol_reference *t, float (*y)[14], double peak[TOL_GROUPS],
                               double rms[TOL_GROUPS])
{
    size_t n[TOL_GROUPS] = { 0 };

    memset(peak, 0, TOL_GROUPS * sizeof *peak);
    memset(rms, 0, TOL_GROUPS * sizeof *rms);
    for (size_t i = 0; i < t->n; i++) {
        double dev[TOL_GROUPS];

        tol_deviation(t->record[TOL_EXACT][i], y[i], t->unit, dev);
        for (int g = 0; g < TOL_GROUPS; g++)
            if (t->judged[i] >> g & 1) {
                peak[g] = fmax(peak[g], dev[g]);
                rms[g] += dev[g] * dev[g];
                n[g]++;
            }
    }
    for (int g = 0; g < TOL_GROUPS; g++)
        rms[g] = n[g] > 0 ? sqrt(rms[g] / (double)n[g]) : 0;
}

/* R-TOL-004, rotation */
static inline int tol_same_fallback(const tol_reference *t, size_t i)
{
    int taken = 0;

    for (int e = 0; e < TOL_EVALUATIONS; e++) {
        const float *q = t->record[e][i] + 6;

        taken += q[0] == 1.0f && q[1] == 0.0f && q[2] == 0.0f && q[3] == 0.0f;
    }
    return taken == 0 || taken == TOL_EVALUATIONS;
}

/* R-TOL-004, view direction of an anchor */
static inline int tol_far(const struct scene *s, size_t anchor, const float *camera)
{
    double sum = 0;

    for (size_t j = 0; j < 3; j++) {
        const double v = q24(s->position[3 * anchor + j]) / 16777216.0 -
                         ((double)camera[j] - (double)from_bits(s->h.origin[j])) *
                             exp2((double)-s->h.exponent);

        sum += v * v;
    }
    return s->h.view == 0 || sum >= 0x1p-38;
}

/* R-TOL-004: whether all numbers are finite in all evaluations */
static inline int tol_finite(const tol_reference *t, size_t i)
{
    for (int e = 0; e < TOL_EVALUATIONS; e++)
        for (int j = 0; j < 14; j++)
            if (!isfinite(t->record[e][i][j]))
                return 0;
    return 1;
}

static inline void tol_mark(tol_reference *t, const struct scene *s, const float *camera)
{
    size_t i = 0;

    for (size_t a = 0; a < (size_t)s->h.n_anchors; a++)
        for (int k = 0; k < s->h.n_offsets; k++)
            if (s->offset_bits[a] >> k & 1) {
                t->judged[i] = tol_far(s, a, camera) ? (1 << TOL_GROUPS) - 1 : 1 << TOL_POSITION;
                if (!tol_same_fallback(t, i))
                    t->judged[i] &= (uint8_t) ~(1u << TOL_ROTATION);
                if (!tol_finite(t, i))
                    t->judged[i] = 0;
                i++;
            }
}

/* R-TOL-003 */
static inline double tol_round_up(double x)
{
    int e;

    return x == 0 ? 0 : frexp(x, &e) == 0.5 ? x : ldexp(1.0, e);
}

/* Computes the records of all evaluations, and the thresholds. Returns 1, or 0 if class X has no
 * result. t: zeroed; call tol_free in any case. */
static inline int tol_make(tol_reference *t, const struct scene *s, uint32_t num, uint32_t den,
                           const float *camera)
{
    tol_evaluation *const evaluate[TOL_EVALUATIONS] = { tol_exact, tol_wide, tol_fused,
                                                        tol_reordered };
    const size_t most = (size_t)(s->h.n_anchors * s->h.n_offsets) + 1;

    t->unit = exp2((double)s->h.exponent);
    t->judged = calloc(most, 1);
    for (int e = 0; e < TOL_EVALUATIONS; e++) {
        t->record[e] = calloc(most, sizeof *t->record[e]);
        t->n = evaluate[e](s, num, den, camera, t->record[e]);
    }
    for (size_t i = 0; i < 14 * t->n; i++)
        if (!isfinite((&t->record[TOL_EXACT][0][0])[i]))
            return 0;
    tol_mark(t, s, camera);
    for (int e = TOL_WIDE; e < TOL_EVALUATIONS; e++) {
        double peak[TOL_GROUPS], rms[TOL_GROUPS];

        tol_measure(t, t->record[e], peak, rms);
        for (int g = 0; g < TOL_GROUPS; g++) {
            t->peak[g] = fmax(t->peak[g], tol_round_up(4 * peak[g]));
            t->rms[g] = fmax(t->rms[g], tol_round_up(4 * rms[g]));
        }
    }
    return 1;
}

/* R-TOL-005: returns -1 if the records satisfy the thresholds, else the first group that does
 * not. */
static inline int tol_judge(const tol_reference *t, float (*y)[14])
{
    double peak[TOL_GROUPS], rms[TOL_GROUPS];

    for (size_t i = 0; i < 14 * t->n; i++)
        if (!isfinite((&y[0][0])[i]))
            return TOL_GROUPS;
    tol_measure(t, y, peak, rms);
    for (int g = 0; g < TOL_GROUPS; g++)
        if (peak[g] > t->peak[g] || rms[g] > t->rms[g])
            return g;
    return -1;
}

static inline void tol_free(tol_reference *t)
{
    for (int e = 0; e < TOL_EVALUATIONS; e++)
        free(t->record[e]);
    free(t->judged);
}

#endif
