/* deflate.h - the compressed form of a blob's values, which is used if it is smaller: a zlib stream
 * of their bytes, byte 0 of all values first (spec 7.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DEFLATE_H
#define TED4_DEFLATE_H

#include <stddef.h>
#include <stdint.h>

/* Returns the number of bytes that packed must have room for. */
size_t ted4_deflate_bound(size_t n);

/* Deflates values [n] into packed [ted4_deflate_bound(n)], using work [4 n]. Returns 1 with the
 * deflated size in *size, or 0 if that is not smaller than the values or zlib has no memory. */
int ted4_deflate(const float *values, size_t n, uint8_t *work, uint8_t *packed, size_t *size);

#endif
