/* encode.c - computes the positional encodings E(p) and E(t) of the inr motion (spec 11.3).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/sine.h"
#include "recon/recon.h"

enum { OCTAVES = 10 };

static float from_q12(int32_t x)
{
    return (float)x / 4096.0f;
}

void ted4_recon_encode(const int32_t *x, unsigned n, float *code)
{
    for (unsigned c = 0; c < n; c++)
        *code++ = from_q12(ted4_floor_shift(x[c], 12));
    for (unsigned octave = 0; octave < OCTAVES; octave++)
        for (unsigned c = 0; c < n; c++) {
            const uint32_t u = (uint32_t)x[c] << (7 + octave);

            *code++ = from_q12(ted4_sine(u));
            *code++ = from_q12(ted4_sine(u + ((uint32_t)1 << 30)));
        }
}
