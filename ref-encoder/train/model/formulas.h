/* formulas.h - formulas of the specification that several files of the trainer evaluate, each
 * defined once. All are functions of one lane, called from loops over lanes. pow2 is the power of
 * two that the calling file may use: ted4_lane_pow2 in files that are compiled once per level, else
 * ted4_pow2.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FORMULAS_H
#define TED4_FORMULAS_H

#include <stdint.h>

#include "model.h"
#include "norm/sine.h"
#include "recon/strict.h"

/* spec 11.4: the smallest width of an edge of the activation. */
#define TED4_EDGE_MIN      0x1p-12f
#define TED4_EDGE_MIN_LOG2 (-12.0f)

/* A vector shorter than this has no direction, and a linear scale is clamped to it (spec 11.1,
 * 11.5). */
#define TED4_SHORT 0x1p-20f

/* spec 11.4: the edge that t lies beyond (side -1: before the start, 1: after the end, 0: neither),
 * its width, which is at least TED4_EDGE_MIN, and u. */
typedef struct {
    int side;
    float width, u;
} ted4_edge;

/* tau: start, log2 of its width, end, log2 of its width, TED4_LANES floats apart, as stored in
 * blocks. t is from 0 to 1. */
static inline ted4_edge ted4_find_edge(float t, const float *tau, float (*pow2)(float))
{
    const float start = tau[0], start_width = tau[TED4_LANES];
    const float end = tau[2 * TED4_LANES], end_width = tau[3 * TED4_LANES];
    const int side = t < start ? -1 : t > end;
    const float at = side < 0 ? start : end;
    const float b = pow2(side < 0 ? start_width : end_width);
    const float width = b > TED4_EDGE_MIN ? b : TED4_EDGE_MIN;
    const ted4_edge e = { side, width, side != 0 ? (t - at) / width : 0.0f };

    return e;
}

/* spec 11.4: the activation for a given u, from 0 to 1. */
static inline float ted4_activation(float u, float (*pow2)(float))
{
    return pow2(-(u * u) * TED4_LOG2E);
}

/* spec 10.1: an integer of the specification, divided by 4096. */
static inline float ted4_from_q12(int32_t x)
{
    return (float)x * 0x1p-12f;
}

/* spec 10.1: ted4_encode_coordinate rounds a coordinate down to a multiple of 2^-12, and
 * ted4_encode_phase returns its phase in the first octave. */
static inline float ted4_encode_coordinate(float p)
{
    return __builtin_floorf(p * 0x1p12f) * 0x1p-12f;
}

static inline uint32_t ted4_encode_phase(float p)
{
    return (uint32_t)(int32_t)(p * 0x1p24f) << 7;
}

/* spec 10.1: sine and cosine of the phase of an octave; the cosine is the sine a quarter turn
 * later. */
static inline float ted4_encode_sine(uint32_t phase)
{
    return ted4_from_q12(ted4_sine(phase));
}

static inline float ted4_encode_cosine(uint32_t phase)
{
    return ted4_from_q12(ted4_sine(phase + ((uint32_t)1 << 30)));
}

/* spec 11.2: returns the row of the bank at or before time num / den. *mix is the position between
 * it and the next row, in [0, 1). At the last row (num = den) *mix is 0, and the next row is not
 * read. */
static inline size_t ted4_bank_row(const ted4_header *h, uint32_t num, uint32_t den, float *mix)
{
    const uint64_t g = num * (uint64_t)(h->bank_rows - 1);

    *mix = (float)(g % den) / (float)den;
    return (size_t)(g / den);
}

/* spec 11.5: turns the vector from the camera to an anchor into its direction. A vector without a
 * direction gives the z axis. */
static inline void ted4_view_direction(float *x, float *y, float *z)
{
    const float n = __builtin_sqrtf(*x * *x + *y * *y + *z * *z);
    const int far = n >= TED4_SHORT;
    const float scale = far ? 1.0f / n : 0.0f;

    *x *= scale;
    *y *= scale;
    *z = far ? *z * scale : 1.0f;
}

/* Interpolates channel c of the bank. z: the row from ted4_bank_row, of dim channels. */
static inline float ted4_bank_value(const float *z, size_t dim, size_t c, float mix)
{
    return mix > 0.0f ? z[c] + mix * (z[dim + c] - z[c]) : z[c];
}

#endif
