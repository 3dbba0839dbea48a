/* gauss_kernel.h - symbols of a substream several lanes at a time (spec 9.2, 9.4), and whether this
 * machine can.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GAUSS_KERNEL_H
#define TED4_GAUSS_KERNEL_H

#include <stddef.h>
#include <stdint.h>

/* A substream under way. */
typedef struct {
    uint32_t *state;           /* borrowed: [n_lanes] */
    unsigned n_lanes, lane;    /* lane: of the next symbol */
    const uint8_t *word, *end; /* borrowed: the words not read yet */
} ted4_gauss_lanes;

/* With fewer lanes it is not worth asking. */
enum { TED4_MANY_LANES = 4 };

/* Reads the next symbols as reader.c would, of at most n > 0; mu, sigma, k as in ted4_coder_ops,
 * and k[n] may be written ahead. Returns how many it took, and leaves d->word behind their words
 * and d->lane alone. It stops where a symbol has to be read by itself: at an escape, a symbol out
 * of range, and where words are missing. */
typedef size_t (*ted4_gauss_many)(ted4_gauss_lanes *d, size_t n, const int32_t *mu,
                                  const uint8_t *sigma, int16_t *k);

#if defined(__x86_64__)
size_t ted4_gauss_many_avx2(ted4_gauss_lanes *d, size_t n, const int32_t *mu, const uint8_t *sigma,
                            int16_t *k);
size_t ted4_gauss_many_avx512(ted4_gauss_lanes *d, size_t n, const int32_t *mu,
                              const uint8_t *sigma, int16_t *k);
#elif defined(__AARCH64EL__)
size_t ted4_gauss_many_neon(ted4_gauss_lanes *d, size_t n, const int32_t *mu, const uint8_t *sigma,
                            int16_t *k);
#endif

/* That of the level wanted (base/level.h). NULL: it has none. */
ted4_gauss_many ted4_select_gauss_many(void);

#endif
