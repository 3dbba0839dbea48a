/* deflate.h - values as a blob keeps them when that is smaller: a zlib stream of their bytes, byte
 * 0 of all first (spec 7.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DEFLATE_H
#define TED4_DEFLATE_H

#include <stddef.h>
#include <stdint.h>

/* Bytes that packed must have room for. */
size_t ted4_deflate_bound(size_t n);

/* values [n] into packed [ted4_deflate_bound(n)], by way of work [4 n]; *size: what that took. 0:
 * not smaller than the values themselves, or zlib has no memory. */
int ted4_deflate(const float *values, size_t n, uint8_t *work, uint8_t *packed, size_t *size);

#endif
