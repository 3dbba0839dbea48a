/* mutate.h - changes of a .ted4 file that reach what lies behind its frames: one part of it is
 * changed, and what depends on that is made right again, most of the time.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_MUTATE_H
#define TED4_FUZZ_MUTATE_H

#include <stddef.h>
#include <stdint.h>

/* Changes size bytes, which may become up to max_size; gives how many they are. */
typedef size_t fuzz_bytes_fn(uint8_t *data, size_t size, size_t max_size);

/* One of those: the lowest bit of the middle byte. */
static inline size_t fuzz_flip_middle(uint8_t *data, size_t size, size_t max_size)
{
    (void)max_size;
    if (size > 0)
        data[size / 2] ^= 1;
    return size;
}

/* One change: a field to a value at or near a bound, a symbol or weight of the parsed scene
 * (written again by the encoder), bytes of one payload, a chunk dropped, doubled, moved or put in,
 * another scene altogether, or the knobs behind ENDS. Then hashes, the hash of ENDS and, where a
 * TILE was touched, the range coder's words are made right; one time in sixteen one of these is
 * left wrong. bytes: changes where nothing is known of a structure. The same arguments give the
 * same result. Gives the new size. */
size_t fuzz_mutate_file(uint8_t *data, size_t size, size_t max_size, uint32_t seed,
                        fuzz_bytes_fn *bytes);

/* The same for pass 1 alone, which parses nothing: a chunk or bytes of a payload, and hashes. Much
 * quicker. */
size_t fuzz_mutate_frames(uint8_t *data, size_t size, size_t max_size, uint32_t seed,
                          fuzz_bytes_fn *bytes);

/* The first file with a chunk of the second in place of its own of that type, or beside it; made
 * right as above. to: room for max_size bytes. Gives the size; 0: they do not fit together. */
size_t fuzz_cross_files(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size,
                        uint8_t *to, size_t max_size, uint32_t seed);

#endif
