/* fix_hashes.h - repairs of a changed file, so that a decoder gets as far as the change: the hashes
 * of chunks, the hash in ENDS, and the words of the range coder. Also helpers that need the frames
 * of chunks only.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FIX_HASHES_H
#define TED4_FIX_HASHES_H

#include <stddef.h>
#include <stdint.h>

/* Corrects the hash (spec 5.2) of every chunk that fits in the file, from the first one on. */
void ted4_fix_hashes(uint8_t *data, size_t size);
/* Corrects the hash in ENDS (spec 5.4) and that of its chunk, if nothing else is wrong with the
 * file. */
void ted4_fix_rans_ends(uint8_t *data, size_t size);
/* Makes a valid file (spec 9.2) from one whose substreams hold arbitrary bytes (see parse.h): the
 * symbols decoded from them are coded again. Ancillary chunks are left out. Returns the new size,
 * at most max_size; or size, with nothing changed, if there is no such file or it is larger than
 * max_size. */
size_t ted4_fix_range_codes(uint8_t *data, size_t size, size_t max_size);

/* Writes the part of a valid file that a writer knows: its critical chunks, and the lowest minor
 * version. to: room for size bytes. Returns the number of bytes written. */
size_t ted4_plain_file(uint8_t *to, const uint8_t *from, size_t size);

/* Returns the bytes of the chunk at an offset, including its hash, or 0 if it does not fit. */
size_t ted4_chunk_size(const uint8_t *data, size_t size, size_t at);
/* Returns the offset of the chunk that contains byte at, or size if no chunk does. */
size_t ted4_chunk_holding(const uint8_t *data, size_t size, size_t at);
/* Returns the size of the file without the bytes after its chunk ENDS if these are at most most
 * bytes (knobs of a harness), else size. */
size_t ted4_without_tail(const uint8_t *data, size_t size, size_t most);

#endif
