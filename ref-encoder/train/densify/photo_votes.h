/* photo_votes.h - photo votes: in which frames a given colour is seen at a given point. They tell
 * short-lived content from permanent content. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PHOTO_VOTES_H
#define TED4_PHOTO_VOTES_H

#include "train/state/trainer.h"

/* Least number of cameras per frame. With fewer cameras, chance matches decide. */
enum { TED4_CAMERAS_NEEDED = 3 };

/* Returns the largest number of training pictures of one frame, or 0 if memory ran out. */
uint32_t ted4_most_cameras(const ted4_dataset *d);

/* Two colours agree if they differ by less than this many steps of 255, averaged over the
 * channels. */
#define TED4_COLOUR_NEAR 28

/* Returns how far apart two colours with these differences are, summed over the channels. */
static inline int ted4_channels_far(int r, int g, int b)
{
    return (r < 0 ? -r : r) + (g < 0 ? -g : g) + (b < 0 ? -b : b);
}

static inline int ted4_colour_far(const uint8_t a[3], const uint8_t b[3])
{
    return ted4_channels_far(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

static inline int ted4_colour_agrees(const uint8_t a[3], const uint8_t b[3])
{
    return ted4_colour_far(a, b) < 3 * TED4_COLOUR_NEAR;
}

typedef struct {
    const float *point;    /* borrowed: [n][3], normalised space */
    const uint8_t *colour; /* borrowed: [n][3] */
    size_t n;
    uint32_t n_frames;
    uint16_t *hits, *seen; /* owned: [n_frames][n] number of training cameras that agree, and that
                              observe the point */
} ted4_photo_votes;

/* Returns the largest number of points of which votes are counted at a time: points times frames
 * must not exceed 2^27, at four bytes each. Only long sequences come near this limit. */
static inline size_t ted4_photo_votes_capacity(uint32_t n_frames)
{
    return ((size_t)1 << 27) / n_frames;
}

/* Counts the votes of all training pictures. Returns 0, or -1 with t->message filled; free s in
 * either case. */
int ted4_photo_votes_count(ted4_photo_votes *s, ted4_trainer *t, const float *point,
                           const uint8_t *colour, size_t n);
void ted4_photo_votes_free(ted4_photo_votes *s);

/* The frames from..to in which something exists. before and after: distance in frames to the
 * nearest earlier and later frame in which it is known to be absent; 1 if there is no such
 * frame. */
typedef struct {
    uint32_t from, to, before, after;
} ted4_span;

/* Returns the frame in which the colour of point i is seen by the largest share of the cameras that
 * observe the point. */
uint32_t ted4_photo_votes_best(const ted4_photo_votes *s, size_t i);

/* Finds the run of frames around a given frame in which the colour of point i is present; content
 * that returns has several runs. Frames in which fewer than TED4_CAMERAS_NEEDED cameras observe the
 * point (held-out frames, for example) neither end a run nor count. Returns 1 with *span filled, or
 * 0 in either of two cases: in that frame, fewer than half of the cameras see the colour, or
 * clearly fewer than in the best frame; or the content is permanent, that is, present in more than
 * half of the frames, and missed by nearly all cameras in fewer than a quarter of them. */
int ted4_photo_votes_span(const ted4_photo_votes *s, size_t i, uint32_t frame, ted4_span *span);

/* Sets the activation of anchor i to cover a span. It almost vanishes in the frames next to the
 * span: something that moves by its own size from frame to frame would otherwise appear at three
 * places at once. Across frames with too few observations it fades slowly, so that half-way both
 * the old and the new content are visible. */
void ted4_span_set(ted4_trainer *t, size_t i, const ted4_span *span);

#endif
