/* pack.h - zlib streams (RFC 1950, 1951) of the suite's own making, so that no system's zlib
 * decides what a vector holds.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_PACK_H
#define CONF_PACK_H

#include "text.h"

/* How the bytes are packed, and what is wrong with the stream. */
typedef enum {
    CONF_PACK_FIXED,
    CONF_PACK_DYNAMIC,
    CONF_PACK_MIXED /* a stored block, then fixed */,
    CONF_PACK_SMALL /* fixed, behind a header that speaks of a window of 256 bytes */
} conf_pack_way;
typedef enum {
    CONF_PACK_GOOD,
    CONF_PACK_ADLER,
    CONF_PACK_CHECK /* FCHECK */,
    CONF_PACK_METHOD,
    CONF_PACK_WINDOW,
    CONF_PACK_DICTIONARY,
    CONF_PACK_SHORT /* 4 bytes missing at the end */,
    CONF_PACK_LONG /* 4 too many */,
    CONF_PACK_TRAILING,
    CONF_PACK_CUT /* the last byte missing */,
    CONF_PACK_BLOCK3,
    CONF_PACK_DISTANCE /* before the first byte */,
    CONF_PACK_STORED /* LEN and NLEN disagree */,
    CONF_PACK_OVER /* too many short codes */,
    CONF_PACK_NOT_SHORTER,
    CONF_PACK_EMPTY,
    CONF_PACK_FAULTS
} conf_pack_fault;

/* Appends the stream. */
void conf_pack(conf_bytes *out, const uint8_t *data, size_t size, conf_pack_way way,
               conf_pack_fault fault);

/* Word to way or fault: -1 when there is none of that name. */
int conf_pack_way_of(const char *name);
int conf_pack_fault_of(const char *name);

/* n binary32 as the bytes that mode 1 packs (spec 7.2). */
void conf_shuffle(uint8_t *to, const float *values, size_t n);

#endif
