/* mend.h - hashes of changed files made right again, so that changes reach what lies behind them; and what else needs the frames only.
 * Used by fz_decode.c, mutator.c, make_corpus.c, bench/robust.c, tests/test_fuzz.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MEND_H
#define TED4_MEND_H

#include <stddef.h>
#include <stdint.h>

/* spec 5.2: the hash of every chunk that fits in the file, from the first one on. */
void ted4_mend_chunks(uint8_t *data, size_t size);
/* spec 5.4: where nothing else is wrong with the file, the hash in ENDS, and that of its chunk. */
void ted4_mend_ends(uint8_t *data, size_t size);

/* What a writer knows of a valid file: its critical chunks, minor version 0. to: room for size bytes. Gives how many there are. */
size_t ted4_plain_file(uint8_t *to, const uint8_t *from, size_t size);

/* Offset of the chunk that holds byte at, or size: it lies in none. */
size_t ted4_chunk_holding(const uint8_t *data, size_t size, size_t at);

#endif
