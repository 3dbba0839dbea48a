/* sh.c - see sh.h. The directions are the same for all Gaussians, so the fit is a product with one
 * matrix, the pseudo-inverse of the basis. It is accumulated direction by direction as the colours
 * arrive.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "sh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N_FIT = 64, N_CHECK = 16 };

/* The basis is orthonormal over the sphere. */
void ted4_sh_basis(const double d[3], int degree, double *out)
{
    const double x = d[0], y = d[1], z = d[2], xx = x * x, yy = y * y, zz = z * z;
    const double basis[TED4_SH_MAX_COEFS] = { TED4_SH_C0,
                                              -0.48860251190291992 * y,
                                              0.48860251190291992 * z,
                                              -0.48860251190291992 * x,
                                              1.0925484305920792 * x * y,
                                              -1.0925484305920792 * y * z,
                                              0.31539156525252005 * (2.0 * zz - xx - yy),
                                              -1.0925484305920792 * x * z,
                                              0.54627421529603959 * (xx - yy),
                                              -0.59004358992664352 * y * (3.0 * xx - yy),
                                              2.8906114426405538 * x * y * z,
                                              -0.45704579946446577 * y * (4.0 * zz - xx - yy),
                                              0.3731763325901154 * z *
                                                  (2.0 * zz - 3.0 * xx - 3.0 * yy),
                                              -0.45704579946446577 * x * (4.0 * zz - xx - yy),
                                              1.4453057213202769 * z * (xx - yy),
                                              -0.59004358992664352 * x * (xx - 3.0 * yy) };

    memcpy(out, basis, (size_t)ted4_sh_count(degree) * sizeof *out);
}

/* Point i of n of a Fibonacci lattice: a spiral with equal areas between its turns. */
static void spiral_direction(int i, int n, double turn, double d[3])
{
    const double golden = 3.0 - sqrt(5.0), pi = 3.14159265358979323846;
    const double z = 1.0 - (2.0 * i + 1.0) / n, r = sqrt(1.0 - z * z),
                 angle = pi * (golden * i + turn);

    d[0] = r * cos(angle);
    d[1] = r * sin(angle);
    d[2] = z;
}

/* Solves a x = b in place by Cholesky decomposition. a [n][n] is symmetric and positive definite; b
 * [n][columns] becomes x. */
static void solve_positive(int n, double a[][TED4_SH_MAX_COEFS], int columns, double b[][N_FIT])
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            double s = a[i][j];

            for (int k = 0; k < j; k++)
                s -= a[i][k] * a[j][k];
            a[i][j] = i == j ? sqrt(s) : s / a[j][j];
        }
    }
    for (int c = 0; c < columns; c++) {
        for (int i = 0; i < n; i++) {
            for (int k = 0; k < i; k++)
                b[i][c] -= a[i][k] * b[k][c];
            b[i][c] /= a[i][i];
        }
        for (int i = n - 1; i >= 0; i--) {
            for (int k = i + 1; k < n; k++)
                b[i][c] -= a[k][i] * b[k][c];
            b[i][c] /= a[i][i];
        }
    }
}

/* Computes the pseudo-inverse. weight[k][i]: weight of the colour from direction i in coefficient
 * k. */
static void fit_matrix(int degree, double weight[TED4_SH_MAX_COEFS][N_FIT])
{
    const int n = ted4_sh_count(degree);
    double normal[TED4_SH_MAX_COEFS][TED4_SH_MAX_COEFS] = { { 0.0 } };

    for (int i = 0; i < N_FIT; i++) {
        double d[3], basis[TED4_SH_MAX_COEFS];

        spiral_direction(i, N_FIT, 0.0, d);
        ted4_sh_basis(d, degree, basis);
        for (int k = 0; k < n; k++) {
            weight[k][i] = basis[k];
            for (int l = 0; l < n; l++)
                normal[k][l] += basis[k] * basis[l];
        }
    }
    solve_positive(n, normal, N_FIT, weight);
}

static void add_direction(int n_coefs, size_t n, double weight[][N_FIT], int i,
                          float *const colour[3], float *sh)
{
    float w[TED4_SH_MAX_COEFS];

    for (int k = 0; k < n_coefs; k++)
        w[k] = (float)weight[k][i];
    for (size_t g = 0; g < n; g++)
        for (int c = 0; c < 3; c++, sh += n_coefs)
            for (int k = 0; k < n_coefs; k++)
                sh[k] += w[k] * (colour[c][g] - 0.5f);
}

