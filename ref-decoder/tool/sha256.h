/* sha256.h - SHA-256 (FIPS 180-4) of a byte string that arrives in pieces. It is used for hashes
 * that other programs have to compute too.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SHA256_H
#define TED4_SHA256_H

#include <stddef.h>
#include <stdint.h>

enum { TED4_SHA256_SIZE = 32 };

typedef struct {
    uint32_t state[8];
    uint64_t size;     /* number of bytes so far */
    uint8_t block[64]; /* the last size % 64 of them */
} ted4_sha256;

void ted4_sha256_init(ted4_sha256 *h);
void ted4_sha256_add(ted4_sha256 *h, const void *bytes, size_t size);
void ted4_sha256_end(ted4_sha256 *h, uint8_t out[TED4_SHA256_SIZE]);

#endif
