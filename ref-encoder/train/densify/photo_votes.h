/* photo_votes.h - at which times a colour is seen at a place: what tells things that come and go
 * from things that stay. Depends on trainer.h, alternating_cameras.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PHOTO_VOTES_H
#define TED4_PHOTO_VOTES_H

#include "train/state/trainer.h"
#include "alternating_cameras.h"

/* Colours agree when they differ by less than this many of 255, averaged over the channels. */
#define TED4_COLOUR_NEAR 28
static inline int ted4_colour_far(const uint8_t a[3], const uint8_t b[3])
{
    const int r = a[0] - b[0], g = a[1] - b[1], l = a[2] - b[2];

    return (r < 0 ? -r : r) + (g < 0 ? -g : g) + (l < 0 ? -l : l);
}

static inline int ted4_colour_agrees(const uint8_t a[3], const uint8_t b[3])
{
    return ted4_colour_far(a, b) < 3 * TED4_COLOUR_NEAR;
}

/* Pixel number (row major) and depth of a point of normalised space in a view; 0 where it is not in
 * the picture. */
static inline int ted4_view_pixel(const ted4_view *v, const float p[3], size_t *pixel, float *depth)
{
    const float z = v->R[6] * p[0] + v->R[7] * p[1] + v->R[8] * p[2] + v->t[2];

    if (z <= v->near_z)
        return 0;
    const float x = v->fx * (v->R[0] * p[0] + v->R[1] * p[1] + v->R[2] * p[2] + v->t[0]) / z +
                    v->cx;
    const float y = v->fy * (v->R[3] * p[0] + v->R[4] * p[1] + v->R[5] * p[2] + v->t[1]) / z +
                    v->cy;

    if (!(x >= 0 && y >= 0 && x < (float)v->width && y < (float)v->height))
        return 0;
    *pixel = (size_t)y * (size_t)v->width + (size_t)x;
    *depth = z;
    return 1;
}

typedef struct {
    const float *point;    /* borrowed: [n][3], normalised space */
    const uint8_t *colour; /* borrowed: [n][3] */
    size_t n;
    uint32_t n_frames;
    uint16_t *hits, *seen; /* owned: [n_frames][n] training cameras that agree, training cameras
                              that look there */
} ted4_photo_votes;

/* Looks at every training picture. Those of reach frames before and after a frame count as its own
 * (alternating_cameras.h). 0, or -1 with t->message. Free it in either case. */
int ted4_photo_votes_count(ted4_photo_votes *s, ted4_trainer *t, const float *point,
                           const uint8_t *colour, size_t n, uint32_t reach);
void ted4_photo_votes_free(ted4_photo_votes *s);

/* Frames from..to; how many frames before and after them the next time is at which the thing is
 * known to be gone, 1 where there is none. */
typedef struct {
    uint32_t from, to, before, after;
} ted4_span;

/* The time at which the largest share of the cameras that look there see the colour of point i. */
uint32_t ted4_photo_votes_best(const ted4_photo_votes *s, size_t i);

/* The run of times around a frame at which the colour of point i is there: what comes back is there
 * in several runs. Times at which fewer than TED4_CAMERAS_NEEDED cameras look there, held-out ones
 * for example, neither end a run nor count. 0: at that frame fewer than half of the cameras see the
 * colour, or clearly fewer than at its best; or it does not come and go: it is there at more than
 * half of the times, and nearly all cameras miss it at less than a quarter of them. */
int ted4_photo_votes_span(const ted4_photo_votes *s, size_t i, uint32_t frame, ted4_span *span);

/* Activation of anchor i over a span, almost gone at the times next to it: what moves by its own
 * size in a frame would else be seen at three places at once. Over times that nobody knows it fades
 * slowly: half-way what was there before and what comes then are seen together. */
void ted4_span_set(ted4_trainer *t, size_t i, const ted4_span *span);

#endif
