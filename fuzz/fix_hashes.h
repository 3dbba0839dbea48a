/* fix_hashes.h - what a changed file needs so that the change reaches what lies behind it: hashes,
 * the hash of ENDS, the range coder's ends; and what else needs the frames only.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FIX_HASHES_H
#define TED4_FIX_HASHES_H

#include <stddef.h>
#include <stdint.h>

/* spec 5.2: the hash of every chunk that fits in the file, from the first one on. */
void ted4_fix_hashes(uint8_t *data, size_t size);
/* spec 5.4: where nothing else is wrong with the file, the hash in ENDS, and that of its chunk. */
void ted4_fix_rans_ends(uint8_t *data, size_t size);
/* spec 9.2: a file whose TILE payloads hold anything becomes a valid one, with the symbols that
 * come out of them. Ancillary chunks are left out. Gives the new size, at most max_size; size
 * itself, and nothing is changed: there is no such file, or it is larger. */
size_t ted4_fix_range_codes(uint8_t *data, size_t size, size_t max_size);

/* What a writer knows of a valid file: its critical chunks, minor version 0. to: room for size
 * bytes. Gives how many there are. */
size_t ted4_plain_file(uint8_t *to, const uint8_t *from, size_t size);

/* Bytes of the chunk at an offset, its hash included; 0: it does not fit. */
size_t ted4_chunk_size(const uint8_t *data, size_t size, size_t at);
/* Offset of the chunk that holds byte at, or size: it lies in none. */
size_t ted4_chunk_holding(const uint8_t *data, size_t size, size_t at);
/* The file without what stands behind its chunk ENDS, where at most most bytes do: knobs of a
 * harness. Else all of it. */
size_t ted4_without_tail(const uint8_t *data, size_t size, size_t most);

#endif
