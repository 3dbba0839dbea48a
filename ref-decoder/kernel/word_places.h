/* word_places.h - byte shuffles that distribute words to four lanes: for each subset of the lanes,
 * the positions of the bytes that each lane gets. The chosen lanes get one word (two bytes) each,
 * in the order of lanes, followed by zeros; the others get zeros.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_WORD_PLACES_H
#define TED4_WORD_PLACES_H

#include <stdint.h>

/* NO is a lane without a word; AT(i) is a lane with word i. 255 is not the position of any byte, so
 * that the byte shuffle yields 0. */
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
