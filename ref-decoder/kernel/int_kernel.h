/* int_kernel.h - faster, bit-exact variants of norm/int_dense.c, and the selection of one of them.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INT_KERNEL_H
#define TED4_INT_KERNEL_H

#include "norm/prior.h"

#if defined(__x86_64__)
/* vnni: AVX-512 with its VNNI extension. */
extern const ted4_int_dense ted4_int_dense_avx2, ted4_int_dense_avx512, ted4_int_dense_vnni;
#elif defined(__AARCH64EL__)
extern const ted4_int_dense ted4_int_dense_neon;
#endif

/* Returns the variant for the wanted level (base/level.h), which is never NULL. */
const ted4_int_dense *ted4_select_int_dense(void);

#endif
