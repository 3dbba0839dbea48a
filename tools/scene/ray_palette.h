/* ray_palette.h - reduces a picture to few colours by halving boxes of its colours (median cut).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_PALETTE_H
#define RAY_PALETTE_H

#include <stddef.h>
#include <stdint.h>

enum { TED4_RAY_PALETTE = 256 };

/* Converts rgba [n][4] to at most TED4_RAY_PALETTE colours and one index per pixel. Returns the
 * number of colours, or -1 without memory. */
int ted4_ray_palette(const uint8_t *rgba, size_t n, uint8_t palette[TED4_RAY_PALETTE][4],
                     uint8_t *index);

#endif
