/* int_dense_vnni.c - instantiates int_tile.h for AVX-512 with VNNI, one instruction of which adds
 * two products to a sum without saturation. SPDX-License-Identifier: BSD-2-Clause */
#if defined(__x86_64__)

#include "kernel/int_dense_512.h"

static inline vector dot(vector sum, vector x, vector w)
{
    return _mm512_dpwssd_epi32(sum, x, w);
}

#include "kernel/int_tile.h"

const ted4_int_dense ted4_int_dense_vnni = { hidden, last };

#else
typedef int ted4_int_dense_vnni_is_for_x86_64;
#endif
