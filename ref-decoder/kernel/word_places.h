/* word_places.h - for each choice of four lanes, which of the next bytes each of them gets: two, a
 * word, for those that were chosen, in the order of lanes, and zeros.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_WORD_PLACES_H
#define TED4_WORD_PLACES_H

#include <stdint.h>

/* NO: a lane that gets none; AT(i): one that gets word i. 255 is no byte's number, which a byte
 * shuffle answers with 0. */
#define TED4_NO    255, 255, 255, 255
#define TED4_AT(i) 2 * (i), 2 * (i) + 1, 255, 255

_Alignas(16) static const uint8_t ted4_word_places[16][16] = {
    { TED4_NO, TED4_NO, TED4_NO, TED4_NO },
    { TED4_AT(0), TED4_NO, TED4_NO, TED4_NO },
    { TED4_NO, TED4_AT(0), TED4_NO, TED4_NO },
    { TED4_AT(0), TED4_AT(1), TED4_NO, TED4_NO },
    { TED4_NO, TED4_NO, TED4_AT(0), TED4_NO },
    { TED4_AT(0), TED4_NO, TED4_AT(1), TED4_NO },
    { TED4_NO, TED4_AT(0), TED4_AT(1), TED4_NO },
    { TED4_AT(0), TED4_AT(1), TED4_AT(2), TED4_NO },
    { TED4_NO, TED4_NO, TED4_NO, TED4_AT(0) },
    { TED4_AT(0), TED4_NO, TED4_NO, TED4_AT(1) },
    { TED4_NO, TED4_AT(0), TED4_NO, TED4_AT(1) },
    { TED4_AT(0), TED4_AT(1), TED4_NO, TED4_AT(2) },
    { TED4_NO, TED4_NO, TED4_AT(0), TED4_AT(1) },
    { TED4_AT(0), TED4_NO, TED4_AT(1), TED4_AT(2) },
    { TED4_NO, TED4_AT(0), TED4_AT(1), TED4_AT(2) },
    { TED4_AT(0), TED4_AT(1), TED4_AT(2), TED4_AT(3) },
};

#endif
