/* pack.h - writes zlib streams (RFC 1950, 1951) with code of its own, so that the bytes of a vector
 * do not depend on the installed zlib.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_PACK_H
#define CONF_PACK_H

#include "text.h"

/* How the bytes are packed, and which fault the stream has. */
typedef enum {
    CONF_PACK_FIXED,
    CONF_PACK_DYNAMIC,
    CONF_PACK_MIXED /* a stored block, then a block of fixed codes */,
    CONF_PACK_SMALL /* fixed codes, after a header that declares a window of 256 bytes */
} conf_pack_way;
typedef enum {
    CONF_PACK_GOOD,
    CONF_PACK_ADLER,
    CONF_PACK_CHECK /* wrong FCHECK */,
    CONF_PACK_METHOD,
    CONF_PACK_WINDOW,
    CONF_PACK_DICTIONARY,
    CONF_PACK_SHORT /* the last 4 bytes are missing */,
    CONF_PACK_LONG /* 4 bytes too many */,
    CONF_PACK_TRAILING,
    CONF_PACK_CUT /* the last byte is missing */,
    CONF_PACK_BLOCK3,
    CONF_PACK_DISTANCE /* a distance to before the first byte */,
    CONF_PACK_STORED /* LEN and NLEN disagree */,
    CONF_PACK_OVER /* too many short codes */,
    CONF_PACK_NOT_SHORTER,
    CONF_PACK_EMPTY,
    CONF_PACK_FAULTS
} conf_pack_fault;

/* Appends the stream to out. */
void conf_pack(conf_bytes *out, const uint8_t *data, size_t size, conf_pack_way way,
               conf_pack_fault fault);

/* Return the way or the fault of that name, or -1 if there is none. */
int conf_pack_way_of(const char *name);
int conf_pack_fault_of(const char *name);

/* Stores the Adler-32 of the data as the last 4 bytes of a zlib stream. */
void conf_adler(uint8_t check[4], const uint8_t *data, size_t size);

/* Stores n binary32 values as the bytes that mode 1 packs (spec 7.2). */
void conf_shuffle(uint8_t *to, const float *values, size_t n);

#endif
