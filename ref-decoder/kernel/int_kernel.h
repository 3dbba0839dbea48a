/* int_kernel.h - faster twins of norm/int_dense.c, bit for bit equal, and which one this machine
 * takes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INT_KERNEL_H
#define TED4_INT_KERNEL_H

#include "norm/prior.h"

#if defined(__x86_64__)
/* vnni: AVX-512 with VNNI. */
extern const ted4_int_dense ted4_int_dense_avx2, ted4_int_dense_avx512, ted4_int_dense_vnni;
#elif defined(__AARCH64EL__)
extern const ted4_int_dense ted4_int_dense_neon;
#endif

/* That of the level wanted (base/level.h). */
const ted4_int_dense *ted4_select_int_dense(void);

#endif
