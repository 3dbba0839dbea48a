/* blocks.h - writes a zlib stream whose blocks a recipe spells out bit by bit, for the choices that
 * RFC 1951 leaves to a decoder (spec 7.2, R-NET-007).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_BLOCKS_H
#define CONF_BLOCKS_H

#include "recipe.h"
#include "text.h"

/* Appends to out the zlib header, the blocks that the words of l from word i on describe, and the
 * Adler-32 of the size bytes of data, which the blocks are meant to give. Words:
 *     V/N      the number V in N bits, lowest bit first
 *     :BITS    a code: these binary digits, as they stand
 *     empty    a stored block of no bytes, not the last
 *     zeros    bits 0 up to the end of the byte; ones: bits 1
 * WORD*N is a word N times. Ends the program if a word is none of these. */
void conf_blocks(conf_bytes *out, const conf_line *l, int i, const uint8_t *data, size_t size);

#endif
