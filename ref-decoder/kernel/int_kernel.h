/* int_kernel.h - faster twins of norm/int_dense.c, bit for bit equal, and which one this machine takes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INT_KERNEL_H
#define TED4_INT_KERNEL_H

#include "norm/prior.h"

#if defined(__x86_64__)
extern const ted4_int_dense ted4_int_dense_avx2, ted4_int_dense_avx512;
#endif

/* The fastest for this machine; the plain one when the environment says TED4_KERNEL=plain. */
const ted4_int_dense *ted4_select_int_dense(void);

#endif
