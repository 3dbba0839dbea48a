/* mutate.h - changes of a .ted4 file that get past the checks of its frames: one part of the file
 * is changed, and most of the time everything that depends on it is corrected.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_MUTATE_H
#define TED4_FUZZ_MUTATE_H

#include <stddef.h>
#include <stdint.h>

/* Changes size bytes, which may become up to max_size. Returns their new number. */
typedef size_t fuzz_bytes_fn(uint8_t *data, size_t size, size_t max_size);

/* The simplest such function: flips the lowest bit of the middle byte. */
static inline size_t fuzz_flip_middle(uint8_t *data, size_t size, size_t max_size)
{
    (void)max_size;
    if (size > 0)
        data[size / 2] ^= 1;
    return size;
}

/* Makes one change: a field gets a value at or near a bound; a symbol or weight of the parsed scene
 * changes (written again by the encoder); bytes of one payload change; a chunk is dropped, doubled,
 * moved or inserted; another scene replaces the file; or the knobs after ENDS change. Then hashes,
 * the hash of ENDS and, if a TILE was changed, the range coder's words are corrected; one time in
 * sixteen one of these is left wrong. bytes: changes bytes whose structure is unknown. The same
 * arguments give the same result. Returns the new size. */
size_t fuzz_mutate_file(uint8_t *data, size_t size, size_t max_size, uint32_t seed,
                        fuzz_bytes_fn *bytes);

/* The same for pass 1 alone, which parses no payload: changes a chunk or bytes of a payload, and
 * corrects the hashes. Much faster. */
size_t fuzz_mutate_frames(uint8_t *data, size_t size, size_t max_size, uint32_t seed,
                          fuzz_bytes_fn *bytes);

/* Copies the first file with a chunk of the second file, in place of its own chunk of that type or
 * in addition to it, and corrects the result as above. to: room for max_size bytes. Returns the
 * size, or 0 if the two do not fit together. */
size_t fuzz_cross_files(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size,
                        uint8_t *to, size_t max_size, uint32_t seed);

#endif
