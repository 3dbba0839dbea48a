/* bytes.h - spec 4.2: loads and stores little-endian numbers on machines of any byte order, and
 * writes bytes as hexadecimal text.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BYTES_H
#define TED4_BYTES_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static inline uint16_t ted4_load16(const uint8_t *p)
{
    return (uint16_t)(p[0] | p[1] << 8);
}

static inline uint32_t ted4_load32(const uint8_t *p)
{
    return (uint32_t)ted4_load16(p) | (uint32_t)ted4_load16(p + 2) << 16;
}

static inline uint64_t ted4_load64(const uint8_t *p)
{
    return (uint64_t)ted4_load32(p) | (uint64_t)ted4_load32(p + 4) << 32;
}

static inline void ted4_store16(uint8_t *p, uint16_t v)
{
    p[0] = (uint8_t)v;
    p[1] = (uint8_t)(v >> 8);
}

static inline void ted4_store32(uint8_t *p, uint32_t v)
{
    ted4_store16(p, (uint16_t)v);
    ted4_store16(p + 2, (uint16_t)(v >> 16));
}

static inline void ted4_store64(uint8_t *p, uint64_t v)
{
    ted4_store32(p, (uint32_t)v);
    ted4_store32(p + 4, (uint32_t)(v >> 32));
}

/* Return the bit pattern of a binary32, and the binary32 that has a given pattern. */
static inline uint32_t ted4_float_bits(float x)
{
    uint32_t u;

    memcpy(&u, &x, sizeof u);
    return u;
}

static inline float ted4_bits_float(uint32_t u)
{
    float x;

    memcpy(&x, &u, sizeof x);
    return x;
}

/* R-CNV-001: returns 1 if the binary32 with this pattern is finite, not subnormal and not negative
 * zero, else 0. */
static inline int ted4_float_legal(uint32_t bits)
{
    const uint32_t e = bits >> 23 & 255;

    return bits == 0 || (e > 0 && e < 255);
}

/* Writes n bytes as 2 n lower-case hexadecimal digits and a terminating 0. */
static inline void ted4_hex(char *to, const uint8_t *bytes, size_t n)
{
    static const char digit[] = "0123456789abcdef";

    for (size_t i = 0; i < n; i++) {
        to[2 * i] = digit[bytes[i] >> 4];
        to[2 * i + 1] = digit[bytes[i] & 15];
    }
    to[2 * n] = '\0';
}

#endif
