/* shown.h - training pictures looked at together before training, and which of their pixels show
 * something, where all have the same plain background: what a point in space is seen against.
 * Depends on dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SHOWN_H
#define TED4_SHOWN_H

#include "data/dataset.h"

/* Training pictures looked at: all, or those of evenly spaced times, so many at most (none,
 * where these are all held out) and no more than fit into so many bytes. */
enum { TED4_SHOWN_MOST = 128 };
#define TED4_SHOWN_BYTES ((size_t)512 << 20)

typedef struct {
    ted4_dataset *data; /* borrowed */
    size_t picture[TED4_SHOWN_MOST];
    const uint8_t *rgb[TED4_SHOWN_MOST]; /* pixels, held until ted4_shown_free; NULL: none */
    uint64_t *bits[TED4_SHOWN_MOST];     /* owned: a bit a pixel, row major, set where it
                                          * shows something; all, if not plain */
    size_t n;
    int plain;
    uint8_t background[3]; /* of a plain one */
} ted4_shown;

/* Reads the pictures (of a verified dataset). The background is plain when half of the pixels at
 * the edges of all pictures are within 8 levels of one colour. 0, or -1 with *m filled. Free it
 * in either case. */
int ted4_shown_read(ted4_shown *s, ted4_dataset *d, ted4_message *m);
void ted4_shown_free(ted4_shown *s);

/* Does the pixel of picture i of those looked at show something? */
static inline int ted4_shown_at(const ted4_shown *s, size_t i, size_t pixel)
{
    return (int)(s->bits[i][pixel / 64] >> pixel % 64 & 1);
}

/* The pixel of picture i that a point of the world lies in. 0: it does not lie in the picture. */
int ted4_shown_pixel(const ted4_shown *s, size_t i, const double world[3], size_t *pixel);
/* Pictures that a point of the world lies in, and those that show something there. */
void ted4_shown_count(const ted4_shown *s, const double world[3], int *seen, int *shown);

#endif
