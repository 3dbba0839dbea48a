/* moving_pixels.h - which pixels of a picture show what moves: those that differ from the median
 * over time of a camera that stands still. The quality there says how well motion is reproduced,
 * which a mean over whole pictures hides where little moves. The masks depend on the pictures of
 * the scene alone, so they are the same for every file. Depends on data/dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MOVING_PIXELS_H
#define TED4_MOVING_PIXELS_H

#include "data/dataset.h"

enum {
    /* A median is over at most this many pictures, spread evenly over all of the camera. */
    TED4_MOVING_PICTURES = 15,
    TED4_MOVING_FEWEST = 5, /* and over at least so many */
    /* A pixel shows what moves if it differs from the median by more than this in a channel, in
     * levels of 255: more than what video compression does to what stands still. */
    TED4_MOVING_LEVELS = 16
};

typedef struct {
    double square;        /* sum of squared differences over pixels and channels, range 1 */
    size_t pixels, views; /* pixels that show what moves; pictures of cameras with a median */
} ted4_moving_sum;

/* Gives the median pictures, by channel, of all cameras that have a picture with this is_test:
 * *median, [d->n_cameras][height][width][3]. Each is over pictures of the camera of both splits,
 * and NULL if it has fewer than TED4_MOVING_FEWEST, or if its pose or lens changes. Returns 0, or
 * -1 with *m filled if a picture cannot be read or memory ran out. The caller calls
 * ted4_moving_free in either case. */
int ted4_moving_medians(ted4_dataset *d, int is_test, uint8_t ***median, ted4_message *m);
void ted4_moving_free(uint8_t **median, uint32_t n_cameras); /* median may be NULL */

/* Adds a picture to the sums. median, truth, ours: [pixels][3]. mask, [pixels][3]: made white where
 * the picture shows what moves, and black elsewhere; may be NULL. */
void ted4_moving_add(ted4_moving_sum *s, const uint8_t *median, const uint8_t *truth,
                     const uint8_t *ours, size_t pixels, uint8_t *mask);

/* Returns the PSNR over all pixels of the sums, in dB; NAN if there are none, INFINITY if they all
 * equal the truth. */
double ted4_moving_psnr(const ted4_moving_sum *s);

#endif
