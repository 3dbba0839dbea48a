/* shown.h - training pictures that are inspected together before training, and a mask per picture
 * of the pixels that differ from a plain background. Depends on dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SHOWN_H
#define TED4_SHOWN_H

#include "data/dataset.h"

/* The pictures are all training pictures, or those of evenly spaced frames that have any, or evenly
 * spaced ones of a single frame, so that they are at most TED4_SHOWN_MOST and take at most
 * TED4_SHOWN_BYTES. There are none if no picture is for training. */
enum { TED4_SHOWN_MOST = 128 };
#define TED4_SHOWN_BYTES ((size_t)512 << 20)

typedef struct {
    ted4_dataset *data; /* borrowed */
    size_t picture[TED4_SHOWN_MOST];
    const uint8_t *rgb[TED4_SHOWN_MOST]; /* pixels, held until ted4_shown_free; NULL: not read */
    /* bits[i]: owned; one bit per pixel, row-major, set where the pixel is foreground. If the
     * background is not plain, all bits are set. */
    uint64_t *bits[TED4_SHOWN_MOST];
    size_t n;
    int plain;
    uint8_t background[3]; /* valid if plain */
} ted4_shown;

/* Reads the pictures of a verified dataset. The background is plain if at least half of the border
 * pixels of all pictures are within 8 levels of one colour. Returns 0, or -1 with *m filled. The
 * caller must free *s in either case. */
int ted4_shown_read(ted4_shown *s, ted4_dataset *d, ted4_message *m);
void ted4_shown_free(ted4_shown *s);

/* Is the pixel of picture i foreground? i counts the pictures of *s. */
static inline int ted4_shown_at(const ted4_shown *s, size_t i, size_t pixel)
{
    return (int)(s->bits[i][pixel / 64] >> pixel % 64 & 1);
}

/* Gives the pixel of picture i into which a point in world coordinates projects. Returns 1, or 0 if
 * the point does not project into the picture. */
int ted4_shown_pixel(const ted4_shown *s, size_t i, const double world[3], size_t *pixel);
/* Counts the pictures into which a point in world coordinates projects (*seen), and those of them
 * whose pixel there is foreground (*shown). */
void ted4_shown_count(const ted4_shown *s, const double world[3], int *seen, int *shown);

#endif
