/* gauss_vector.h - the vector types of gauss_tile.h: LANES elements of 32 bits. The including file
 * defines VECTOR, the size of a vector in bytes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GAUSS_VECTOR_H
#define TED4_GAUSS_VECTOR_H

#include <stdint.h>

enum { LANES = VECTOR / 4 };

typedef int32_t vi __attribute__((vector_size(VECTOR)));
typedef float vf __attribute__((vector_size(VECTOR)));
typedef uint32_t vu __attribute__((vector_size(VECTOR)));

#endif