static double square_error(int degree, size_t n, const double d[3], float *const colour[3],
                           const float *sh)
{
    const int n_coefs = ted4_sh_count(degree);
    double basis[TED4_SH_MAX_COEFS], sum = 0.0;

    ted4_sh_basis(d, degree, basis);
    for (size_t g = 0; g < n; g++) {
        for (int c = 0; c < 3; c++, sh += n_coefs) {
            double e = 0.5 - (double)colour[c][g];

            for (int k = 0; k < n_coefs; k++)
                e += (double)sh[k] * basis[k];
            sum += e * e;
        }
    }
    return sum;
}

int ted4_sh_fit(int degree, size_t n, ted4_sh_sampler sample, void *user, float *sh, double *rms)
{
    const int n_coefs = ted4_sh_count(degree);
    double weight[TED4_SH_MAX_COEFS][N_FIT], d[3], sum = 0.0;
    float *const block = malloc((3 * n + 1) * sizeof *block);
    float *const colour[3] = { block, block + n, block + 2 * n };
    int r = 0;

    *rms = 0.0;
    if (block == NULL)
        return -1;
    fit_matrix(degree, weight);
    memset(sh, 0, n * 3 * (size_t)n_coefs * sizeof *sh);
    for (int i = 0; i < N_FIT && r == 0; i++) {
        spiral_direction(i, N_FIT, 0.0, d);
        r = sample(user, d, colour);
        if (r == 0)
            add_direction(n_coefs, n, weight, i, colour, sh);
    }
    for (int i = 0; i < N_CHECK && r == 0; i++) {
        spiral_direction(i, N_CHECK, 0.5, d);
        r = sample(user, d, colour);
        if (r == 0)
            sum += square_error(degree, n, d, colour, sh);
    }
    if (n > 0)
        *rms = sqrt(sum / (3.0 * N_CHECK * (double)n));
    free(block);
    return r;
}

/* The matrix of a rotation for coefficients, found from the values of basis functions in the fit's
 * directions, which determine the coefficients. Degrees do not mix. */
static void turn_matrix(int degree, const double matrix[9],
                        double turn[TED4_SH_MAX_COEFS][TED4_SH_MAX_COEFS])
{
    double weight[TED4_SH_MAX_COEFS][N_FIT];

    fit_matrix(degree, weight);
    memset(turn, 0, sizeof(double[TED4_SH_MAX_COEFS][TED4_SH_MAX_COEFS]));
    for (int i = 0; i < N_FIT; i++) {
        double d[3], before[3], basis[TED4_SH_MAX_COEFS];

        spiral_direction(i, N_FIT, 0.0, d);
        for (int c = 0; c < 3; c++)
            before[c] = matrix[c] * d[0] + matrix[3 + c] * d[1] + matrix[6 + c] * d[2];
        ted4_sh_basis(before, degree, basis);
        for (int l = 0; l <= degree; l++)
            for (int k = l * l; k < ted4_sh_count(l); k++)
                for (int j = l * l; j < ted4_sh_count(l); j++)
                    turn[k][j] += weight[k][i] * basis[j];
    }
    turn[0][0] = 1.0;
}

void ted4_sh_turn(int degree, const double matrix[9], size_t n, float *sh)
{
    const int n_coefs = ted4_sh_count(degree);
    double turn[TED4_SH_MAX_COEFS][TED4_SH_MAX_COEFS];

    turn_matrix(degree, matrix, turn);
    for (size_t i = 0; i < 3 * n; i++, sh += n_coefs) {
        double out[TED4_SH_MAX_COEFS];

        for (int l = 0; l <= degree; l++) {
            for (int k = l * l; k < ted4_sh_count(l); k++) {
                out[k] = 0.0;
                for (int j = l * l; j < ted4_sh_count(l); j++)
                    out[k] += turn[k][j] * (double)sh[j];
            }
        }
        for (int k = 0; k < n_coefs; k++)
            sh[k] = (float)out[k];
    }
}

void ted4_sh_constant(int degree, size_t n, const float *const colour[3], float *sh)
{
    const size_t n_coefs = (size_t)ted4_sh_count(degree);

    memset(sh, 0, n * 3 * n_coefs * sizeof *sh);
    for (size_t g = 0; g < n; g++)
        for (size_t c = 0; c < 3; c++)
            sh[(g * 3 + c) * n_coefs] = (float)(((double)colour[c][g] - 0.5) / TED4_SH_C0);
}
