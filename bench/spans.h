/* spans.h - declarations shared by spans.c, which reads a file and prints, spans_view.c, which
 * draws it, and spans_where.c, which compares it with the true pictures.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPANS_H
#define TED4_SPANS_H

#include "data/dataset.h"
#include "render/view.h"

/* Spans up to SHORT count as short, spans of at least LONG as long (the paper's table). */
#define SHORT 0.2f
#define LONG  0.8f

typedef struct {
    ted4_scene *scene; /* owned, as all below */
    ted4_recon *recon;
    ted4_viewer *viewer;
    ted4_dataset data;
    ted4_info info;
    float *span;       /* [N] */
    float *colour;     /* [3][n_gaussians] */
    int width, height; /* size of one view */
    uint8_t *view;     /* [height][width][3]: the last view drawn */
    uint8_t *picture;  /* [2 height + STRIP][3 width][3] */
} session;

/* Prints a line and returns TED4_EXIT_TOOL. */
int failed(const char *what, const char *why);

/* All functions below return an exit code, and have printed a line if it is not TED4_EXIT_FINE. */

/* Draws the view of picture p into s->view, over black. paint: NULL for the Gaussians' own colours,
 * or a function that gives the colour for the span of the anchor. Colours are dimmed where the
 * Gaussian is dark, to no less than dimmest (1: not dimmed). spans_view.c */
int draw_view(session *s, const ted4_picture *p, void (*paint)(float span, float rgb[3]),
              float dimmest);

/* Draws the picture for PICTURE.png (spans.c) into s->picture. spans_view.c */
enum { COLUMNS = 3, STRIP = 10 };
int draw_picture(session *s);

/* Tests whether short-lived anchors are drawn where the scene changes, over all held-out pictures
 * of the first held-out camera, if it does not move and has at least five. A pixel has changed at a
 * time if a channel of the true picture differs by more than 40 of 255 from its median over these
 * times. share: the share of light from anchors with short spans, as the mean over pixels and times
 * that have not changed (share[0]) and that have (share[1]). count: their numbers; both are 0 if
 * nothing could be compared. spans_where.c */
typedef struct {
    double share[2], count[2];
} spans_where;
int short_lives_where(session *s, spans_where *w);

/* Returns the held-out picture nearest to time column / 2, of the camera of the first held-out
 * picture, or NULL. spans_view.c */
const ted4_picture *held_out(const session *s, int column);

#endif
