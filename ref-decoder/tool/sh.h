/* sh.h - real spherical harmonics of degree 0 to 3 as splat files use them, and a fit of them to
 * colours that depend on direction.
 * colour(d) = 0.5 + sum_k sh[k] basis_k(d), where d is the unit vector from the camera to the
 * Gaussian. The signs include the Condon-Shortley phase.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SH_H
#define TED4_SH_H

#include <stddef.h>

/* Basis function 0: 1 / (2 sqrt(pi)). */
#define TED4_SH_C0 0.28209479177387814

enum { TED4_SH_MAX_DEGREE = 3, TED4_SH_MAX_COEFS = 16 };

static inline int ted4_sh_count(int degree)
{
    return (degree + 1) * (degree + 1);
}

/* Evaluates the basis functions. out: [(degree + 1)^2], ordered by degree, then by m from -degree
 * to degree. */
void ted4_sh_basis(const double d[3], int degree, double *out);

/* Writes to colour[3][n] the colours of n Gaussians seen along a direction from infinitely far away
 * (camera at -direction times infinity). Returns 0, or any other number to stop the fit. */
typedef int (*ted4_sh_sampler)(void *user, const double direction[3], float *const colour[3]);

/* Fits coefficients by least squares over 64 evenly spread directions. sh: [n][3][(degree + 1)^2].
 * *rms: root mean square difference between the fit and the colours over 16 other directions and
 * all channels; 0 if n = 0. Returns 0, the number that the sampler returned, or -1 if there is no
 * memory. */
int ted4_sh_fit(int degree, size_t n, ted4_sh_sampler sample, void *user, float *sh, double *rms);

/* Turns harmonics in place, as directions are turned by matrix (a rotation, row by row): the colour
 * in direction matrix d is afterwards what it was in direction d. sh: [n][3][(degree + 1)^2]. */
void ted4_sh_turn(int degree, const double matrix[9], size_t n, float *sh);

/* Sets the coefficients for colours that do not depend on direction. */
void ted4_sh_constant(int degree, size_t n, const float *const colour[3], float *sh);

#endif
