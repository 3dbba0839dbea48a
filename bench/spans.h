/* spans.h - what spans.c, which reads a file and prints, and spans_view.c, which draws it, and
 * spans_where.c, which compares that with the true pictures, share.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SPANS_H
#define TED4_SPANS_H

#include "data/dataset.h"
#include "render/view.h"

/* Spans at most this count as short, of at least this as long (the paper's table). */
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
    int width, height; /* of one view */
    uint8_t *view;     /* [height][width][3]: what was drawn last */
    uint8_t *picture;  /* [2 height + STRIP][3 width][3] */
} session;

/* Prints a line; TED4_EXIT_TOOL. */
int failed(const char *what, const char *why);

/* All below: an exit code, after a line where it is not TED4_EXIT_FINE. */

/* The view of picture p into s->view: Gaussians in their own colours (paint NULL), or each in the
 * colour of its anchor's span, before black; dimmed to no less than dimmest where the Gaussian is
 * dark (1: not dimmed). spans_view.c */
int draw_view(session *s, const ted4_picture *p, void (*paint)(float span, float rgb[3]),
              float dimmest);

/* The picture for PICTURE.png (spans.c) into s->picture. spans_view.c */
enum { COLUMNS = 3, STRIP = 10 };
int draw_picture(session *s);

/* Whether short lives are drawn where the scene changes: over all held-out pictures of the first
 * held-out camera, if it stands still and there are at least five. A pixel has changed at a time
 * when a channel of the true picture is more than 40 of 255 from its median over these times. Of
 * that light that comes from anchors with short spans: mean share over pixels and times that have
 * not changed, share[0], and over those that have, share[1]; count: how many these are, both 0
 * where nothing could be compared. spans_where.c */
typedef struct {
    double share[2], count[2];
} spans_where;
int short_lives_where(session *s, spans_where *w);

/* The held-out picture of the first held-out picture's camera, nearest to time column / 2; NULL:
 * there is none. spans_view.c */
const ted4_picture *held_out(const session *s, int column);

#endif
