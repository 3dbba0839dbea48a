/* gaussian.h - spec 9.4: maps between the symbols of a Gaussian model and their slots.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GAUSSIAN_H
#define TED4_GAUSSIAN_H

#include "base/fixed.h"
#include "norm/tables.h"

enum {
    TED4_SLOT_BITS = 16,
    TED4_ESCAPE_BITS = 19, /* R-ENT-006 */
    TED4_MU_BITS = 8
};

/* A range of the 2^16 slots: [start, start + freq). */
typedef struct {
    uint32_t start, freq;
} ted4_slots;

/* A symbol k as spec 9.4 codes it. escape is e, or -1 if k needs no escape. */
typedef struct {
    ted4_slots slots;
    int32_t escape;
} ted4_gauss_symbol;

/* Returns R, the size of the alphabet for sigma index g. */
static inline uint32_t ted4_gauss_size(unsigned g)
{
    return 2u * ted4_half[g] + 4;
}

/* Returns cum(j) for 0 < j < R. fr is the fractional part of mu, 0 .. 255. */
static inline uint32_t ted4_gauss_inner(unsigned g, int32_t fr, uint32_t j)
{
    const int32_t d = 256 * ((int32_t)j - 1 - ted4_half[g]) - 128 - fr;
    const int32_t z = ted4_clamp(ted4_floor_shift(d * ted4_inv[g], 11), -(1 << 17), 1 << 17);
    const uint32_t at = (uint32_t)(z + (1 << 17));
    const uint32_t i = at / 256, b = at % 256;
    const uint32_t low = (uint32_t)ted4_phi[i];
    const uint32_t high = (uint32_t)ted4_phi[i < 1024 ? i + 1 : 1024];
    const uint32_t p = low + ((high - low) * b >> 8);

    return ((p >> 8) * ((1u << TED4_SLOT_BITS) - ted4_gauss_size(g)) >> TED4_SLOT_BITS) + j;
}

/* Returns cum(j) for 0 <= j <= R. */
static inline uint32_t ted4_gauss_cum(unsigned g, int32_t fr, uint32_t j)
{
    if (j == 0 || j == ted4_gauss_size(g))
        return j == 0 ? 0 : 1u << TED4_SLOT_BITS;
    return ted4_gauss_inner(g, fr, j);
}

/* Returns k as a symbol of the model with mean mu (Q8) and sigma index g. */
ted4_gauss_symbol ted4_gauss_of(int32_t mu, unsigned g, int32_t k);
/* Returns the symbol j whose slots contain slot, and sets *slots to its slots. */
uint32_t ted4_gauss_find(unsigned g, int32_t fr, uint32_t slot, ted4_slots *slots);
/* Return k - m for a symbol j that is not an escape, and for an escape j with value e. */
static inline int32_t ted4_gauss_offset(unsigned g, uint32_t j)
{
    return (int32_t)j - 1 - ted4_half[g];
}
static inline int32_t ted4_gauss_escaped(unsigned g, uint32_t j, int32_t e)
{
    return j == 0 ? -ted4_half[g] - 1 - e : ted4_half[g] + 2 + e;
}

#endif
