/* gauss_kernel.h - reads the symbols of a substream for several lanes at a time (spec 9.2, 9.4), on
 * machines that can.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GAUSS_KERNEL_H
#define TED4_GAUSS_KERNEL_H

#include <stddef.h>
#include <stdint.h>

/* A substream that is being read. */
typedef struct {
    uint32_t *state;           /* borrowed: [n_lanes] */
    unsigned n_lanes, lane;    /* lane: that of the next symbol */
    const uint8_t *word, *end; /* borrowed: the words that are not read yet */
} ted4_gauss_lanes;

/* With fewer lanes, calling a ted4_gauss_many is not worthwhile. */
enum { TED4_MANY_LANES = 4 };

/* Reads up to n > 0 symbols as reader.c would. mu, sigma and k are those of ted4_coder_ops; all of
 * k[n] may be overwritten. Returns the number of symbols read, sets d->word to the first word after
 * them, and does not change d->lane. Stops early at a symbol that has to be read separately: one
 * that is out of range, has an escape that is not valid, or lacks words. */
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

/* Returns the function for the level wanted (base/level.h), or NULL if that level has none. */
ted4_gauss_many ted4_select_gauss_many(void);

#endif
