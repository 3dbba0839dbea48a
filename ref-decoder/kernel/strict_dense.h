/* strict_dense.h - faster twins of ted4_strict_dense_plain (recon/strict.h), bit for bit equal, and which one this machine takes.
 * Used by recon/recon.c and tests/test_kernel_strict.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STRICT_DENSE_H
#define TED4_STRICT_DENSE_H

#include "recon/strict.h"

#if defined(__x86_64__)
void ted4_strict_dense_avx2(const ted4_strict_layer *l, const float *x, float *y);
void ted4_strict_dense_avx512(const ted4_strict_layer *l, const float *x, float *y);
#endif

/* The fastest for this machine; the plain one when the environment says TED4_KERNEL=plain. */
ted4_strict_dense_fn ted4_select_strict_dense(void);

#endif
