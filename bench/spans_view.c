/* spans_view.c - draws a decoded file with Gaussians coloured by the spans of their anchors, and
 * the picture of spans.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "spans.h"
#include "tool/cli.h"
#include "train/model/normalise.h"

/* Brightness of the colour of a span where the Gaussian is black. */
#define DIMMEST 0.35f

static void span_colour(float span, float rgb[3])
{
    const float cold = span < 0.5f ? 2.0f * span : 1.0f,
                warm = span > 0.5f ? 2.0f - 2.0f * span : 1.0f;

    rgb[0] = cold;
    rgb[1] = cold < warm ? cold : warm;
    rgb[2] = warm;
}

/* Returns the Gaussians with other colours; the arrays of g do not change. */
static ted4_gaussians painted(const session *s, const ted4_gaussians *g,
                              void (*paint)(float span, float rgb[3]), float dimmest)
{
    ted4_gaussians out = *g;

    for (int c = 0; c < 3; c++)
        out.colour[c] = s->colour + (size_t)c * g->n;
    for (size_t i = 0; i < g->n; i++) {
        const float light = (g->colour[0][i] + g->colour[1][i] + g->colour[2][i]) / 3.0f;
        const float shade = dimmest + (1.0f - dimmest) * light;
        float rgb[3];

        paint(s->span[g->id[i] / s->info.n_offsets], rgb);
        for (int c = 0; c < 3; c++)
            out.colour[c][i] = shade * rgb[c];
    }
    return out;
}

int draw_view(session *s, const ted4_picture *p, void (*paint)(float span, float rgb[3]),
              float dimmest)
{
    const uint32_t last = s->data.n_frames > 1 ? s->data.n_frames - 1 : 1;
    const ted4_header world = { 0 }; /* origin 0, unit 1: the view is in world coordinates */
    ted4_info info = s->info;
    ted4_view view;
    ted4_gaussians g;
    float centre[3];
    ted4_status status;

    if (p->camera.width != s->width || p->camera.height != s->height)
        return failed(p->path, "size differs from the first held-out picture");
    ted4_normalise_view(&world, &p->camera, &view, centre);
    status = ted4_query_for_view(s->recon, p->frame, last, &view, NULL, &g);
    if (status == TED4_OK && paint != NULL) {
        memset(info.background, 0, sizeof info.background);
        g = painted(s, &g, paint, dimmest);
    }
    if (status == TED4_OK)
        status = ted4_render_gaussians(s->viewer, &g, &info, &view, NULL, s->view);
    return status == TED4_OK ? TED4_EXIT_FINE : failed(p->path, ted4_status_id(status));
}

const ted4_picture *held_out(const session *s, int column)
{
    const int64_t want = (int64_t)(s->data.n_frames - 1) * column;
    const ted4_picture *first = NULL, *best = NULL;
    int64_t best_far = 0;

    for (size_t i = 0; i < s->data.n_pictures; i++) {
        const ted4_picture *const p = &s->data.pictures[i];
        const int64_t far = llabs((int64_t)p->frame * (COLUMNS - 1) - want);

        if (!p->is_test)
            continue;
        if (first == NULL)
            first = p;
        if (p->camera_id == first->camera_id && (best == NULL || far < best_far)) {
            best = p;
            best_far = far;
        }
    }
    return best;
}

static void put_view(const session *s, int row, int column)
{
    const size_t line = (size_t)s->width * 3;

    for (size_t y = 0; y < (size_t)s->height; y++)
        memcpy(s->picture + (((size_t)(row * s->height) + y) * COLUMNS + (size_t)column) * line,
               s->view + y * line, line);
}

static void put_strip(const session *s)
{
    const size_t width = (size_t)s->width * COLUMNS;
    uint8_t *to = s->picture + 2 * (size_t)s->height * width * 3;

    for (int y = 0; y < STRIP; y++)
        for (size_t x = 0; x < width; x++) {
            float rgb[3];

            span_colour((float)x / (float)(width - 1), rgb);
            for (int c = 0; c < 3; c++)
                *to++ = (uint8_t)(255.0f * rgb[c] + 0.5f);
        }
}

int draw_picture(session *s)
{
    for (int column = 0; column < COLUMNS; column++)
        for (int row = 0; row < 2; row++) {
            const int code =
                draw_view(s, held_out(s, column), row == 0 ? NULL : span_colour, DIMMEST);

            if (code != TED4_EXIT_FINE)
                return code;
            put_view(s, row, column);
        }
    put_strip(s);
    return TED4_EXIT_FINE;
}
