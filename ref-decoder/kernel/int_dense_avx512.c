/* int_dense_avx512.c - instantiates int_tile.h for AVX-512.
 * SPDX-License-Identifier: BSD-2-Clause */
#if defined(__x86_64__)

#include "kernel/int_dense_512.h"

static inline vector dot(vector sum, vector x, vector w)
{
    return _mm512_add_epi32(sum, _mm512_madd_epi16(x, w));
}

#include "kernel/int_tile.h"

const ted4_int_dense ted4_int_dense_avx512 = { hidden, last };

#else
typedef int ted4_int_dense_avx512_is_for_x86_64;
#endif
