/* gauss_vector.h - types of gauss_tile.h: LANES elements of 32 bits, VECTOR bytes. The file that
 * includes it defines VECTOR.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GAUSS_VECTOR_H
#define TED4_GAUSS_VECTOR_H

#include <stdint.h>

enum { LANES = VECTOR / 4 };

typedef int32_t vi __attribute__((vector_size(VECTOR)));
typedef float vf __attribute__((vector_size(VECTOR)));
typedef uint32_t vu __attribute__((vector_size(VECTOR)));

#endif
