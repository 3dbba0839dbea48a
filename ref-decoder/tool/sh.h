/* sh.h - real spherical harmonics of degree 0 to 3 as splat files use them, and their fit to
 * colours that depend on direction.
 * colour(d) = 0.5 + sum_k sh[k] basis_k(d), d the unit vector from the camera to the Gaussian.
 * Signs with the Condon-Shortley phase.
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

/* out: [(degree + 1)^2], in order of degree, then of m from -degree to degree. */
void ted4_sh_basis(const double d[3], int degree, double *out);

/* Colours of n Gaussians seen from infinitely far along a direction (camera at -direction times
 * infinity), into colour[3][n].
 * 0, or another number that stops the fit. */
typedef int (*ted4_sh_sampler)(void *user, const double direction[3], float *const colour[3]);

/* Least squares over 64 directions spread evenly. sh: [n][3][(degree + 1)^2]. *rms: root mean
 * square difference of fit and colours over 16 other
 * directions and all channels; 0 when n = 0. Returns 0, what the sampler returned, or -1: no
 * memory. */
int ted4_sh_fit(int degree, size_t n, ted4_sh_sampler sample, void *user, float *sh, double *rms);

/* sh of a colour that does not depend on direction. */
void ted4_sh_constant(int degree, size_t n, const float *const colour[3], float *sh);

#endif
