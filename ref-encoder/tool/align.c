/* align.c - see align.h. The fit is Levenberg's and Marquardt's, with differences of drawn pictures
 * as derivatives, first on blurred differences, which still point the right way where the pose is
 * several pixels wrong.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "align.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/pose/rotation_vector.h"

/* Values of a motion: a rotation vector, then a translation as a multiple of the distance of what
 * is seen; both are angles by which that moves. */
enum { VALUES = 6 };

/* Radii of the blur in pixels, one fit after the other, and the most steps of each. */
static const int radius[] = { 4, 1, 0 };
enum { FITS = sizeof radius / sizeof radius[0], MOST_STEPS = 30 };

/* By how many pixels the camera turns to either side for a derivative, and the step, in pixels,
 * below which a fit has ended. */
#define PROBE  0.25
#define ENOUGH 0.005

/* The damping of the first step, its factor after a step that failed or succeeded, and the largest
 * one. */
#define DAMPING      1e-3
#define DAMPING_STEP 10.0
#define DAMPING_MOST 1e3

typedef struct {
    const ted4_camera *given;
    const uint8_t *truth;
    ted4_align_draw draw;
    void *user;
    double distance;                                /* of what is seen */
    int radius;                                     /* of the blur */
    size_t n;                                       /* values of a picture */
    uint8_t *rgb;                                   /* [n] */
    float *residual, *trial, *column[VALUES], *row; /* [n] each */
} fit;

static int is_fitted(int x, int y)
{
    return (x / TED4_ALIGN_TILE + y / TED4_ALIGN_TILE) % 2 == 0;
}

double ted4_align_psnr(const uint8_t *truth, const uint8_t *ours, int width, int height)
{
    double square = 0, n = 0;

    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3 && !is_fitted(x, y); c++) {
                const size_t at = 3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c;
                const double e = (double)(ours[at] - truth[at]) / 255.0;

                square += e * e;
                n++;
            }
    return -10.0 * log10(square / n);
}

static void move_camera(const fit *f, const double motion[VALUES], ted4_camera *c)
{
    double turn[9];

    ted4_rotation_matrix(motion, turn);
    *c = *f->given;
    for (int i = 0; i < 3; i++) {
        const double *r = turn + 3 * i;

        for (int j = 0; j < 3; j++)
            c->R[3 * i + j] = r[0] * f->given->R[j] + r[1] * f->given->R[3 + j] +
                              r[2] * f->given->R[6 + j];
        c->t[i] = r[0] * f->given->t[0] + r[1] * f->given->t[1] + r[2] * f->given->t[2] +
                  f->distance * motion[3 + i];
    }
}

/* Sums 2 radius + 1 values along a line of n, with zeros beyond its ends. */
static void blur_line(const float *from, float *to, size_t n, size_t stride, int r)
{
    const size_t reach = (size_t)r;
    float sum = 0;

    for (size_t i = 0; i < reach && i < n; i++)
        sum += from[i * stride];
    for (size_t i = 0; i < n; i++) {
        sum += i + reach < n ? from[(i + reach) * stride] : 0.0f;
        sum -= i > reach ? from[(i - reach - 1) * stride] : 0.0f;
        to[i * stride] = sum;
    }
}

static void blur(const fit *f, float *picture)
{
    const size_t width = (size_t)f->given->width, height = (size_t)f->given->height;

    if (f->radius == 0)
        return;
    for (size_t y = 0; y < height; y++)
        for (size_t c = 0; c < 3; c++)
            blur_line(picture + y * width * 3 + c, f->row + y * width * 3 + c, width, 3, f->radius);
    for (size_t x = 0; x < width * 3; x++)
        blur_line(f->row + x, picture + x, height, width * 3, f->radius);
}

/* Draws at a motion and fills to with what is fitted of the picture, less the truth. It is not
 * blurred yet: blurred before, pixels of the other half would come in. */
static int draw_fitted(fit *f, const double motion[VALUES], float *to)
{
    const int width = f->given->width, height = f->given->height;
    ted4_camera c;

    move_camera(f, motion, &c);

    const int code = f->draw(f->user, &c, f->rgb);

    for (int y = 0; y < height && code == 0; y++)
        for (int x = 0; x < width; x++)
            for (size_t k = 0; k < 3; k++) {
                const size_t at = 3 * ((size_t)y * (size_t)width + (size_t)x) + k;

                to[at] = is_fitted(x, y) ? (float)(f->rgb[at] - f->truth[at]) : 0.0f;
            }
    return code;
}

static double dot(const float *a, const float *b, size_t n)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += (double)a[i] * (double)b[i];
    return sum;
}

/* Fills to with the blurred differences at a motion, and *cost with the sum of their squares. */
static int look(fit *f, const double motion[VALUES], float *to, double *cost)
{
    const int code = draw_fitted(f, motion, to);

    if (code != 0)
        return code;
    blur(f, to);
    *cost = dot(to, to, f->n);
    return 0;
}

/* Fills f->column with the derivatives of the differences: f->trial holds one side. */
static int differentiate(fit *f, const double motion[VALUES])
{
    const double step = PROBE / f->given->fx;

    for (int k = 0; k < VALUES; k++) {
        double at[VALUES];

        memcpy(at, motion, sizeof at);
        at[k] = motion[k] + step;

        int code = draw_fitted(f, at, f->column[k]);

        at[k] = motion[k] - step;
        code = code != 0 ? code : draw_fitted(f, at, f->trial);
        if (code != 0)
            return code;
        for (size_t i = 0; i < f->n; i++)
            f->column[k][i] = (f->column[k][i] - f->trial[i]) / (float)(2 * step);
        blur(f, f->column[k]);
    }
    return 0;
}

/* Solves (A + damping diag(A)) x = b by Cholesky's method; A is symmetric. Returns 0, or -1 if it
 * is not positive definite. */
static int solve(const double A[VALUES][VALUES], double damping, const double *b, double *x)
{
    double L[VALUES][VALUES];

    for (int i = 0; i < VALUES; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = A[i][j] * (i == j ? 1 + damping : 1);

            for (int k = 0; k < j; k++)
                sum -= L[i][k] * L[j][k];
            if (i == j && !(sum > 0))
                return -1;
            L[i][j] = i == j ? sqrt(sum) : sum / L[j][j];
        }
        x[i] = b[i];
        for (int k = 0; k < i; k++)
            x[i] -= L[i][k] * x[k];
        x[i] /= L[i][i];
    }
    for (int i = VALUES - 1; i >= 0; i--) {
        for (int k = i + 1; k < VALUES; k++)
            x[i] -= L[k][i] * x[k];
        x[i] /= L[i][i];
    }
    return 0;
}

/* Does one step from a motion with these differences. Sets *moved to its length in pixels; 0: no
 * step makes the cost smaller. */
static int step(fit *f, double motion[VALUES], double *cost, double *damping, double *moved)
{
    double A[VALUES][VALUES], b[VALUES];
    int code = differentiate(f, motion);

    *moved = 0;
    for (int i = 0; i < VALUES && code == 0; i++) {
        b[i] = -dot(f->column[i], f->residual, f->n);
        for (int j = 0; j <= i; j++)
            A[i][j] = A[j][i] = dot(f->column[i], f->column[j], f->n);
    }
    for (; code == 0 && *damping <= DAMPING_MOST; *damping *= DAMPING_STEP) {
        double by[VALUES], at[VALUES], there, length = 0;

        if (solve((const double(*)[VALUES])A, *damping, b, by) != 0)
            continue;
        for (int k = 0; k < VALUES; k++) {
            at[k] = motion[k] + by[k];
            length = fmax(length, fabs(by[k]));
        }
        code = look(f, at, f->trial, &there);
        if (code != 0 || !(there < *cost))
            continue;
        memcpy(motion, at, sizeof at);
        memcpy(f->residual, f->trial, f->n * sizeof *f->residual);
        *cost = there;
        *damping /= DAMPING_STEP;
        *moved = length * f->given->fx;
        return 0;
    }
    return code;
}

static int run(fit *f, double motion[VALUES])
{
    double damping = DAMPING, moved = INFINITY, cost;
    int code = look(f, motion, f->residual, &cost);

    for (int i = 0; code == 0 && i < MOST_STEPS && moved > ENOUGH; i++)
        code = step(f, motion, &cost, &damping, &moved);
    return code;
}

/* Runs the fits one after the other. A motion that does not improve the sharp picture is none. */
static int run_all(fit *f, double motion[VALUES])
{
    static const double none[VALUES] = { 0 };
    double before, after;
    int code = 0;

    for (int i = 0; i < FITS && code == 0; i++) {
        f->radius = radius[i];
        code = run(f, motion);
    }
    code = code != 0 ? code : look(f, none, f->trial, &before);
    code = code != 0 ? code : look(f, motion, f->trial, &after);
    if (code == 0 && !(after < before))
        memset(motion, 0, sizeof none);
    return code;
}

int ted4_align(const ted4_camera *given, double distance, const uint8_t *truth,
               ted4_align_draw draw, void *user, ted4_camera *aligned)
{
    fit f = { .given = given, .truth = truth, .draw = draw, .user = user, .distance = distance };
    double motion[VALUES] = { 0 };
    int code = -1;

    f.n = 3 * (size_t)given->width * (size_t)given->height;
    f.rgb = malloc(f.n);
    f.residual = malloc((3 + VALUES) * f.n * sizeof *f.residual);
    if (f.rgb != NULL && f.residual != NULL) {
        f.trial = f.residual + f.n;
        f.row = f.trial + f.n;
        for (int k = 0; k < VALUES; k++)
            f.column[k] = f.row + (size_t)(1 + k) * f.n;
        code = run_all(&f, motion);
    }
    if (code == 0)
        move_camera(&f, motion, aligned);
    free(f.rgb);
    free(f.residual);
    return code;
}
